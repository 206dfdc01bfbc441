"""A path over time: where the setpoint is at each moment of it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gaik_core.paths import Path

Array = NDArray[np.float64]

EARLY = 1e-9  # s: a time this little before an end is the end, for sums of periods that round


@dataclass(frozen=True)
class Trajectory:
    """Positions (3,) in m by the time in s from 0 to `end`; looped, it begins again every `lap` s."""

    position: Callable[[float], Array]
    end: float
    lap: float

    def folded(self, time: float) -> float:
        """`time` s of an endless repetition as the time into its lap."""
        folded = time % self.lap
        return folded if self.lap - folded > EARLY else 0.0

    def looped(self, time: float) -> Array:
        """The position at `time` s of an endless repetition."""
        return self.position(self.folded(time))

    def once(self, time: float) -> Array:
        """The position at `time` s of a single run, which stays at its end."""
        return self.position(min(time, self.end))

    def done(self, time: float) -> bool:
        """Whether a single run is at its end at `time` s."""
        return time >= self.end - EARLY


class Progress:
    """How far along a trajectory we are; it goes on from there when the trajectory or looping changes."""

    def __init__(self, trajectory: Trajectory) -> None:
        self._trajectory = trajectory
        self.time = 0.0  # s into the lap
        self.done = False

    def restart(self) -> None:
        """Go back to the beginning."""
        self.time, self.done = 0.0, False

    def change(self, trajectory: Trajectory) -> None:
        """Follow another trajectory from the same share of its lap."""
        self.time *= trajectory.lap / self._trajectory.lap
        self._trajectory = trajectory

    def step(self, dt: float, loop: bool) -> Array:
        """The position (3,) m now; `dt` s later is the next. Without `loop`, the lap we are in is the last."""
        trajectory = self._trajectory
        if loop:
            self.time = trajectory.folded(self.time)
        position = trajectory.looped(self.time) if loop else trajectory.once(self.time)
        self.done = not loop and trajectory.done(self.time)
        self.time += dt
        return position


def along_path(path: Path, lap_time: float) -> Trajectory:
    """A closed path with a lap in `lap_time` s; a single run ends where it began."""
    return Trajectory(lambda time: path.position(2.0 * math.pi * time / lap_time), lap_time, lap_time)


def through_points(points: ArrayLike, rate: float) -> Trajectory:
    """Points (n, 3) in m, `rate` of them a second, each as it stands."""
    rows = np.array(points, dtype=np.float64)
    last = len(rows) - 1
    return Trajectory(
        lambda time: rows[min(last, math.floor(time * rate + 0.5))], last / rate, len(rows) / rate
    )
