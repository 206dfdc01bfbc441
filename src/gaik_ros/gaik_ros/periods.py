"""Statistics of a loop's periods, and of other times, over the window between two reports."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Percentiles:
    """Count, median, 99th percentile and maximum of times in s; NaN where nothing was measured."""

    count: int
    p50: float
    p99: float
    maximum: float

    @classmethod
    def of(cls, times: Sequence[float]) -> Percentiles:
        """The percentiles of `times`, s."""
        if not times:
            return cls(0, float("nan"), float("nan"), float("nan"))
        p50, p99 = np.percentile(times, (50.0, 99.0))
        return cls(len(times), float(p50), float(p99), float(max(times)))


@dataclass(frozen=True)
class PeriodReport:
    """One window of a loop: the ticks made, their periods in s, the overruns, and the rate reached in Hz."""

    ticks: int
    periods: Percentiles
    overruns: int
    rate: float


class TimeWindow:
    """Collects times in s until they are taken; the newest `capacity` are kept."""

    def __init__(self, capacity: int = 10_000) -> None:
        self._times: deque[float] = deque(maxlen=capacity)

    def add(self, seconds: float) -> None:
        """Remember one time, and forget the oldest where there are too many."""
        self._times.append(seconds)

    def take(self) -> list[float]:
        """The times since the last take. May be called from another thread than `add`."""
        times, self._times = self._times, deque(maxlen=self._times.maxlen)
        return list(times)


class PeriodWindow:
    """Collects the periods between ticks. An overrun is a tick a whole period late, or one skipped."""

    def __init__(self, period: float) -> None:
        self._period = period
        self._times = TimeWindow(capacity=100_000)
        self.last: float | None = None  # s, when the last tick was
        self._overruns = 0
        self.ticks = 0  # since the start
        self.all_overruns = 0

    def add(self, now: float, skipped: int = 0) -> None:
        """Note a tick at `now`, s, before which `skipped` ticks were left out."""
        self.ticks += 1
        if self.last is not None:
            elapsed = now - self.last
            self._times.add(elapsed)
            late = skipped + (1 if elapsed > 2.0 * self._period else 0)
            self._overruns += late
            self.all_overruns += late
        self.last = now

    def take(self) -> PeriodReport:
        """The report of the window since the last take, which begins a new window."""
        times = self._times.take()
        overruns, self._overruns = self._overruns, 0
        total = sum(times)
        rate = len(times) / total if total > 0.0 else 0.0
        return PeriodReport(len(times), Percentiles.of(times), overruns, rate)
