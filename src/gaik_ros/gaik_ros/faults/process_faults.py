"""Nodes that stall, die and are restarted, each in turn."""

from __future__ import annotations

import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from gaik_ros.faults.fault import Check, Fault, Need
from gaik_ros.faults.measures import follows, let_go, longest_gap, reported, stopped
from gaik_ros.faults.probe import Recording
from gaik_ros.faults.stage import Stage
from gaik_ros.health import ERROR, WARN
from gaik_ros.joint_control import Mode

STALL = 0.2  # s
LEAD_IN = 0.1  # s of the recording before it
WATCHED = 1.0  # s after a node's end
ENOUGH = 100  # messages after it: a killed reader may hold up its writers for a while

DEVICE, CONTROLLER, IK, TRAJECTORY = "touch_sim", "pid_controller", "ik_node", "trajectory_publisher"
CONTROL = "pid_controller: control"
NEEDS = frozenset({Need.PROCESSES})
PROMISES = {
    DEVICE: "The controller gives zero effort after the state timeout and says ERROR",
    CONTROLLER: "The device brakes to rest after its command timeout",
    IK: "The controller holds the arm after the reference timeout and says WARN",
    TRAJECTORY: "The last setpoint is carried out and held",
}


def _stall(node: str) -> Fault:
    def play(stage: Stage) -> list[Check]:
        others = stage.own_processes.identities
        with stage.moving():
            mark = stage.mark()
            stage.sleep(LEAD_IN)
            stage.own_processes.stall(node, STALL)
            back = follows(stage)
            gap = longest_gap(stage.since(mark), "joint_command")
        same = stage.own_processes.identities == others
        return [
            Check("stalled", f"longest gap of commands {1e3 * gap:.0f} ms", True),
            back,
            Check("nothing is restarted", "nothing was" if same else "a process is another", same),
        ]

    return Fault(
        f"stall_{node}",
        f"{node} stands still for {1e3 * STALL:.0f} ms.",
        "It does not make up for the time at once: efforts and reference stay bounded, and the arm follows again.",
        play,
        NEEDS,
    )


def _end(node: str, number: signal.Signals, verb: str) -> Fault:
    quietly = number is not signal.SIGKILL

    def play(stage: Stage) -> list[Check]:
        processes = stage.own_processes
        with _leading(stage, node):
            others = {name: identity for name, identity in processes.identities.items() if name != node}
            mark, ended = stage.mark(), time.monotonic()
            code, errors = processes.end(node, number)
            stage.sleep(WATCHED)
            told = "joint_command" if node == DEVICE else "joint_states"
            stage.wait(lambda: stage.since(mark).count(told) > ENOUGH, f"{told} go on")
            checks = _consequence(stage, node, mark, ended)
            mark = stage.mark()
            processes.start(node)
            stage.wait(lambda: stage.since(mark).count("setpoint") > 20, "setpoints come")
            checks.append(follows(stage))
            kept = others.items() <= processes.identities.items()
        checks.append(Check("no other is restarted", "none was" if kept else "a process is another", kept))
        return [_quiet_end(code, errors), *checks] if quietly else checks

    return Fault(
        f"{verb}_{node}",
        f"{number.name} to {node} in the middle of a motion, and a restart.",
        f"{'It ends with 0 and without a traceback. ' if quietly else ''}{PROMISES[node]}; once it is back, the arm "
        "follows again and no other node was restarted.",
        play,
        NEEDS,
    )


@contextmanager
def _leading(stage: Stage, node: str) -> Iterator[None]:
    """Lead the arm to and fro for the length of the block, by the trajectory publisher where that is the one."""
    if node != TRAJECTORY:
        with stage.moving():
            stage.sleep(0.3)
            yield
        return
    mark = stage.mark()
    stage.own_processes.start(TRAJECTORY)
    try:
        stage.wait(lambda: stage.since(mark).count("setpoint") > 20, "the trajectory publisher leads")
        yield
    finally:
        stage.own_processes.end(TRAJECTORY, signal.SIGINT)


def _quiet_end(code: int, errors: str) -> Check:
    said = errors.strip().splitlines()[-1:] if "Traceback" in errors else []
    return Check("ends with 0", f"exit code {code}{' '.join(['', *said])}", code == 0 and not said)


def _consequence(stage: Stage, node: str, mark: dict[str, int], ended: float) -> list[Check]:
    """What the end of `node` at the time `ended` must lead to."""
    facts, names, recording = stage.facts, stage.names, stage.since(mark)
    if node == DEVICE:
        silent = let_go(recording, names, ended, facts.state_timeout)
        return [silent, reported(stage, mark, CONTROL, ERROR, Mode.STATE_LOST)]
    if node == CONTROLLER:
        return [stopped(recording, names, ended, stage.command_timeout())]
    held = stopped(recording, names, ended, facts.reference_timeout + _way_left(recording, stage))
    return [held, reported(stage, mark, CONTROL, WARN, Mode.HOLDING)] if node == IK else [held]


def _way_left(recording: Recording, stage: Stage) -> float:
    """How long the way to the last reference takes, s: it is still gone."""
    reference = recording.joints("joint_reference", stage.names).values
    states = recording.joints("joint_states", stage.names).values
    if not len(reference) or not len(states):
        return 0.0
    return float((np.abs(reference[-1] - states[0]) / stage.facts.speed_limit).max())


NODES = (DEVICE, CONTROLLER, IK, TRAJECTORY)
FAULTS = (
    *(_stall(node) for node in (DEVICE, CONTROLLER, IK)),
    *(_end(node, signal.SIGKILL, "kill") for node in NODES),
    *(_end(node, signal.SIGINT, "interrupt") for node in NODES),
    *(_end(node, signal.SIGTERM, "terminate") for node in NODES),
)
