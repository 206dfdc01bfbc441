"""The joint controller: a PID at a fixed rate from joint_reference and joint_states to joint_command."""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool, Trigger

from gaik_ros import qos
from gaik_ros.conversions import JointMessageError, fill, joint_state, joint_values, ros_time, stamp_now
from gaik_ros.deadline_loop import DeadlineLoop
from gaik_ros.health import ERROR, LOOP_PARAMETERS, OK, WARN, Health, HealthReporter
from gaik_ros.joint_control import ON_REFERENCE_TIMEOUT, ControlSettings, JointControl, Mode
from gaik_ros.last_word import say_last
from gaik_ros.parameters import Parameter, ParameterSet, ParameterTable, check_joint_names
from gaik_ros.pid import Gains
from gaik_ros.run import run
from gaik_ros.state_news import StateNews
from gaik_ros.watch import Watch

Array = NDArray[np.float64]


_GAINS = (  # field of Gains, name as in ros2_controllers' pid_controller, default, unit, description, lower, upper
    ("p", "p", 3.1, "N·m/rad", "proportional gain", 0.0, None),
    ("i", "i", 0.01, "N·m/(rad·s)", "integral gain", 0.0, None),
    ("d", "d", 0.3, "N·m·s/rad", "derivative gain", 0.0, None),
    ("feed_forward", "feedforward_gain", 0.0, "N·m·s/rad", "gain on the reference's velocity", 0.0, None),
    ("output_max", "u_clamp_max", 1.0, "N·m", "upper limit of the effort", 0.0, None),
    ("output_min", "u_clamp_min", -1.0, "N·m", "lower limit of the effort", None, 0.0),
    ("integral_max", "i_clamp_max", 1.0, "N·m", "upper limit of the integral's share", 0.0, None),
    ("integral_min", "i_clamp_min", -1.0, "N·m", "lower limit of the integral's share", None, 0.0),
)

TABLE = ParameterTable(
    "pid_controller",
    (
        Parameter(
            "dof_names",
            ("waist", "shoulder", "elbow"),
            "",
            "the joints that are controlled",
            read_only=True,
            check=check_joint_names,
        ),
        Parameter("rate", 1000.0, "Hz", "rate of the control loop", 1.0, 10_000.0, read_only=True),
        *(
            Parameter(
                f"gains.{name}",
                default,
                unit,
                f"{text}, one or one for each joint",
                lower,
                upper,
                per_joint=True,
            )
            for _, name, default, unit, text, lower, upper in _GAINS
        ),
        *(
            Parameter(
                f"gains.<joint>.{name}",
                None,
                unit,
                f"{text} of this joint; not set: gains.{name}",
                lower,
                upper,
            )
            for _, name, _, unit, text, lower, upper in _GAINS
        ),
        Parameter("gains.antiwindup", True, "", "hold the integral while it would push further into a limit"),
        Parameter(
            "derivative_filter_time", 0.05, "s", "time constant of the derivative's low-pass", 0.0, 10.0
        ),
        Parameter(
            "bumpless_time", 0.1, "s", "how fast a jump of the law is blended in", 0.0, 10.0, read_only=True
        ),
        Parameter(
            "reference_timeout", 0.2, "s", "age at which a joint_reference is no longer followed", 0.001
        ),
        Parameter(
            "on_reference_timeout",
            "hold",
            "",
            "what to do then: stay, or let go",
            choices=ON_REFERENCE_TIMEOUT,
        ),
        Parameter("state_timeout", 0.1, "s", "age of joint_states at which the effort goes to zero", 0.001),
        Parameter(
            "approach_speed", 2.0, "rad/s", "limit on the way to a reference after a start or a pause", 0.001
        ),
        Parameter(
            "largest_reference_step",
            0.1,
            "rad",
            "a reference further than this from the one before is approached, not jumped at",
            1e-6,
        ),
        Parameter(
            "tolerated_lateness",
            0.004,
            "s",
            "lateness of ticks and states up to which the gains are full; beyond it they fall, the derivative's first",
            1e-4,
        ),
        Parameter(
            "reference_extrapolation",
            0.015,
            "s",
            "for how long a reference goes on at its velocity until the next one comes; 0: a staircase",
            0.0,
            0.1,
        ),
        *LOOP_PARAMETERS,
    ),
)


def gains_of(values: ParameterSet, joints: Sequence[str]) -> Gains:
    """The Gains of `joints` from the parameters. ParameterError, ValueError: they do not fit together."""
    fields: dict[str, Any] = {}
    for field, name, *_ in _GAINS:
        common = values.per_joint(f"gains.{name}", joints)
        own = (values[f"gains.{joint}.{name}"] for joint in joints)
        fields[field] = [c if o is None else o for c, o in zip(common, own, strict=True)]
    return Gains(**fields, filter_time=values.derivative_filter_time, anti_windup=values["gains.antiwindup"])


def settings_of(values: ParameterSet) -> ControlSettings:
    """The ControlSettings from the parameters."""
    return ControlSettings(
        reference_timeout=values.reference_timeout,
        state_timeout=values.state_timeout,
        on_reference_timeout=values.on_reference_timeout,
        approach_speed=values.approach_speed,
        largest_step=values.largest_reference_step,
        tolerated_lateness=values.tolerated_lateness,
        extrapolation=values.reference_extrapolation,
    )


class _Heard:
    """The newest values of a topic, None before the first, and when they came; replaced whole, for any thread."""

    def __init__(self, position: Array | None, velocity: Array | float = 0.0) -> None:
        self.position = position
        self.velocity = velocity
        self.time = self.since = time.monotonic()  # since: when this position was heard first


class PidController(Node):
    """joint_reference and joint_states in, joint_command out; `~/enable` and `~/reset`."""

    def __init__(self, **node_kwargs: Any) -> None:
        super().__init__(TABLE.node, **node_kwargs)
        self._lock = threading.Lock()  # the loop's thread steps what services and parameters change
        names = TABLE.declare_first(self, "dof_names")
        self.values = TABLE.for_joints(names).declare(self, self._configure)
        self._names: list[str] = list(names)
        self._control = JointControl(
            len(names), gains_of(self.values, names), settings_of(self.values), self.values.bumpless_time
        )
        self._state = self._reference = _Heard(None)
        self._news = StateNews()
        self._ticked = time.monotonic()
        self._mode = Mode.WAITING
        self._connect()
        self.loop = DeadlineLoop(self.values.rate, self._tick)
        self.health = HealthReporter(
            self, self.values, self.loop, {"control": self._control_health, "topics": self._watch.health}
        )

    def _connect(self) -> None:
        self._watch = Watch(self)
        self._command = joint_state(self._names, effort=np.zeros(len(self._names)))
        self._publisher = self._watch.publisher(JointState, "joint_command", qos.JOINT_COMMAND, sole=True)
        self._watch.subscription(
            JointState, "joint_reference", self._on_reference, qos.JOINT_REFERENCE, sole=True
        )
        self._watch.subscription(JointState, "joint_states", self._on_state, qos.JOINT_STATES_SUBSCRIPTION)
        self.create_service(SetBool, "~/enable", self._on_enable)
        self.create_service(Trigger, "~/reset", self._on_reset)

    def _configure(self, values: ParameterSet) -> None:
        gains, settings = gains_of(values, self._names), settings_of(values)
        with self._lock:
            self._control.configure(gains, settings)

    def _on_reference(self, message: JointState) -> None:
        try:
            position = joint_values(message, self._names)
            velocity = joint_values(message, self._names, "velocity") if message.velocity else 0.0
        except JointMessageError as reason:
            self._watch.refuse("joint_reference", reason)
            return
        heard, before = _Heard(position, velocity), self._reference
        if before.position is not None and (position == before.position).all():
            heard.since = before.since
        self._reference = heard

    def _on_state(self, message: JointState) -> None:
        try:
            position = joint_values(message, self._names)
        except JointMessageError as reason:
            self._watch.refuse("joint_states", reason)
            return
        stamp = 1_000_000_000 * message.header.stamp.sec + message.header.stamp.nanosec
        clock = ros_time(self.get_clock())
        patience = 0.5 * self.values.state_timeout  # a clock that stands is known before the state is lost
        if self._news.is_news(stamp, position, time.monotonic(), clock, patience):
            self._state = _Heard(position)

    def _tick(self, dt: float) -> None:
        state, reference, now = self._state, self._reference, time.monotonic()
        late = max(now - self._ticked, now - state.time) - self.loop.schedule.period
        self._ticked = now
        with self._lock:
            effort = self._control.step(
                dt,
                state.position,
                now - state.time,
                reference.position,
                reference.velocity,
                now - reference.time,
                now - reference.since,
                late,
            )
        self._publish(effort)
        if self._control.mode is not self._mode:
            self._tell(self._control.mode)

    def _publish(self, effort: Array) -> None:
        fill(self._command, "effort", effort)
        stamp_now(self._command.header.stamp, self.get_clock())
        self._publisher.publish(self._command)

    def _tell(self, mode: Mode) -> None:
        """Log a change of mode that a user should know of."""
        self._mode = mode
        if mode is Mode.STATE_LOST:
            timeout = self._control.settings.state_timeout
            repeats = time.monotonic() - self._news.repeated < 0.5 * timeout
            missing = "news in joint_states, the same again and again," if repeats else "joint_states"
            self.get_logger().error(f"no {missing} for {timeout:g} s: zero effort")
        elif mode is Mode.RELEASED or (mode is Mode.HOLDING and self._reference.position is not None):
            action = "holding position" if mode is Mode.HOLDING else "zero effort"
            self.get_logger().warning(f"no fresh joint_reference: {action}")

    def _on_enable(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        with self._lock:
            self._control.enabled = request.data
        response.success = True
        response.message = "enabled" if request.data else "disabled: zero effort"
        return response

    def _on_reset(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        with self._lock:
            self._control.reset()
        response.success, response.message = True, "integral and derivative forgotten"
        return response

    def _control_health(self) -> Health:
        mode, state, reference, now = self._control.mode, self._state, self._reference, time.monotonic()
        lateness = self._control.lateness
        age = now - reference.time if reference.position is not None else float("nan")
        level, message = OK, str(mode)
        if mode is Mode.STATE_LOST:
            level = ERROR
        elif mode in (Mode.WAITING, Mode.RELEASED) or age > self.values.reference_timeout:
            level = WARN
        if level == OK and lateness.share < 1.0:
            level = WARN
            message += f"; {1e3 * lateness.worst:.0f} ms late: gains at {lateness.share:.2f}, no derivative"
        figures = {
            "mode": mode,
            "state_age_s": now - state.time if state.position is not None else float("nan"),
            "reference_age_s": age,
            "lateness_s": lateness.worst,
        }
        return Health(level, message, figures)

    def destroy_node(self) -> None:
        """Let go of the device, then end."""
        say_last(self._publisher, lambda: self._publish(np.zeros(len(self._names))), self.context)
        super().destroy_node()


def main(args: Sequence[str] | None = None) -> int:
    """Entry point of the executable."""
    return run(PidController, args, TABLE)
