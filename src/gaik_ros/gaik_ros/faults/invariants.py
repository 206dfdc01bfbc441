"""What holds in every case, whatever happens: bounded efforts, a bounded reference, nodes that live, recovery."""

from __future__ import annotations

import numpy as np

from gaik_ros.faults.facts import admissible
from gaik_ros.faults.fault import Check
from gaik_ros.faults.probe import Recording
from gaik_ros.faults.stage import NotSeenError, Stage

EFFORT, SPEED, ALIVE, RECOVERY = "effort", "reference", "nodes", "recovery"
ROUNDING = 1e-9


def efforts_bounded(recording: Recording, stage: Stage) -> Check:
    """Every joint_command is finite and within the limits of the effort."""
    efforts = recording.joints("joint_command", stage.names, "effort").values
    largest = float(np.abs(efforts).max(initial=0.0))  # NaN for a command that is not finite
    low, high = stage.facts.effort_min - ROUNDING, stage.facts.effort_max + ROUNDING
    holds = len(efforts) > 0 and bool(((efforts >= low) & (efforts <= high)).all())
    return Check(EFFORT, f"{largest:.2f} N·m in {len(efforts)}", holds)


def reference_bounded(recording: Recording, stage: Stage) -> Check:
    """Every joint_reference is finite, inside the joint limits, and never faster than the speed limit.

    A message that is lost, or late, is no fast one: two are compared over the longer of the times between their
    stamps and between their receipts, and over two periods at least.
    """
    reference = recording.joints("joint_reference", stage.names)
    if not np.isfinite(reference.values).all():
        return Check(SPEED, "not finite", False)
    if not len(reference.values):
        return Check(SPEED, "none", True)  # no setpoint was ever accepted
    time = np.maximum(np.diff(reference.stamp), np.diff(reference.received))
    time = np.maximum(time, 2.0 * stage.facts.reference_period)
    speed = np.abs(np.diff(reference.values, axis=0)) / time[:, None]
    fastest = float(speed.max(initial=0.0))
    inside = admissible(stage.chain, reference.values)
    holds = inside and bool((speed <= stage.facts.speed_limit * (1.0 + 1e-6)).all())
    measured = f"{fastest:.2f} rad/s in {len(reference.values)}"
    return Check(SPEED, measured if inside else f"{measured}, outside the joint limits", holds)


def nodes_alive(stage: Stage) -> Check:
    """All nodes are there."""
    try:
        stage.wait(lambda: not stage.absent(), "all nodes are there")
    except NotSeenError:
        return Check(ALIVE, f"gone: {', '.join(stage.absent())}", False)
    return Check(ALIVE, "all there", True)


def recovers(stage: Stage) -> Check:
    """The arm goes where the next good setpoint sends it, and comes to rest there."""
    began_away = stage.facts.away
    try:
        taken = stage.go(began_away)
        stage.rest()
    except NotSeenError as error:
        return Check(RECOVERY, f"not seen: {error}", False)
    return Check(RECOVERY, f"{taken:.1f} s", True)
