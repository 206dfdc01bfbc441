"""The paths of section 4.3 and of the demo: an inclined circle and Bernoulli's lemniscate.

A path is a closed curve over a phase in rad, one lap from 0 to 2π.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gaik_core.errors import GaikError, UnknownNameError

Array = NDArray[np.float64]

PAPER_STEP = 0.05
"""Step of the phase (rad) between the paper's 126 points: all the multiples below 2π."""


@dataclass(frozen=True)
class Path:
    """A closed plane curve, turned by `tilt` about the x axis and moved to a `centre` (m)."""

    tilt: float = 0.0
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if len(self.centre) != 3 or not all(map(math.isfinite, (*self.centre, self.tilt))):
            raise GaikError(
                f"centre is {self.centre}, tilt {self.tilt}; expected three finite numbers and one"
            )

    def position(self, phase: ArrayLike) -> Array:
        """Points (…, 3) in m at phases (…) in rad."""
        return np.asarray(self.centre) + self._turned(self._curve(np.asarray(phase, dtype=float)))

    def derivative(self, phase: ArrayLike) -> Array:
        """Their derivative by the phase (…, 3) in m/rad; times 2π/period it is the velocity of a lap in that time."""
        return self._turned(self._slope(np.asarray(phase, dtype=float)))

    def points(self, count: int = 126) -> Array:
        """The paper's sampling (count, 3): phases 0, 0.05, … rad, of which 126 lie in one lap."""
        return self.position(PAPER_STEP * np.arange(count))

    def sample(self, rate: float, period: float) -> Array:
        """Points (m, 3) of one lap of `period` s at `rate` Hz: the times 0, 1/rate, … below the period."""
        if not (0.0 < rate < math.inf and 0.0 < period < math.inf):
            raise GaikError(f"rate is {rate}, period {period}; expected both above 0 and finite")
        times = np.arange(math.ceil(rate * period - 1e-9)) / rate
        return self.position(2.0 * math.pi * times / period)

    def _curve(self, t: Array) -> tuple[Array, Array]:
        raise NotImplementedError

    def _slope(self, t: Array) -> tuple[Array, Array]:
        raise NotImplementedError

    def _turned(self, plane: tuple[Array, Array]) -> Array:
        x, y = plane
        return np.stack([x, y * math.cos(self.tilt), y * math.sin(self.tilt)], axis=-1)


@dataclass(frozen=True)
class Circle(Path):
    """A circle in the x-y plane, inclined by `tilt`: (r cos t, r sin t)."""

    tilt: float = math.radians(30.0)
    radius: float = 0.05

    def __post_init__(self) -> None:
        super().__post_init__()
        _check_size("radius", self.radius)

    def _curve(self, t: Array) -> tuple[Array, Array]:
        return self.radius * np.cos(t), self.radius * np.sin(t)

    def _slope(self, t: Array) -> tuple[Array, Array]:
        return -self.radius * np.sin(t), self.radius * np.cos(t)


@dataclass(frozen=True)
class Lemniscate(Path):
    """Bernoulli's lemniscate: (a cos t, a sin t cos t) / (1 + sin² t), with a the `half_width`."""

    half_width: float = 0.08

    def __post_init__(self) -> None:
        super().__post_init__()
        _check_size("half_width", self.half_width)

    def _curve(self, t: Array) -> tuple[Array, Array]:
        scale = self.half_width / (1.0 + np.sin(t) ** 2)
        return scale * np.cos(t), scale * np.sin(t) * np.cos(t)

    def _slope(self, t: Array) -> tuple[Array, Array]:
        sine, cosine = np.sin(t), np.cos(t)
        divisor = 1.0 + sine**2
        scale = self.half_width / divisor**2
        return scale * (-sine * divisor - 2.0 * sine * cosine**2), scale * (
            np.cos(2.0 * t) * divisor - 2.0 * sine**2 * cosine**2
        )


def _check_size(what: str, value: float) -> None:
    if not 0.0 < value < math.inf:
        raise GaikError(f"{what} is {value}; expected a length in m above 0")


PATHS: dict[str, type[Path]] = {"circle": Circle, "lemniscate": Lemniscate}


def path_by_name(name: str) -> Path:
    """The path of a name with its default size; raises UnknownNameError, which lists those there are."""
    if name not in PATHS:
        raise UnknownNameError("path", name, PATHS)
    return PATHS[name]()
