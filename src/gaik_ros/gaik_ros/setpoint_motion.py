"""How fast a stream of setpoints moves.

A setpoint has no time stamp, and the time it is received at jitters by a tenth of a period and more. So the
velocity is a difference of setpoints over the stream's own median period, not over the jittering intervals.
"""

from __future__ import annotations

from collections import deque
from statistics import median

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

REMEMBERED = 15  # intervals in the median
MISSED = 1.5  # periods without a setpoint after which the stream counts as standing still


class SetpointMotion:
    """Estimates the velocity of setpoints from their positions and times of receipt."""

    def __init__(self, longest_period: float = 0.25) -> None:
        """Setpoints further apart than `longest_period` s are single ones, without a velocity."""
        self._longest = longest_period
        self._intervals: deque[float] = deque(maxlen=REMEMBERED)
        self._position: Array | None = None
        self._time = 0.0
        self.period: float | None = None  # s, None while there is no stream

    def add(self, position: Array, now: float) -> Array:
        """The velocity (3,) m/s at a setpoint (3,) m received at `now` s; zero for the first of a stream."""
        before, interval = self._position, now - self._time
        self._position, self._time = position, now
        if before is None or not 0.0 < interval <= self._longest:
            self._intervals.clear()
            self.period = None
            return np.zeros(3)
        self._intervals.append(interval)
        self.period = median(self._intervals)
        # A setpoint that was lost or superseded makes the interval a multiple of the period.
        periods = max(1, round(interval / self.period))
        return (position - before) / (periods * self.period)

    def standing(self, now: float) -> bool:
        """Whether no setpoint came for so long that the last velocity no longer holds."""
        return self.period is None or now - self._time > MISSED * self.period
