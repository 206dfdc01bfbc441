"""The clock of a path that was followed: where the tip ought to be at any time, found from the setpoints."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gaik_core.paths import Path
from gaik_ros.tracking import Series

Array = NDArray[np.float64]

MATCH = 1e-9  # m; a setpoint of the path is one of its points but for rounding


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
