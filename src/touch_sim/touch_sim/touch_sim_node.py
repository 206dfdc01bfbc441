"""The node `touch_sim`: a device's twin that takes joint efforts and publishes joint states and the tip."""

from __future__ import annotations

import sys
import threading
from collections.abc import Sequence
from typing import Any

import numpy as np
from geometry_msgs.msg import PointStamped
from numpy.typing import NDArray
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from gaik_core import KinematicChain
from gaik_ros import qos
from gaik_ros.conversions import JointMessageError, fill, joint_state, joint_values, stamp_now
from gaik_ros.deadline_loop import DeadlineLoop
from gaik_ros.health import LOOP_PARAMETERS, OK, WARN, Health, HealthReporter
from gaik_ros.parameters import Parameter, ParameterSet, ParameterTable
from gaik_ros.run import run
from gaik_ros.watch import Watch
from touch_sim.command_hold import CommandHold
from touch_sim.description import ORIGIN_FRAME
from touch_sim.dynamics import JointDynamics, JointModel
from touch_sim.encoder import Encoder
from touch_sim.joint_limits import JointLimits

Array = NDArray[np.float64]

TABLE = ParameterTable(
    "touch_sim",
    (
        Parameter("robot", "touch_device", "", "a robot's name, or the path of a robot file", read_only=True),
        Parameter(
            "rate", 1000.0, "Hz", "how often the twin steps and publishes", 1.0, 10_000.0, read_only=True
        ),
        Parameter("gain", 1.0, "rad/(N·m)", "K of τ θ' + κ θ = K u", 1e-6, 1e6, per_joint=True),
        Parameter("time_constant", 0.05, "s", "τ of τ θ' + κ θ = K u", 1e-6, 1e6, per_joint=True),
        Parameter(
            "stiffness", 0.0, "", "κ of τ θ' + κ θ = K u; 0 is a viscous axis", 0.0, 1e6, per_joint=True
        ),
        Parameter("effort_limit", 1.0, "N·m", "a larger effort is cut to this", 1e-6, 1e6, per_joint=True),
        Parameter("start", None, "rad", "angles at the start and after a reset; unset: home", per_joint=True),
        Parameter(
            "command_timeout", 0.1, "s", "the effort is zero once the last command is older", 1e-3, 60.0
        ),
        Parameter("encoder.resolution", 0.0, "rad", "size of a count; 0: none", 0.0, 1.0, read_only=True),
        Parameter("encoder.noise", 0.0, "rad", "standard deviation of a reading", 0.0, 1.0, read_only=True),
        Parameter("encoder.seed", 0, "", "of the noise", 0, 2**31 - 1, read_only=True),
        Parameter(
            "encoder.velocity_time_constant",
            0.01,
            "s",
            "low-pass of the velocity made from readings; not used by an ideal encoder",
            0.0,
            1.0,
            read_only=True,
        ),
        Parameter("frame_id", ORIGIN_FRAME, "", "frame of the tip", read_only=True),
        *LOOP_PARAMETERS,
    ),
)


class TouchSim(Node):
    """Steps the joints under the newest `joint_command`; publishes `joint_states` and `tip` at each step."""

    def __init__(self, **node_kwargs: Any) -> None:
        super().__init__(TABLE.node, **node_kwargs)
        self.values = TABLE.declare(self, self._parameters_changed)
        values = self.values
        self.chain = KinematicChain.load(values.robot)
        self._names = self.chain.joint_names
        self.dynamics = JointDynamics(
            self._model(values), JointLimits.of_chain(self.chain), self._start(values)
        )
        self.encoder = Encoder(
            values["encoder.resolution"],
            values["encoder.noise"],
            values["encoder.seed"],
            values["encoder.velocity_time_constant"],
        )
        self.command = CommandHold(len(self._names), values.command_timeout)
        self._lock = threading.Lock()  # the loop steps on its own thread
        self._braking = False
        self._state = joint_state(self._names)
        self._tip = PointStamped()
        self._tip.header.frame_id = values.frame_id
        self._set_tip(self.dynamics.angles)  # compiles the kinematics before the loop needs it
        self._connect()
        self.loop = DeadlineLoop(values.rate, self._tick)
        self.health = HealthReporter(
            self, values, self.loop, {"command": self._command_health, "topics": self._watch.health}
        )

    def _connect(self) -> None:
        self._watch = Watch(self)
        self._state_publisher = self._watch.publisher(JointState, "joint_states", qos.JOINT_STATES, sole=True)
        self._tip_publisher = self._watch.publisher(PointStamped, "tip", qos.TIP)
        self._watch.subscription(
            JointState, "joint_command", self._on_command, qos.JOINT_COMMAND_SUBSCRIPTION, sole=True
        )
        self.create_service(Trigger, "~/reset", self._on_reset)

    def _model(self, values: ParameterSet) -> JointModel:
        names = ("gain", "time_constant", "stiffness", "effort_limit")
        return JointModel(*(values.per_joint(name, self._names) for name in names))

    def _start(self, values: ParameterSet) -> Array:
        if values.start is None:
            return self.chain.home
        start = np.array(values.per_joint("start", self._names))
        try:
            JointLimits.of_chain(self.chain).check(start)
        except ValueError as reason:
            raise ValueError(f"parameter 'start': {reason}") from reason
        return start

    def _parameters_changed(self, values: ParameterSet) -> None:
        model = self._model(values)
        self._start(values)
        with self._lock:
            self.dynamics.set_model(model)
            self.command.timeout = values.command_timeout

    def _on_command(self, message: JointState) -> None:
        try:
            effort = joint_values(message, self._names, "effort")
        except JointMessageError as reason:
            self._watch.refuse("joint_command", reason)
            return
        with self._lock:
            self.command.receive(effort)

    def _on_reset(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        start = self._start(self.values)
        with self._lock:
            self.dynamics.reset(start)
            self.encoder.reset()
            self.command.forget()
        response.success = True
        response.message = "at " + ", ".join(
            f"{name} {angle:.4f} rad" for name, angle in zip(self._names, start, strict=True)
        )
        return response

    def _tick(self, dt: float) -> None:
        with self._lock:
            self.dynamics.step(self.command.effort(dt), dt)
            angles, velocity = self.encoder.read(self.dynamics.angles, self.dynamics.velocity, dt)
            effort = self.dynamics.effort
        self._publish(angles, velocity, effort)
        if self.command.lost != self._braking:
            self._report_command()

    def _publish(self, angles: Array, velocity: Array, effort: Array) -> None:
        stamp_now(self._state.header.stamp, self.get_clock())
        self._tip.header.stamp = self._state.header.stamp
        fill(self._state, "position", angles)
        fill(self._state, "velocity", velocity)
        fill(self._state, "effort", effort)
        self._state_publisher.publish(self._state)
        self._set_tip(angles)
        self._tip_publisher.publish(self._tip)

    def _set_tip(self, angles: Array) -> None:
        """Put the tip of the measured angles into its message: a driver knows no other."""
        self._tip.point.x, self._tip.point.y, self._tip.point.z = self.chain.forward(angles).tolist()

    def _report_command(self) -> None:
        self._braking = self.command.lost
        if self._braking:
            self.get_logger().warning(f"no joint_command for {self.command.timeout:g} s: effort is zero")
        else:
            self.get_logger().info("joint_command is back")

    def _command_health(self) -> Health:
        figures = {"age_s": self.command.age}
        if self.command.lost:
            return Health(WARN, "joint_command is too old: the effort is zero", figures)
        if not self.command.received:
            return Health(OK, "no joint_command yet", figures)
        return Health(OK, "follows joint_command", figures)


def main(args: Sequence[str] | None = None) -> int:
    """Entry point of the executable."""
    return run(TouchSim, args, TABLE)


if __name__ == "__main__":
    sys.exit(main())
