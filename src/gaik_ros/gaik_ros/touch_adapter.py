"""The node `touch_adapter`: a driver's joint states in our conventions, and our joint commands in the driver's.

Drivers hold the last force that they were told. So this node tells them zero whenever the command or the state it was
made from is too old, and when it ends.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from geometry_msgs.msg import PointStamped
from numpy.typing import NDArray
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState

from gaik_core import KinematicChain
from gaik_ros import qos
from gaik_ros.conversions import JointMessageError, array_to_point, fill, joint_state, joint_values, stamp_now
from gaik_ros.driver_conventions import JointConvention, has_tip_force, signed_axes, tip_force
from gaik_ros.drivers import DEFAULT, DRIVERS, JOINT_STATE
from gaik_ros.health import ERROR, OK, WARN, Health, HealthReporter
from gaik_ros.last_word import say_last
from gaik_ros.message_types import message_class
from gaik_ros.parameters import Parameter, ParameterSet, ParameterTable, check_joint_names
from gaik_ros.run import run
from gaik_ros.watch import Watch

Array = NDArray[np.float64]

LOOK = 0.01  # s between looks at the ages
DRIVER_STATE = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)  # fits any driver's offer
DRIVER_COMMAND = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE)  # fits any driver's request


def _check_axes(text: str) -> None:
    signed_axes(text)


ROWS = (
    Parameter(
        "driver",
        DEFAULT,
        "",
        "the driver, whose conventions are the other parameters' defaults",
        choices=tuple(DRIVERS),
        read_only=True,
    ),
    Parameter(
        "robot", "touch_device", "", "a robot of gaik_core, or the path of a robot file", read_only=True
    ),
    Parameter("state_topic", "", "", "of the driver's joint states", read_only=True),
    Parameter("command_topic", "", "", "of the driver's commands", read_only=True),
    Parameter(
        "command_type",
        "",
        "",
        f"of them: {JOINT_STATE}, whose efforts are set, or a message with a force",
        read_only=True,
    ),
    Parameter(
        "joint_names",
        ("",),
        "",
        "the driver's names of the robot's joints, in its order",
        read_only=True,
        check=check_joint_names,
    ),
    Parameter("joint_signs", (1.0,), "", "-1 where the driver's angle grows the other way", read_only=True),
    Parameter(
        "joint_offsets",
        0.0,
        "rad",
        "what the driver's angles have more",
        -10.0,
        10.0,
        read_only=True,
        per_joint=True,
    ),
    Parameter(
        "relative",
        False,
        "",
        "the driver measures each angle from the link before it (elbow: θ3 - θ2)",
        read_only=True,
    ),
    Parameter("use_velocity", False, "", "pass the driver's velocities on", read_only=True),
    Parameter(
        "force_axes",
        "",
        "",
        "which of our axes the driver's x, y and z are",
        read_only=True,
        check=_check_axes,
    ),
    Parameter("max_force", 2.0, "N", "a larger force on the tip is cut to this", 0.0, 100.0),
    Parameter(
        "singular_value",
        0.02,
        "m/rad",
        "smallest singular value of the Jacobian at which the force is zero; it is whole from twice that on",
        1e-6,
        1.0,
    ),
    Parameter("command_timeout", 0.1, "s", "the force is zero once the last command is older", 1e-3, 60.0),
    Parameter(
        "state_timeout", 0.1, "s", "the force is zero once the driver's last state is older", 1e-3, 60.0
    ),
    Parameter("frame_id", "touch_origin", "", "frame of the tip and of the force", read_only=True),
)


def table_for(driver: str, has_force: bool = True) -> ParameterTable:
    """The parameters with the defaults of a driver; without `has_force` there is none to be limited."""
    defaults = {"driver": driver, **vars(DRIVERS[driver])}
    if not has_force:
        defaults["max_force"] = None
    return ParameterTable(
        "touch_adapter", tuple(replace(row, default=defaults.get(row.name, row.default)) for row in ROWS)
    )


TABLE = table_for(DEFAULT)


class TouchAdapter(Node):
    """The driver's topics on one side, `joint_states`, `tip` and `joint_command` on the other."""

    def __init__(self, **node_kwargs: Any) -> None:
        super().__init__(TABLE.node, **node_kwargs)
        driver = TABLE.declare_first(self, "driver")
        self._chain = KinematicChain.load(TABLE.declare_first(self, "robot"))
        self._has_force = has_tip_force(self._chain)
        self.values = table_for(driver, self._has_force).declare(self, self._refuse_limit)
        values = self.values
        self._refuse_limit(values)
        self._refuse_own_topics()
        self._convention = convention_of(values, self._chain)
        self._axes = signed_axes(values.force_axes)
        self._command, self._set_command = command_of(values, self._chain)
        self._angles: Array | None = None
        self._state_time = self._command_time = float("-inf")
        self._pushing = False  # the driver was told something that it will hold
        self._share = 1.0
        self._state = joint_state(self._chain.joint_names)
        self._tip = PointStamped()
        self._tip.header.frame_id = values.frame_id
        self._connect()
        self.create_timer(LOOK, self._look, clock=Clock(clock_type=ClockType.STEADY_TIME))
        self.health = HealthReporter(
            self, values, checks={"driver": self._driver_health, "topics": self._watch.health}
        )

    def _refuse_limit(self, values: ParameterSet) -> None:
        """ValueError: a force is to be limited that cannot be known."""
        if values.max_force is not None and not self._has_force:
            raise ValueError(
                f"parameter 'max_force' is {values.max_force}: it may be set only where three joints move the tip in "
                f"space, which those of {self._chain.name} do not"
            )

    def _refuse_own_topics(self) -> None:
        """ValueError: the driver's topics are the suite's, so that this node would hear itself."""
        for parameter, own in (("state_topic", "joint_states"), ("command_topic", "joint_command")):
            if self.resolve_topic_name(self.values[parameter]) == self.resolve_topic_name(own):
                raise ValueError(
                    f"parameter '{parameter}' is {self.values[parameter]!r}: it may be any topic but {own}, which is "
                    "the suite's own"
                )

    def _connect(self) -> None:
        values = self.values
        self._watch = Watch(self)
        self._states = self._watch.publisher(JointState, "joint_states", qos.JOINT_STATES, sole=True)
        self._tips = self._watch.publisher(PointStamped, "tip", qos.TIP)
        self._commands = self._watch.publisher(
            type(self._command), values.command_topic, DRIVER_COMMAND, sole=True
        )
        self._watch.subscription(JointState, values.state_topic, self._on_state, DRIVER_STATE)
        self._watch.subscription(
            JointState, "joint_command", self._on_command, qos.JOINT_COMMAND_SUBSCRIPTION, sole=True
        )

    def _on_state(self, message: JointState) -> None:
        try:
            angles = self._convention.from_driver(joint_values(message, self.values.joint_names))
        except JointMessageError as reason:
            self._watch.refuse(self.values.state_topic, reason)
            return
        self._angles, self._state_time = angles, time.monotonic()
        stamp = message.header.stamp
        if stamp.sec or stamp.nanosec:
            self._state.header.stamp = stamp
        else:
            stamp_now(self._state.header.stamp, self.get_clock())
        fill(self._state, "position", angles)
        fill(self._state, "velocity", self._rates(message))
        self._states.publish(self._state)
        self._tip.header.stamp = self._state.header.stamp
        self._tip.point = array_to_point(self._chain.forward(angles))
        self._tips.publish(self._tip)

    def _rates(self, message: JointState) -> Array:
        """Our rates (dof,) rad/s, or none (0,) where the driver has none, or bad ones, which cost only themselves."""
        if not (self.values.use_velocity and message.velocity):
            return np.empty(0)
        try:
            rates = joint_values(message, self.values.joint_names, "velocity")
        except JointMessageError as reason:
            self._watch.refuse(f"velocity on {self.values.state_topic}", reason)
            return np.empty(0)
        return self._convention.rates_from_driver(rates)

    def _on_command(self, message: JointState) -> None:
        try:
            efforts = joint_values(message, self._chain.joint_names, "effort")
        except JointMessageError as reason:
            self._watch.refuse("joint_command", reason)
            return
        self._command_time = time.monotonic()
        if self._state_age() > self.values.state_timeout or self._angles is None:
            self._release()
            return
        self._set_command(self._to_driver(self._angles, efforts))
        self._publish()
        self._pushing = True

    def _to_driver(self, angles: Array, efforts: Array) -> Array:
        """What the driver is told: its efforts, or its force; cut by the same share."""
        if not self._has_force:
            return self._convention.efforts_to_driver(efforts)
        force = tip_force(
            self._chain.jacobian(angles), efforts, self.values.max_force, self.values.singular_value
        )
        self._share = force.share
        if isinstance(self._command, JointState):
            return self._convention.efforts_to_driver(force.share * efforts)
        return self._axes @ force.vector

    def _look(self) -> None:
        """Let go where what the force was made from is too old."""
        stale = time.monotonic() - self._command_time > self.values.command_timeout
        if self._pushing and (stale or self._state_age() > self.values.state_timeout):
            what = "joint_command" if stale else self.values.state_topic
            self.get_logger().warning(f"{what} is too old: the driver is told zero")
            self._release()

    def _state_age(self) -> float:
        return time.monotonic() - self._state_time

    def _release(self) -> None:
        self._set_command(np.zeros(self._chain.dof))
        self._publish()
        self._pushing = False

    def _publish(self) -> None:
        if hasattr(self._command, "header"):
            stamp_now(self._command.header.stamp, self.get_clock())
        self._commands.publish(self._command)

    def _driver_health(self) -> Health:
        figures = {
            "state_age_s": self._state_age(),
            "command_age_s": time.monotonic() - self._command_time,
            "force_share": self._share,
        }
        if self._angles is None:
            return Health(WARN, f"nothing on {self.values.state_topic} yet", figures)
        if self._state_age() > self.values.state_timeout:
            return Health(ERROR, f"{self.values.state_topic} is too old: zero force", figures)
        if self._pushing and self._share < 1.0:
            return Health(OK, "the force is cut", figures)
        return Health(OK, "passes on" if self._pushing else "zero force", figures)

    def destroy_node(self) -> None:
        """Let go of the device, then end."""
        say_last(self._commands, self._release, self.context)
        super().destroy_node()


def convention_of(values: ParameterSet, chain: KinematicChain) -> JointConvention:
    """The driver's joint angles from the parameters. ValueError: they do not fit the chain."""
    if len(values.joint_names) != chain.dof:
        raise ValueError(
            f"parameter 'joint_names' is {list(values.joint_names)}: it may be {chain.dof} names, of "
            f"{', '.join(chain.joint_names)}"
        )
    offsets = values.per_joint("joint_offsets", chain.joint_names)
    return JointConvention(chain, values.relative, values.joint_signs, offsets)


def command_of(values: ParameterSet, chain: KinematicChain) -> tuple[Any, Callable[[Array], None]]:
    """A message of the driver's type, and what puts a force or efforts (3,) into it. ValueError: it takes neither."""
    message = message_class(values.command_type)()
    if isinstance(message, JointState):
        message.name = list(values.joint_names)
        return message, lambda efforts: fill(message, "effort", efforts)
    force = getattr(getattr(message, "wrench", message), "force", None)
    if force is None or not all(hasattr(force, axis) for axis in "xyz"):
        raise ValueError(
            f"parameter 'command_type' is {values.command_type!r}: it may be {JOINT_STATE} or a message with a force"
        )
    if not has_tip_force(chain):
        raise ValueError(
            f"parameter 'command_type' is {values.command_type!r}: it may be {JOINT_STATE}, since efforts make a force "
            f"only where three joints move the tip in space, which those of {chain.name} do not"
        )
    if hasattr(message, "header"):
        message.header.frame_id = values.frame_id

    def set_force(vector: Array) -> None:
        force.x, force.y, force.z = vector.tolist()

    return message, set_force


def main(args: Sequence[str] | None = None) -> int:
    """Entry point of the executable."""
    return run(TouchAdapter, args, TABLE)


if __name__ == "__main__":
    sys.exit(main())
