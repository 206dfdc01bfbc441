"""Setpoints that are no positions, that stop, that cannot be reached, too many and too few."""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from gaik_ros.faults.borrowed import changed
from gaik_ros.faults.fault import Check, Fault
from gaik_ros.faults.measures import LATE, STILL, at_rest_since, longest_gap
from gaik_ros.faults.stage import ARRIVED, Stage

Array = NDArray[np.float64]

FLOOD_RATE, FLOOD_TIME = 10_000.0, 2.0  # Hz, s
PAUSE, SINGLES = 3.0, 3  # s between single setpoints, and how many


def _refused(name: str, does: str, values: Sequence[float]) -> Fault:
    """A fault of setpoints with each of `values` in each coordinate, which must all be refused."""

    def play(stage: Stage) -> list[Check]:
        good = stage.between(0.0)
        bad = [np.where(np.arange(3) == axis, value, good) for value in values for axis in range(3)]
        bad.extend(np.full(3, value) for value in values)
        mark = stage.mark()
        for position in bad:
            stage.send(position)
            stage.sleep(0.02)
        stage.wait(lambda: len(_results_of(bad, stage, mark)) >= len(bad), "a verdict on each")
        stage.sleep(0.3)
        recording, results = stage.since(mark), _results_of(bad, stage, mark)
        reference = recording.joints("joint_reference", stage.names).values
        moved = float(np.ptp(reference, axis=0).max(initial=0.0)) if len(reference) else 0.0
        return [
            Check(
                "each is refused",
                f"{results.count('refused')} of {len(bad)}",
                results == ["refused"] * len(bad),
            ),
            Check("the reference stands", f"it moved by {moved:g} rad", moved == 0.0),
        ]

    return Fault(name, does, "Each gets the verdict refused; the last good reference stands.", play)


def _results_of(positions: Sequence[Array], stage: Stage, mark: dict[str, int]) -> list[str]:
    """The verdicts on just these positions."""
    wanted = {str(position.tolist()) for position in positions}
    verdicts = stage.since(mark).verdicts()
    return [v["result"] for v in verdicts if str([float(v[axis]) for axis in "xyz"]) in wanted]


def _tiny(stage: Stage) -> list[Check]:
    mark = stage.mark()
    position = np.where(np.arange(3) == 0, 1e-320, stage.between(0.0))
    stage.send(position)
    stage.wait(lambda: stage.since(mark).count("ik_node/status") > 0, "a verdict")
    verdict = stage.since(mark).verdicts()[0]
    finite = math.isfinite(float(verdict["error_m"]))
    return [
        Check(
            "answered as zero",
            f"{verdict['result']}, {verdict['error_m']} m off",
            finite and verdict["result"] != "refused",
        )
    ]


def _out_of_reach(stage: Stage) -> list[Check]:
    base = stage.chain.frames(stage.chain.home)[0]
    away = stage.between(0.0) - base
    distance = min(3.0 * stage.chain.reach, 0.9 * stage.facts.setpoint_bound)
    return _nearest(stage, base + away / np.linalg.norm(away) * distance, ("unreachable",))


def _inner_hole(stage: Stage) -> list[Check]:
    base = np.asarray(stage.chain.frames(stage.chain.home)[0])
    return _nearest(stage, base, ("unreachable", "limited", "stagnated"))


def _waist_axis(stage: Stage) -> list[Check]:
    """Points on the first axis, where that joint turns nothing, and close by on either side of it."""
    base = stage.chain.frames(stage.chain.home)[0]
    axis = np.asarray(stage.chain.joints[0].axis, dtype=np.float64)
    aside = np.cross(axis, np.roll(axis, 1))
    up = axis if axis @ (stage.between(0.0) - base) > 0.0 else -axis
    checks = []
    for offset in (0.0, 1e-3, -1e-3):
        point = base + 0.6 * stage.chain.reach * up + offset * aside / np.linalg.norm(aside)
        checks = _nearest(stage, point, ("reached", "unreachable", "limited", "stagnated"))
        if not all(check.holds for check in checks):
            break
    return checks


def _nearest(stage: Stage, target: Array, results: Sequence[str]) -> list[Check]:
    """A verdict with the nearest point found and the distance to it, and an arm that goes there."""
    mark = stage.mark()
    stage.send(target)
    stage.wait(lambda: stage.since(mark).count("ik_node/status") > 0, "a verdict")
    verdict = stage.since(mark).verdicts()[0]
    named = [Check(f"the verdict is {' or '.join(results)}", verdict["result"], verdict["result"] in results)]
    if verdict["result"] == "refused":
        return named
    nearest = np.array(
        [float(verdict.get(f"nearest_{a}", value)) for a, value in zip("xyz", target, strict=True)]
    )
    error = float(verdict["error_m"])
    consistent = abs(np.linalg.norm(target - nearest) - error) < 1e-5
    taken = stage.wait(lambda: stage.distance(nearest) < ARRIVED, "the arm goes to the nearest point")
    stage.rest()
    return [
        *named,
        Check("it names the nearest point and the distance", f"{error:.4f} m off", bool(consistent)),
        Check("the arm goes there", f"after {taken:.1f} s", True),
    ]


def _stop_latched(stage: Stage) -> list[Check]:
    with stage.moving():
        stage.sleep(1.0)
    last = stage.between(1.0)
    stage.send(last)
    taken = stage.wait(lambda: stage.distance(last) < ARRIVED, "the last setpoint is carried out")
    stage.rest()
    mark = stage.mark()
    stage.sleep(1.5)
    angles = stage.since(mark).joints("joint_states", stage.names).values
    moved = float(np.ptp(angles, axis=0).max(initial=0.0))
    return [
        Check("the last one is carried out", f"after {taken:.2f} s", True),
        Check("and held", f"moved by {1e3 * moved:.2f} mrad in 1.5 s", moved < STILL),
    ]


def _stop_streamed(stage: Stage) -> list[Check]:
    timeout = stage.facts.setpoint_timeout
    # Slow enough that the last one, far away, would take several times the timeout.
    slow = 0.05 * float(np.abs(stage.facts.away - stage.facts.home).max()) / timeout
    with changed(stage.remote, "ik_node", {"setpoint_mode": "stream", "max_joint_speed": slow}):
        mark, sent = stage.mark(), time.monotonic()
        stage.send(stage.between(1.0))
        stage.sleep(timeout + 1.5)
        recording = stage.since(mark)
    ended = at_rest_since(recording, "joint_reference", stage.names, "position", 0.0) - sent
    left = stage.distance(stage.between(1.0))
    return [
        Check(
            "the reference moves, then stops",
            f"{ended:.3f} s after the last setpoint",
            0.0 < ended < timeout + LATE,
        ),
        Check("it does not go on to the end", f"{1e3 * left:.0f} mm before it", left > ARRIVED),
    ]


def _flood(stage: Stage) -> list[Check]:
    ends = [stage.between(0.0), stage.between(1.0)]
    mark, sent = stage.mark(), 0
    began = time.monotonic()
    while (passed := time.monotonic() - began) < FLOOD_TIME:
        if sent < passed * FLOOD_RATE:
            stage.send(ends[(sent // 100) % 2])
            sent += 1
        else:
            time.sleep(1e-4)
    last = stage.between(0.5)
    stage.send(last)
    taken = stage.wait(lambda: _answered(stage, mark, last), "the last setpoint is answered")
    recording = stage.since(mark)
    told = len(recording.health("ik_node: setpoints"))
    stage.wait(lambda: len(stage.since(mark).health("ik_node: setpoints")) > told, "a report")
    counts = {key: int(value) for key, value in _last_report(stage, mark).items() if key in _COUNTED}
    received, accounted = counts.pop("received"), sum(counts.values())
    gap = longest_gap(recording, "joint_command")
    verdicts = recording.count("ik_node/status")
    return [
        Check("sent", f"{sent / FLOOD_TIME:.0f} Hz, {verdicts} of {sent + 1} answered", sent > FLOOD_RATE),
        Check(
            "each received is answered or counted as superseded",
            f"{accounted} of {received}",
            accounted == received,
        ),
        Check("the newest wins", f"answered {1e3 * taken:.0f} ms after the end", taken < LATE),
        Check("the control goes on", f"longest gap {1e3 * gap:.0f} ms", gap < LATE),
    ]


_COUNTED = ("received", "solved", "refused", "superseded")


def _last_report(stage: Stage, mark: dict[str, int]) -> Mapping[str, str]:
    return stage.since(mark).health("ik_node: setpoints")[-1].values


def _answered(stage: Stage, mark: dict[str, int], position: Array) -> bool:
    verdicts = stage.since(mark).verdicts()[-1:]
    return any(all(float(v[a]) == value for a, value in zip("xyz", position, strict=True)) for v in verdicts)


def _slow(stage: Stage) -> list[Check]:
    mark = stage.mark()
    reached, wandered = 0, 0.0
    for share in itertools.islice(itertools.cycle((1.0, 0.0)), SINGLES):
        target, due = stage.between(share), time.monotonic() + PAUSE
        stage.send(target)
        stage.wait(lambda target=target: stage.distance(target) < ARRIVED, "it is reached")
        stage.rest()
        reached += 1
        held = stage.mark()
        stage.sleep(max(0.5, due - time.monotonic()))
        angles = stage.since(held).joints("joint_states", stage.names).values
        wandered = max(wandered, float(np.ptp(angles, axis=0).max(initial=0.0)))
    gap = longest_gap(stage.since(mark), "joint_reference")
    return [
        Check("each is reached before the next", f"{reached} of {SINGLES}", reached == SINGLES),
        Check("and held", f"moved by {1e3 * wandered:.2f} mrad", wandered < STILL),
        Check("the reference is repeated meanwhile", f"longest gap {1e3 * gap:.0f} ms", gap < LATE),
    ]


FAULTS = (
    _refused("nan_setpoint", "Setpoints with NaN in one coordinate and in all.", (math.nan,)),
    _refused("infinite_setpoint", "Setpoints with +Inf and -Inf.", (math.inf, -math.inf)),
    _refused("huge_setpoint", "Setpoints with 1e308 and -1e308.", (1e308, -1e308)),
    Fault("tiny_setpoint", "A setpoint with 1e-320, a denormal number.", "It is answered as zero.", _tiny),
    Fault(
        "out_of_reach",
        "A setpoint at three times the reach.",
        "The verdict is unreachable, with the nearest point and the distance; the arm goes there.",
        _out_of_reach,
    ),
    Fault(
        "inner_hole",
        "A setpoint in the arm's own base.",
        "A verdict with the nearest point found; the arm goes there at bounded speed.",
        _inner_hole,
    ),
    Fault(
        "waist_axis",
        "Setpoints on the axis of the first joint, and a millimetre to either side.",
        "Each gets a verdict; the joint does not spin; the arm goes to the nearest point found.",
        _waist_axis,
    ),
    Fault(
        "setpoints_stop",
        "A stream of setpoints ends; mode latch.",
        "The last one is carried out to the end and held.",
        _stop_latched,
    ),
    Fault(
        "stream_stops",
        "A stream of setpoints ends in the middle of a motion; mode stream.",
        "The arm stops within the setpoint's timeout and one period.",
        _stop_streamed,
    ),
    Fault(
        "setpoint_flood",
        f"Setpoints at {FLOOD_RATE:g} Hz for {FLOOD_TIME:g} s.",
        "The newest wins, each other one is answered or counted; the control goes on.",
        _flood,
    ),
    Fault(
        "slow_setpoints",
        f"A setpoint every {PAUSE:g} s.",
        "Each is reached and held; the reference is repeated all the while.",
        _slow,
    ),
)
