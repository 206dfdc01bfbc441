"""What is measured of a recording, and the checks made of it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gaik_ros.faults.fault import Check
from gaik_ros.faults.probe import HealthReport, Recording
from gaik_ros.faults.stage import Stage
from gaik_ros.health import ERROR, WARN

Array = NDArray[np.float64]

LATE = 1.0  # s a busy machine may add to any time that is promised; the table has what was measured
ON_COURSE = 0.1  # rad: an arm that follows is a tenth of that behind, one that does not several times as much
FRESH = 0.3  # s
FOLLOWS = 1.5  # s: so long no arm that stands still is near a reference that goes to and fro
LEVELS = {WARN: "WARN", ERROR: "ERROR"}
STILL = 4e-3  # rad: an arm that is held moves less


def lags(recording: Recording, names: list[str]) -> Array:
    """The largest angle between device and reference at each of the device's messages, (n,) rad."""
    state = recording.joints("joint_states", names)
    reference = recording.joints("joint_reference", names)
    held = np.searchsorted(reference.received, state.received, side="right") - 1
    usable = (held >= 0) & np.isfinite(state.values).all(axis=1)
    return np.asarray(np.abs(state.values[usable] - reference.values[held[usable]]).max(axis=1))


def follows(stage: Stage, mark: dict[str, int] | None = None) -> Check:
    """All nodes speak and the arm follows, at the latest after a while, and goes on doing so.

    How far it was behind since `mark` is told, not judged: it depends on how busy the machine is.
    """
    taken = stage.wait_lasting(lambda: _follows(stage), FOLLOWS, "the arm follows")
    measured = f"after {taken:.2f} s" if taken > 0.0 else "all the time"
    if mark is not None and (behind := lags(stage.since(mark), stage.names)).size:
        usual, most = 1e3 * np.percentile(behind, 90.0), 1e3 * behind.max()
        measured += f", {usual:.0f} mrad behind for 90 % of it, {most:.0f} at most"
    return Check("the arm follows", measured, True)


def _follows(stage: Stage) -> bool:
    state, reference = stage.angles(), stage.probe.newest("joint_reference")
    if state is None or reference is None:
        return False
    silent = max(stage.probe.age(topic) for topic in ("joint_states", "joint_reference", "joint_command"))
    return silent < FRESH and bool(np.abs(np.array(reference.position) - state).max() < ON_COURSE)


def at_rest_since(recording: Recording, topic: str, names: list[str], field: str, still: float) -> float:
    """When the values of a topic last differed from their final ones by more than `still`, s; 0 if never."""
    joints = recording.joints(topic, names, field)
    if not joints.received.size:
        return 0.0
    away = np.abs(joints.values - joints.values[-1]).max(axis=1) > still
    return float(joints.received[away].max(initial=0.0))


def let_go(recording: Recording, names: list[str], since: float, timeout: float) -> Check:
    """The controller gives zero effort within `timeout` of `since`, and keeps to it."""
    commands = recording.joints("joint_command", names, "effort")
    acting = np.abs(commands.values).max(axis=1) > 0.0
    after = float(commands.received[acting].max(initial=since)) - since
    zeros = int((~acting & (commands.received > since)).sum())
    return Check(
        f"zero effort {timeout:.3g} s after the last good state",
        f"after {after:.3f} s",
        zeros >= 10 and after < timeout + LATE,
    )


def stopped(recording: Recording, names: list[str], since: float, timeout: float) -> Check:
    """The device is at rest within `timeout` of `since`, and stays."""
    states = recording.joints("joint_states", names)
    moving = at_rest_since(recording, "joint_states", names, "position", STILL)
    after = max(0.0, moving - since)
    later = int((states.received > max(moving, since)).sum())
    return Check(
        f"the arm is at rest {timeout:.3g} s later",
        f"after {after:.3f} s, for {later} states",
        later >= 10 and after < timeout + LATE,
    )


def reported(stage: Stage, mark: dict[str, int], part: str, level: bytes, saying: str) -> Check:
    """/diagnostics reports `part` at `level`, in words that hold `saying`; waits for the report."""
    found: list[HealthReport] = []

    def seen() -> bool:
        found[:] = [r for r in stage.since(mark).health(part) if r.level >= level and saying in r.message]
        return bool(found)

    stage.wait(seen, f'{LEVELS[level]} on /diagnostics that says "{saying}"')
    return Check(f"{LEVELS[level]} on /diagnostics", f'"{found[0].message}"', True)


def largest_step(recording: Recording, names: list[str]) -> float:
    """The largest change of the effort from one command to the next, N·m."""
    efforts = recording.joints("joint_command", names, "effort").values
    return float(np.abs(np.diff(efforts, axis=0)).max(initial=0.0))


def longest_gap(recording: Recording, topic: str) -> float:
    """The longest time between two messages of a topic, s; infinite where there are not two."""
    received = recording.received(topic)
    return float(np.diff(received).max()) if received.size > 1 else float("inf")
