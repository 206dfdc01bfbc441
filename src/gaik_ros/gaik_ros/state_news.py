"""Whether a state says something of the device, or is a driver's last message over again.

Plain Python on stamps, arrays and times; pid_controller.py puts the messages around it.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

NEAR = 1_000_000_000  # ns between a stamp and the clock that made it, at most


class StateNews:
    """Knows a message that is repeated by its stamp and positions; without a stamp nothing can be known.

    Stamps of a ROS clock that stands, as in a paused simulation, stand with it: a device at rest then says the same
    again and again, and each time it is news.
    """

    def __init__(self) -> None:
        self._stamp = 0
        self._position: Array | None = None
        self._clock: int | None = None
        self._clock_since = -math.inf
        self.repeated = -math.inf  # s, when a message was last heard again

    def is_news(
        self, stamp: int, position: Array, now: float, clock: int | None = None, patience: float = 0.0
    ) -> bool:
        """Whether a state is news: `stamp` in ns, `position` (joints,) rad, heard at `now` s of a steady clock.

        `clock` is the time in ns of a ROS clock that may stand, None for the system's; after `patience` s it does.
        """
        if clock != self._clock:
            self._clock, self._clock_since = clock, now
        before, stands = self._position, now - self._clock_since > patience
        paused = clock is not None and stands and abs(clock - stamp) <= NEAR
        if stamp == self._stamp != 0 and before is not None and (position == before).all() and not paused:
            self.repeated = now
            return False
        self._stamp, self._position = stamp, position
        return True
