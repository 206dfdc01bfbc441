"""How well a path was followed: what was recorded of one run, and the error of the tip.

The error is the distance from the measured tip to the path's point at the same time, never to the nearest point:
a tip that is on the path but late is in error.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gaik_core.paths import Path

Array = NDArray[np.float64]

MATCH = 1e-9  # m; a setpoint of the path is one of its points but for rounding


@dataclass(frozen=True)
class Series:
    """Values (n, k) at times (n,) in s."""

    time: Array
    values: Array

    def between(self, start: float, end: float) -> Series:
        """Return the part from `start` s on and before `end` s."""
        inside = (self.time >= start) & (self.time < end)
        return Series(self.time[inside], self.values[inside])


@dataclass(frozen=True)
class Lap:
    """The clock of a path: `path` is passed in `period` s again and again from `start` s, until `end` s."""

    path: Path
    period: float
    start: float
    end: float

    def desired(self, time: Array) -> Array:
        """Return where the tip ought to be (n, 3) m at times (n,) s."""
        return self.path.position(2.0 * math.pi * (time - self.start) / self.period)


@dataclass(frozen=True)
class Run:
    """One path, followed: what was asked and what was measured, in s, m and rad, all on one clock."""

    name: str
    lap: Lap
    joint_names: tuple[str, ...]
    setpoint: Series  # (n, 3)
    tip: Series  # (n, 3)
    joint_reference: Series  # (n, dof)
    joint_states: Series  # (n, dof)


@dataclass(frozen=True)
class TrackingError:
    """Root mean square and largest distance in m, and the number of measured tips they were taken over."""

    rms_m: float
    max_m: float
    samples: int


def tip_distances(run: Run) -> Array:
    """Return the distance (n,) m of each tip measured during the laps; those before and after do not count.

    Raises ValueError where there is none.
    """
    tip = run.tip.between(run.lap.start, run.lap.end)
    if not tip.time.size:
        raise ValueError(f"no tip was measured while the {run.name} was followed")
    return np.asarray(np.linalg.norm(tip.values - run.lap.desired(tip.time), axis=1))


def tracking_error(run: Run) -> TrackingError:
    """Return the error of the tip over the laps. Raises ValueError where none was measured."""
    distance = tip_distances(run)
    return TrackingError(float(np.sqrt((distance**2).mean())), float(distance.max()), int(distance.size))


def lap_of(setpoints: Series, path: Path, rate: float, period: float, laps: int) -> Lap:
    """Return the clock of a path from its setpoints as received, `rate` Hz, the first one at phase zero.

    Each setpoint k is due at `start + k/rate` and cannot be received before that, only later; so the start is
    the earliest that any of them tells. A setpoint that was lost leaves a gap in k, found by its position.
    Raises ValueError where there are no setpoints or one is no point of the path.
    """
    if not setpoints.time.size:
        raise ValueError("no setpoint was received")
    due = setpoint_numbers(setpoints.values, path, rate, period) / rate
    start = float((setpoints.time - due).min())
    return Lap(path, period, start, start + laps * period)


def setpoint_numbers(points: Array, path: Path, rate: float, period: float) -> Array:
    """Return the number k (n,) of each setpoint (n, 3) of a path: its position is that of the time k/rate.

    The first is number 0 and numbers rise, so each is looked for in the half lap that follows the one before.
    """
    turn = 2.0 * math.pi / (rate * period)
    ahead = np.arange(max(1, math.floor(0.5 * rate * period)))
    numbers = np.empty(len(points))
    following = 0
    for row, point in enumerate(points):
        candidates = path.position(turn * (following + (ahead if row else ahead[:1])))
        matches = np.flatnonzero(np.linalg.norm(candidates - point, axis=-1) < MATCH)
        if not matches.size:
            raise ValueError(f"setpoint {row} is no point of the path: {point.tolist()} m")
        numbers[row] = following + matches[0]
        following += int(matches[0]) + 1
    return numbers
