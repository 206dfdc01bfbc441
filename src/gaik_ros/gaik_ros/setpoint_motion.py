"""How fast a stream of setpoints moves.

A setpoint has no time stamp, and the time it is received at jitters by a good part of a period. So the velocity
is a difference of setpoints over the stream's own mean period, not over the jittering intervals.
"""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

REMEMBERED = 33  # times of receipt in the mean, at most
ENOUGH = 5  # times of receipt that make a stream
SHORTEST = 5e-4  # s: setpoints that come faster than this were held up on the way
MISSED = 2.5  # periods without a setpoint after which the stream counts as standing still


class SetpointMotion:
    """Estimates the velocity of setpoints from their positions, their count and their times of receipt."""

    def __init__(self, longest_period: float = 0.25) -> None:
        """Setpoints further apart than `longest_period` s are single ones, without a velocity."""
        self._longest = longest_period
        self._received: deque[tuple[float, int]] = deque(maxlen=REMEMBERED)  # when, and the number of which
        self._position = np.zeros(3)

    @property
    def period(self) -> float | None:
        """The stream's mean period in s, None while there is no stream."""
        if len(self._received) < ENOUGH:
            return None
        (first, begin), (last, end) = self._received[0], self._received[-1]
        return max(SHORTEST, (last - first) / (end - begin))

    def add(self, position: Array, now: float, number: int) -> Array:
        """The velocity (3,) m/s at a setpoint (3,) m, the `number`-th that was received, at `now` s.

        Numbers may be left out: those of setpoints that a newer one replaced. Zero for the first few of a stream.
        """
        before, self._position = self._position, position
        if not self._continues(now, number):
            self._received.clear()
        self._received.append((now, number))
        if self.period is None:
            return np.zeros(3)
        steps = number - self._received[-2][1]
        return (position - before) / (steps * self.period)

    def _continues(self, now: float, number: int) -> bool:
        """Whether a setpoint belongs to the stream so far."""
        if not self._received:
            return False
        elapsed, steps = now - self._received[-1][0], number - self._received[-1][1]
        patience = self._longest if self.period is None else MISSED * self.period
        return steps > 0 and 0.0 < elapsed <= min(self._longest, steps * patience)

    def standing(self, now: float) -> bool:
        """Whether no setpoint came for so long that the last velocity no longer holds."""
        return self.period is None or now - self._received[-1][0] > MISSED * self.period
