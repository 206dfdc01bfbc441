"""joint_states that stop, freeze, lack something or hold too much: altered on their way through the cable."""

from __future__ import annotations

import time
from array import array
from collections.abc import Callable

from sensor_msgs.msg import JointState

from gaik_ros.faults.cable import Alteration
from gaik_ros.faults.fault import Check, Fault, Need
from gaik_ros.faults.measures import follows, let_go, reported
from gaik_ros.faults.stage import Stage
from gaik_ros.health import ERROR
from gaik_ros.joint_control import Mode

DURATION = 1.0  # s
HOUR = 3600

AS_SILENCE = (
    "They do not count as states: zero effort after the state timeout and ERROR on /diagnostics; with the next good "
    "one the controller takes hold of the device where it is, and the arm follows again."
)
AS_GOOD = "They are read by name: the arm follows."


def _lost(name: str, does: str, make: Callable[[], Alteration]) -> Fault:
    """A fault after which there are no good states, until it ends."""

    def play(stage: Stage) -> list[Check]:
        with stage.moving():
            mark = stage.mark()
            with stage.own_cable.altered_by(make()):
                stage.sleep(DURATION)
                loud = reported(stage, mark, "pid_controller: control", ERROR, Mode.STATE_LOST)
                recording = stage.since(mark)
            silent = let_go(recording, stage.names, stage.own_cable.cut_at, stage.facts.state_timeout)
            return [silent, loud, follows(stage)]

    return Fault(name, does, AS_SILENCE, play, frozenset({Need.CABLE}))


def _harmless(name: str, does: str, alteration: Alteration, promises: str = AS_GOOD) -> Fault:
    """A fault that must change nothing."""

    def play(stage: Stage) -> list[Check]:
        with stage.moving():
            mark = stage.mark()
            with stage.own_cable.altered_by(alteration):
                on_course = follows(stage, mark)
                altered = stage.own_cable.altered
        return [on_course, Check("altered", f"{altered} messages altered", altered > 0)]

    return Fault(name, does, promises, play, frozenset({Need.CABLE}))


def _freeze(stage: Stage) -> list[Check]:
    """Positions stand still under fresh stamps, as with an encoder that is stuck."""
    first: list[array[float]] = []

    def frozen(message: JointState) -> JointState:
        first.append(message.position)
        message.position = first[0]
        return message

    with stage.moving():
        mark = stage.mark()
        with stage.own_cable.altered_by(frozen):
            stage.sleep(DURATION)
        count = stage.since(mark).count("joint_command")
        return [Check("the control goes on", f"{count} commands", count >= 10), follows(stage)]


def _repeat() -> Alteration:
    first: list[JointState] = []

    def repeat(message: JointState) -> JointState:
        first.append(message)
        return first[0]

    return repeat


def _silent(message: JointState) -> None:
    return None


def _short(message: JointState) -> JointState:
    return _with(message, list(message.name[:-1]), list(message.position[:-1]))


def _few_values(message: JointState) -> JointState:
    return _with(message, list(message.name), list(message.position[:-1]))


def _empty(message: JointState) -> JointState:
    return _with(message, [], [])


def _duplicate(message: JointState) -> JointState:
    return _with(message, [*message.name, message.name[0]], [*message.position, message.position[0]])


def _renamed(message: JointState) -> JointState:
    return _with(message, [f"other_{name}" for name in message.name], list(message.position))


def _nan_position(message: JointState) -> JointState:
    return _with(message, list(message.name), [float("nan"), *message.position[1:]])


def _reordered(message: JointState) -> JointState:
    return _with(message, list(message.name[::-1]), list(message.position[::-1]))


def _foreign(message: JointState) -> JointState:
    return _with(message, ["gripper", *message.name], [9.9, *message.position])


def _nan_velocity(message: JointState) -> JointState:
    message.velocity = array("d", [float("nan")] * len(message.name))
    return message


def _stepping(message: JointState) -> JointState:
    """Stamps that step by an hour forth and back, once a second."""
    message.header.stamp.sec += HOUR if int(2.0 * time.monotonic()) % 2 else -HOUR
    return message


def _with(message: JointState, names: list[str], position: list[float]) -> JointState:
    return JointState(header=message.header, name=names, position=position)


FAULTS = (
    _lost("states_stop", "joint_states stop.", lambda: _silent),
    _lost("states_repeat", "The driver repeats its last joint_states, stamp and all.", _repeat),
    Fault(
        "states_freeze",
        "The positions in joint_states freeze while their stamps go on, as with a stuck encoder.",
        "It cannot be told from a hand that holds the device: the effort stays within its limits and the integral does "
        "not wind up; once it thaws, the arm follows again.",
        _freeze,
        frozenset({Need.CABLE}),
    ),
    _lost("states_short", "joint_states lack a joint.", lambda: _short),
    _lost("states_few_values", "joint_states have fewer positions than names.", lambda: _few_values),
    _lost("states_empty", "joint_states are empty.", lambda: _empty),
    _lost("states_duplicate", "joint_states name a joint twice.", lambda: _duplicate),
    _lost("states_of_others", "joint_states of other joints only.", lambda: _renamed),
    _lost("states_nan", "joint_states with a position of NaN.", lambda: _nan_position),
    _harmless("states_reordered", "joint_states in another order.", _reordered),
    _harmless("states_with_foreign", "joint_states with a foreign joint among ours.", _foreign),
    _harmless(
        "states_nan_velocity",
        "joint_states with velocities of NaN.",
        _nan_velocity,
        "Only positions are used: the arm follows.",
    ),
    _harmless(
        "state_stamps_step",
        "The stamps of joint_states step by an hour, forth and back.",
        _stepping,
        "Ages are of receipt, by the steady clock: the arm follows.",
    ),
)
