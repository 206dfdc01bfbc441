"""Inverse kinematics as a node: setpoints in, a joint reference out, and a verdict on each."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import Point
from numpy.typing import NDArray
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from gaik_core import ALGEBRAS, RULES, KinematicChain, rule_by_name
from gaik_ros import qos
from gaik_ros.continuous_ik import ContinuousIk, Result
from gaik_ros.conversions import (
    JointMessageError,
    fill,
    joint_state,
    point_to_array,
    raw_joint_values,
    stamp_now,
)
from gaik_ros.deadline_loop import DeadlineLoop
from gaik_ros.health import LOOP_PARAMETERS, OK, WARN, Health, HealthReporter, worst
from gaik_ros.parameters import Parameter, ParameterSet, ParameterTable
from gaik_ros.periods import Percentiles, TimeWindow
from gaik_ros.run import run
from gaik_ros.setpoint_follower import LATCH, SETPOINT_MODES, FollowerSettings, SetpointFollower
from gaik_ros.verdict import Verdict, describe, verdict_message
from gaik_ros.watch import Watch

Array = NDArray[np.float64]

TABLE = ParameterTable(
    "ik_node",
    (
        Parameter(
            "robot", "touch_device", "", "a robot of gaik_core, or the path of a robot file", read_only=True
        ),
        Parameter("algebra", "quaternion", "", "the algebra to compute in", choices=tuple(ALGEBRAS)),
        Parameter("rule", "levenberg_marquardt", "", "the update rule", choices=tuple(RULES)),
        Parameter("learning_rate", 0.0, "", "of the rule, where it has one; 0: the rule's own default", 0.0),
        Parameter("tolerance", 1e-6, "m", "distance at which a setpoint counts as reached", 1e-12, 1.0),
        Parameter("max_iterations", 1000, "", "updates of one solve", 1, 1_000_000),
        Parameter(
            "max_joint_speed",
            1.5,
            "rad/s",
            "limit on the reference's speed, one or one for each joint",
            1e-6,
            per_joint=True,
        ),
        Parameter("rate", 100.0, "Hz", "rate of the reference", 1.0, 1000.0, read_only=True),
        Parameter(
            "setpoint_mode",
            LATCH,
            "",
            "what the last setpoint means when no more come: it is carried out, or the arm stops",
            choices=SETPOINT_MODES,
        ),
        Parameter("setpoint_timeout", 0.25, "s", "age of a setpoint at which a stream is dead", 0.001),
        Parameter("setpoint_bound", 10.0, "m", "a coordinate beyond this is refused as absurd", 0.001),
        Parameter(
            "state_timeout", 1.0, "s", "joint_states older than this are no place to start from", 0.001
        ),
        *LOOP_PARAMETERS,
        Parameter(
            "diagnostics.solve_p99_warn", 0.005, "s", "99th percentile of the solve time that warns", 0.0
        ),
    ),
)


@dataclass(frozen=True, eq=False)
class _Setpoint:
    position: Array  # (3,) m
    sequence: int
    time: float  # s, when it was received


def ik_of(chain: KinematicChain, values: ParameterSet) -> ContinuousIk:
    """The solver that the parameters describe. GaikError: the rule cannot have that learning rate."""
    rule = rule_by_name(values.rule, values.learning_rate or None)
    return ContinuousIk(chain, values.algebra, rule, values.tolerance, values.max_iterations)


def settings_of(chain: KinematicChain, values: ParameterSet) -> FollowerSettings:
    """The FollowerSettings from the parameters. ParameterError: limits of another number of joints."""
    limit = values.per_joint("max_joint_speed", chain.joint_names)
    return FollowerSettings(limit, values.setpoint_mode, values.setpoint_timeout)


class IkNode(Node):
    """setpoint in, joint_reference and `~/status` out; `~/solve_from_here`."""

    def __init__(self, **node_kwargs: Any) -> None:
        super().__init__(TABLE.node, **node_kwargs)
        self._lock = threading.Lock()  # callbacks aim the reference that the loop's thread advances
        self.values = TABLE.declare(self, self._configure)
        self.chain = KinematicChain.load(self.values.robot)
        ik = ik_of(self.chain, self.values)
        ik.solve(self.chain.forward(self.chain.home) + 0.01, self.chain.home)  # compiles the kernels
        settings = settings_of(self.chain, self.values)
        self._follower = SetpointFollower(ik, settings, 1.0 / self.values.rate)
        self._names = list(self.chain.joint_names)
        self._received = self._solved = self._refused = 0
        self._superseded = self._all_superseded = 0  # since the last verdict, and ever
        self._newest: _Setpoint | None = None  # not answered yet
        self._setpoint: _Setpoint | None = None  # the last answered
        self._told_waiting = 0  # sequence of the last setpoint said to be waiting
        self._raw_state: tuple[bytes, float] | None = None
        self._solve_times = TimeWindow()
        self._connect()
        self.loop = DeadlineLoop(self.values.rate, self._tick)
        self.health = HealthReporter(
            self, self.values, self.loop, {"setpoints": self._setpoint_health, "topics": self._watch.health}
        )

    def _connect(self) -> None:
        self._watch = Watch(self)
        zero = np.zeros(self.chain.dof)
        self._message = joint_state(self._names, position=zero, velocity=zero)
        self._publisher = self._watch.publisher(JointState, "joint_reference", qos.JOINT_REFERENCE, sole=True)
        self._status = self._watch.publisher(DiagnosticStatus, "~/status", qos.STATUS)
        self._watch.subscription(Point, "setpoint", self._on_setpoint, qos.SETPOINT, sole=True)
        # Only the start of a motion needs the state, so a thousand a second are kept as bytes, not read.
        self._watch.subscription(
            JointState, "joint_states", self._on_state, qos.JOINT_STATES_SUBSCRIPTION, raw=True
        )
        self.create_service(Trigger, "~/solve_from_here", self._on_solve_from_here)
        # What waits is looked at again: with no states nothing else would say that it has waited too long.
        self._look_again = self.create_timer(0.1, self._answer, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def _configure(self, values: ParameterSet) -> None:
        ik, settings = ik_of(self.chain, values), settings_of(self.chain, values)
        with self._lock:
            self._follower.configure(ik, settings)

    def _on_state(self, raw: bytes) -> None:
        self._raw_state = (raw, time.monotonic())
        if self._newest is not None and not self._follower.started:
            self._answer()

    def _on_setpoint(self, message: Point) -> None:
        self._received += 1
        position = point_to_array(message)
        if not (np.abs(position) <= self.values.setpoint_bound).all():  # false for NaN too
            self._refuse(self._received, position, self._absurdity(position))
            return
        superseded = self._newest is not None
        self._newest = _Setpoint(position, self._received, time.monotonic())
        if superseded:
            self._superseded += 1
            self._all_superseded += 1
        elif self.executor is not None:
            # Answered after the messages that are already here, so that a flood does not delay the newest.
            self.executor.create_task(self._answer)

    def _absurdity(self, position: Array) -> str:
        """What is wrong with a position that is none."""
        if np.isfinite(position).all():
            return f"{position.tolist()}: a coordinate is beyond {self.values.setpoint_bound:g} m"
        return f"{position.tolist()}: every coordinate must be finite"

    def _refuse(self, sequence: int, position: Array, reason: str) -> None:
        self._refused += 1
        self._watch.refuse("setpoint", reason)
        self._publish_verdict(Verdict(sequence, position, Result.REFUSED, f"refused, {reason}"))

    def _answer(self) -> None:
        """Answer the newest setpoint, if it has not been; let it wait where the device is not known."""
        setpoint = self._newest
        if setpoint is None:
            return
        now = time.monotonic()
        if self._follower.overdue(setpoint.time, now):
            self._newest = None
            reason = f"waited {now - setpoint.time:.1f} s for joint_states to start from"
            self._refuse(setpoint.sequence, setpoint.position, reason)
            return
        if not self._follower.started and not self._start():
            self._tell_waiting(setpoint)
            return
        self._newest = None
        self._solve(setpoint)

    def _tell_waiting(self, setpoint: _Setpoint) -> None:
        """Say once that a setpoint waits."""
        message = "waiting for joint_states to start from"
        if self._told_waiting == 0:
            self.get_logger().info(message)
        if self._told_waiting != setpoint.sequence:
            self._told_waiting = setpoint.sequence
            self._publish_verdict(Verdict(setpoint.sequence, setpoint.position, Result.WAITING, message))

    def _start(self) -> bool:
        """Begin where the device is; False where that is not known."""
        position = self._measured()
        if position is None:
            return False
        with self._lock:
            self._follower.start(position, time.monotonic())
        return True

    def _measured(self) -> Array | None:
        """The joints' positions from the newest joint_states, None if there are none, too old or unusable."""
        if self._raw_state is None or time.monotonic() - self._raw_state[1] > self.values.state_timeout:
            return None
        try:
            return raw_joint_values(self._raw_state[0], self._names)
        except JointMessageError as reason:
            self._watch.refuse("joint_states", reason)
            return None

    def _solve(self, setpoint: _Setpoint) -> None:
        began = time.perf_counter()
        answer = self._follower.solve(setpoint.position)
        elapsed = time.perf_counter() - began
        with self._lock:
            self._follower.accept(setpoint.position, setpoint.time, setpoint.sequence, answer)
            self._publish_reference(time.monotonic())
        self._setpoint = setpoint
        self._solved += 1
        self._solve_times.add(elapsed)
        superseded, self._superseded = self._superseded, 0
        self._publish_verdict(
            Verdict(
                setpoint.sequence,
                setpoint.position,
                answer.result,
                describe(answer),
                superseded,
                elapsed,
                answer,
            )
        )

    def _tick(self, dt: float) -> None:
        now = time.monotonic()
        with self._lock:
            was_dead = self._follower.stream_dead
            if self._follower.due(now):
                self._publish_reference(now)
            died = self._follower.stream_dead and not was_dead
        if died:
            self.get_logger().warning("the stream of setpoints is dead: the arm stops")

    def _publish_reference(self, now: float) -> None:
        """Advance the reference to `now` and publish it; the lock is held."""
        position, velocity = self._follower.advance(now)
        fill(self._message, "position", position)
        fill(self._message, "velocity", velocity)
        stamp_now(self._message.header.stamp, self.get_clock())
        self._publisher.publish(self._message)

    def _publish_verdict(self, verdict: Verdict) -> None:
        name = self.get_fully_qualified_name().lstrip("/")
        self._status.publish(verdict_message(f"{name}: setpoint", verdict))

    def _on_solve_from_here(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Start anew from where the device is, and solve the last setpoint again."""
        if not self._start():
            response.success, response.message = False, "no joint_states to start from"
            return response
        if self._newest is None and self._setpoint is not None:
            self._newest = self._setpoint
        self._answer()
        response.success, response.message = True, "started from where the device is"
        return response

    def _setpoint_health(self) -> Health:
        solve, now = Percentiles.of(self._solve_times.take()), time.monotonic()
        findings = []
        if solve.p99 > self.values["diagnostics.solve_p99_warn"]:
            findings.append((WARN, f"99th percentile of the solve time is {solve.p99:.4f} s"))
        if self._newest is not None and not self._follower.started:
            findings.append((WARN, "a setpoint waits for joint_states"))
        if self._follower.stream_dead:
            findings.append((WARN, "the stream of setpoints is dead"))
        level, message = worst(findings)
        figures = {
            "received": self._received,
            "solved": self._solved,
            "refused": self._refused,
            "superseded": self._all_superseded,
            "solve_p50_s": solve.p50,
            "solve_p99_s": solve.p99,
            "setpoint_age_s": now - self._setpoint.time if self._setpoint else math.nan,
            "state_age_s": now - self._raw_state[1] if self._raw_state else math.nan,
            "arrived": self._follower.reference.arrived,
        }
        return Health(level if findings else OK, message, figures)


def main(args: Sequence[str] | None = None) -> int:
    """Entry point of the executable."""
    return run(IkNode, args, TABLE)
