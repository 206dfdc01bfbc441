"""The runs in a recording: what was asked by its setpoints, one after the other, and how it was followed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gaik_core import KinematicChain
from gaik_ros.bag_writer import BagError
from gaik_ros.recording import Recording
from gaik_ros.tracking import Run, Series

Array = NDArray[np.float64]

GAP = 0.5  # s: setpoints further apart belong to different runs
WINDOW = 20  # setpoints: among so many in a row one was received in time
ARRIVED = 5e-3  # m: so near the setpoints the way to them is over
STAYS = 0.2  # s for which it is so near then


@dataclass(frozen=True)
class SetpointCourse:
    """The course that setpoints describe: straight from one to the next, and held where they are `gap` s apart."""

    setpoints: Series
    start: float
    end: float
    gap: float = GAP

    def desired(self, time: Array) -> Array:
        """Return where the tip ought to be (n, 3) m at times (n,) s."""
        times, points = self.setpoints.time, self.setpoints.values
        before = np.clip(np.searchsorted(times, time, side="right") - 1, 0, len(times) - 1)
        after = np.minimum(before + 1, len(times) - 1)
        apart = times[after] - times[before]
        moving = (apart > 0.0) & (apart <= self.gap)
        share = np.where(
            moving, np.clip((time - times[before]) / np.where(moving, apart, 1.0), 0.0, 1.0), 0.0
        )
        return np.asarray(points[before] + share[:, None] * (points[after] - points[before]))


def runs_of(recording: Recording, chain: KinematicChain, gap: float = GAP) -> list[Run]:
    """Return the runs: setpoints less than `gap` s apart make one; a single one does not, unless all are.

    A recording without tips, as a real device's may be, has them computed from the joint states by `chain`. The way
    to the first setpoint comes before the run and does not count. Runs without any tip are left out.

    Raises:
        BagError: there is no finite setpoint, or no run with a tip.
        JointMessageError: the joints of the reference, or of `chain` where there is none, are not in joint_states.
    """
    setpoints = recording.setpoints()
    if not setpoints.time.size:
        raise BagError("no finite setpoint was recorded")
    names = recording.joint_names("joint_reference") or chain.joint_names
    states = recording.joints("joint_states", names)
    reference = recording.joints("joint_reference", names)
    tip = recording.tips()
    if not tip.time.size:
        tip = Series(states.time, chain.forward(recording.joints("joint_states", chain.joint_names).values))
    courses = [_course(part, tip, gap) for part in _parts(setpoints, gap)]
    followed = [course for course in courses if tip.between(course.start, course.end).time.size]
    if not followed:
        raise BagError("neither tip nor joint states were recorded while there were setpoints")
    return [
        Run(f"run {number}", course, names, course.setpoints, tip, reference, states)
        for number, course in enumerate(followed, start=1)
    ]


def due_times(times: Array) -> Array:
    """Return when setpoints (n,) were due, from when they were received, in s, where they come at one rate.

    None can be received before it is due, only later; so the clock is the earliest that any of them tells. Where some
    are missing, those that follow stay behind that clock by whole periods, and are counted on by as many. Setpoints
    at no fixed rate keep their times.
    """
    if times.size < 2 * WINDOW:
        return times
    period = _period(times)
    late = times - period * np.arange(times.size)
    start = late.min()
    # Among WINDOW setpoints in a row one was received in time: how late that one is tells what is missing.
    ahead = np.append(late - start, np.full(WINDOW - 1, np.inf))
    missing = np.round(np.lib.stride_tricks.sliding_window_view(ahead, WINDOW).min(axis=1) / period)
    due = start + period * (np.arange(times.size) + np.maximum.accumulate(missing))
    return due if np.median(np.abs(times - due)) < 0.5 * period else times


def _period(times: Array) -> float:
    """The period in s that most of the times have; of a whole number of Hz where it is near one, as rates are set."""
    span = times.size // 4
    period = float(np.median(times[span:] - times[:-span])) / span
    rate = round(1.0 / period) if period > 0.0 else 0
    return 1.0 / rate if rate and abs(rate * period - 1.0) < 2e-3 else max(period, 1e-9)


def _parts(setpoints: Series, gap: float) -> list[Series]:
    cuts = np.flatnonzero(np.diff(setpoints.time) > gap) + 1
    parts = [
        Series(due_times(time), values)
        for time, values in zip(np.split(setpoints.time, cuts), np.split(setpoints.values, cuts), strict=True)
    ]
    return [part for part in parts if part.time.size > 1] or [setpoints]


def _course(setpoints: Series, tip: Series, gap: float) -> SetpointCourse:
    """Return the course of a run, from where the tip has come near it on."""
    start = float(setpoints.time[0])
    held = setpoints.time.size == 1 or np.diff(setpoints.time).min() > gap
    end = float(tip.time[-1]) if held and tip.time.size else float(setpoints.time[-1])
    whole = SetpointCourse(setpoints, start, end, gap)
    during = tip.between(start, end)
    near = np.linalg.norm(during.values - whole.desired(during.time), axis=1) < ARRIVED
    return SetpointCourse(setpoints, _arrival(during.time, near, start), end, gap)


def _arrival(times: Array, near: NDArray[np.bool_], otherwise: float) -> float:
    """The time from which the tip is near for a while on end, and does not only cross the path on its way to it."""
    away = np.concatenate([[0], np.cumsum(~near)])
    stays = away[np.searchsorted(times, times + STAYS)] == away[:-1]
    return float(times[np.argmax(stays)]) if stays.any() else otherwise
