"""What a strip chart shows: the newest samples of a few series over a window of time."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class StripChart:
    """Samples of `series` values over the newest `window` s. Knows no clock: times in s are handed in."""

    def __init__(self, series: int, window: float) -> None:
        self.window = window
        self._series = series
        self._rows: deque[tuple[float, ...]] = deque()

    def add(self, time: float, values: Sequence[float]) -> None:
        """Add one sample of every series; NaN where a series has none."""
        if len(values) != self._series:
            raise ValueError(f"{len(values)} values for {self._series} series")
        self._rows.append((time, *values))
        while self._rows[0][0] < time - self.window:
            self._rows.popleft()

    def columns(self, now: float) -> tuple[Array, ...]:
        """Times relative to `now` (n,), from -window to 0, then the values (n,) of each series."""
        rows = np.array(self._rows, dtype=np.float64).reshape(-1, 1 + self._series)
        times = rows[:, 0] - now
        shown = times >= -self.window
        return (times[shown], *rows[shown, 1:].T)
