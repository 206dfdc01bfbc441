"""How well something was followed: what was recorded of one run, and the error of the tip.

The error is the distance from the measured tip to where it ought to be at the same time, never to the nearest point
of the path: a tip that is on the path but late is in error.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Series:
    """Values (n, k) at times (n,) in s."""

    time: Array
    values: Array

    def between(self, start: float, end: float) -> Series:
        """Return the part from `start` s on and before `end` s."""
        inside = (self.time >= start) & (self.time < end)
        return Series(self.time[inside], self.values[inside])


class Course(Protocol):
    """What ought to be followed, from `start` s until `end` s."""

    @property
    def start(self) -> float:
        """When it begins, in s."""

    @property
    def end(self) -> float:
        """When it is over, in s."""

    def desired(self, time: Array) -> Array:
        """Return where the tip ought to be (n, 3) m at times (n,) s."""


@dataclass(frozen=True)
class Run:
    """A course, followed: what was asked and what was measured, in s, m and rad, all on one clock."""

    name: str
    course: Course
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
    """Return the distance (n,) m of each tip measured during the course; those before and after do not count.

    Raises ValueError where there is none.
    """
    tip = run.tip.between(run.course.start, run.course.end)
    if not tip.time.size:
        raise ValueError(f"no tip was measured while the {run.name} was followed")
    return np.asarray(np.linalg.norm(tip.values - run.course.desired(tip.time), axis=1))


def tracking_error(run: Run) -> TrackingError:
    """Return the error of the tip over the course. Raises ValueError where none was measured."""
    distance = tip_distances(run)
    return TrackingError(float(np.sqrt((distance**2).mean())), float(distance.max()), int(distance.size))
