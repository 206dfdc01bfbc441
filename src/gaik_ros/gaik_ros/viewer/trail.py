"""The line that a moving point leaves behind it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Trail:
    """The newest points of a moving point, at least `step` m apart; a jump of more than `gap` m leaves a gap."""

    def __init__(self, step: float = 1e-3, gap: float = 0.02, capacity: int = 500) -> None:
        self._step, self._gap, self._capacity = step, gap, capacity
        self._points: list[Array] = []
        self.version = 0  # counts the changes, so that an unchanged trail need not be drawn again

    def add(self, point: Array) -> None:
        """Go on to `point` (3,) m."""
        if self._points and np.linalg.norm(point - self._points[-1]) < self._step:
            return
        self._points.append(np.array(point))
        del self._points[: -self._capacity]
        self.version += 1

    def clear(self) -> None:
        """Begin anew."""
        self._points.clear()
        self.version += 1

    def segments(self) -> Array:
        """The line as segments (n, 2, 3) m, oldest first."""
        if len(self._points) < 2:
            return np.empty((0, 2, 3))
        points = np.array(self._points)
        pairs = np.stack([points[:-1], points[1:]], axis=1)
        return pairs[np.linalg.norm(pairs[:, 1] - pairs[:, 0], axis=-1) <= self._gap]
