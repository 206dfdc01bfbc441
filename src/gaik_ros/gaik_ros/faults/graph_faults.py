"""Others on our topics: rival publishers, QoS that does not fit, and a clock that steps."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager

import numpy as np
from geometry_msgs.msg import Point
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

from gaik_ros.conversions import array_to_point, joint_state
from gaik_ros.faults.borrowed import changed
from gaik_ros.faults.facts import admissible
from gaik_ros.faults.fault import Check, Fault
from gaik_ros.faults.measures import follows, reported
from gaik_ros.faults.probe import OWN_FRAME, QUIET_PUBLISHER, QUIET_SUBSCRIPTION, Joints
from gaik_ros.faults.stage import Stage
from gaik_ros.health import WARN

DURATION = 1.5  # s
RIVAL_RATE = 100.0  # Hz
CLOCK_RATE = 200.0  # Hz
CLOCK_START, CLOCK_STEP, STEP_EVERY = 10_000.0, 3600.0, 0.5  # s
HAND_OVER = 1.0  # s for the nodes to change clocks


@contextmanager
def _repeating(rate: float, act: Callable[[], None]) -> Iterator[None]:
    """Do something again and again on another thread for the length of the block."""
    ended = threading.Event()

    def repeat() -> None:
        while not ended.wait(1.0 / rate):
            act()

    thread = threading.Thread(target=repeat, daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def _two_references(stage: Stage) -> list[Check]:
    probe = stage.probe
    rival = probe.create_publisher(JointState, "joint_reference", 1)
    message = joint_state(stage.names, position=stage.facts.away)
    message.header.frame_id = OWN_FRAME
    try:
        mark = stage.mark()
        with stage.moving(), _repeating(RIVAL_RATE, lambda: rival.publish(message)):
            stage.sleep(DURATION)
            warned = reported(stage, mark, "pid_controller: topics", WARN, "2 publishers")
        recording = stage.since(mark)
    finally:
        probe.destroy_publisher(rival)
    fastest = _fastest(recording.joints("joint_states", stage.names))
    # The device catches up where it was late: three times the approach speed, where a jump would be ten times that.
    bound = 3.0 * stage.facts.approach_speed
    return [
        warned,
        Check("no joint jumps", f"{fastest:.1f} rad/s at most", fastest < bound),
        follows(stage),
    ]


def _fastest(states: Joints, window: float = 0.03) -> float:
    """The fastest joint over windows of that many s by stamp and by receipt, rad/s."""
    ahead = np.searchsorted(states.stamp, states.stamp + window)
    start = np.flatnonzero(ahead < len(ahead))
    end = ahead[start]
    time_apart = np.maximum(
        states.stamp[end] - states.stamp[start], states.received[end] - states.received[start]
    )
    moved = np.abs(states.values[end] - states.values[start]).max(axis=1)
    return float((moved / time_apart).max(initial=0.0))


def _two_commands(stage: Stage) -> list[Check]:
    probe = stage.probe
    rival = probe.create_publisher(JointState, "joint_command", 1)
    message = joint_state(stage.names, effort=0.1 * stage.facts.effort_max)
    message.header.frame_id = OWN_FRAME
    try:
        mark = stage.mark()
        with _repeating(RIVAL_RATE, lambda: rival.publish(message)):
            stage.sleep(DURATION)
            warned = reported(stage, mark, "pid_controller: topics", WARN, "2 publishers")
        recording = stage.since(mark)
    finally:
        probe.destroy_publisher(rival)
    inside = admissible(stage.chain, recording.joints("joint_states", stage.names).values)
    return [
        warned,
        Check("the device stays inside its limits", "inside" if inside else "outside", inside),
    ]


def _mismatch(stage: Stage) -> list[Check]:
    profile = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    lasting = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    probe = stage.probe
    stranger = probe.create_publisher(Point, "setpoint", profile, event_callbacks=QUIET_PUBLISHER)
    listener = probe.create_subscription(
        JointState, "joint_command", lambda message: None, lasting, event_callbacks=QUIET_SUBSCRIPTION
    )
    try:
        mark = stage.mark()
        warned = [
            reported(stage, mark, "ik_node: topics", WARN, "does not fit"),
            reported(stage, mark, "pid_controller: topics", WARN, "does not fit"),
        ]
        stranger.publish(array_to_point(stage.between(1.0)))
        stage.sleep(0.3)
        recording = stage.since(mark)
    finally:
        probe.destroy_publisher(stranger)
        probe.destroy_subscription(listener)
    verdicts = recording.count("ik_node/status")
    return [
        *warned,
        Check("nothing passes, nothing moves", f"{verdicts} verdicts", verdicts == 0),
    ]


def _clock_steps(stage: Stage) -> list[Check]:
    publisher = stage.probe.create_publisher(Clock, "/clock", 10)
    nodes = [name for name in ("touch_sim", "pid_controller", "ik_node") if name in stage.present()]
    began = time.monotonic()

    def tick() -> None:
        passed = time.monotonic() - began
        step = CLOCK_STEP * (int(passed / STEP_EVERY) % 2)
        message = Clock()
        message.clock.sec, message.clock.nanosec = _split(CLOCK_START + passed + step)
        publisher.publish(message)

    try:
        with stage.moving(), _repeating(CLOCK_RATE, tick):
            with ExitStack() as borrowed:
                for node in nodes:
                    borrowed.enter_context(changed(stage.remote, node, {"use_sim_time": True}))
                stage.sleep(HAND_OVER)
                mark = stage.mark()
                stage.sleep(4.0 * STEP_EVERY)
                on_course = follows(stage, mark)
                recording = stage.since(mark)
            stage.sleep(HAND_OVER)
    finally:
        stage.probe.destroy_publisher(publisher)
    stamps = recording.joints("joint_command", stage.names, "effort").stamp
    steps = int((np.abs(np.diff(stamps)) > CLOCK_STEP / 2.0).sum())
    return [
        Check("the clock steps", f"{steps} steps of {CLOCK_STEP:g} s in the stamps", steps >= 2),
        on_course,
    ]


def _split(seconds: float) -> tuple[int, int]:
    return int(seconds), int(1e9 * (seconds % 1.0))


FAULTS = (
    Fault(
        "two_publishers",
        "A second publisher on joint_reference sends the arm elsewhere, a hundred times a second.",
        "It is warned about; the controller goes after neither faster than its approach speed; alone again with ours, "
        "the arm follows.",
        _two_references,
    ),
    Fault(
        "two_commanders",
        "A second publisher on joint_command pushes all joints with a tenth of the effort.",
        "It is warned about; the device stays inside its limits.",
        _two_commands,
    ),
    Fault(
        "qos_mismatch",
        "A best-effort publisher on setpoint, and a transient-local subscription to joint_command.",
        "Both are warned about; no message passes and nothing moves.",
        _mismatch,
    ),
    Fault(
        "clock_steps",
        "The nodes are put on /clock, which steps by an hour, forth and back.",
        "Nothing is timed by that clock but stamps: the arm follows.",
        _clock_steps,
    ),
)
