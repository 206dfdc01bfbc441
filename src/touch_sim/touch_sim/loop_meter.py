"""How regularly a loop ticks, measured from outside over any span."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from gaik_ros.deadline_loop import DeadlineLoop


@dataclass(frozen=True)
class LoopRate:
    """The rate set and the rate reached, in Hz, and the 99th percentile of the period in s."""

    rate_hz: float
    reached_hz: float
    period_p99_s: float


class LoopMeter:
    """Notes when each tick of `loop` begins. To be made before the loop runs."""

    def __init__(self, loop: DeadlineLoop) -> None:
        self._loop = loop
        self._times: list[float] = []
        tick = loop.tick

        def timed(dt: float) -> None:
            self._times.append(time.monotonic())
            tick(dt)

        loop.tick = timed

    def clear(self) -> None:
        """Begin a new span."""
        self._times.clear()

    def periods(self) -> np.ndarray:
        """Return the periods (n,) in s since the last `clear`."""
        return np.diff(np.array(self._times))

    def rate(self, periods: np.ndarray) -> LoopRate:
        """Return the rates of these periods, of one span or of several put together."""
        if not periods.size:
            raise ValueError("the loop did not tick")
        return LoopRate(self._loop.rate, float(1.0 / periods.mean()), float(np.percentile(periods, 99.0)))
