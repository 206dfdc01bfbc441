"""The newest effort, held until it is too old: a real driver lets the motors go when commands stop."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class CommandHold:
    """Holds an effort (dof,) N·m for at most `timeout` s, counted in the steps that use it.

    Age is the sum of the `dt` since the last `receive`, so that no clock is read. Zero effort brings a viscous
    axis to rest at once; one with a stiffness returns to its zero with its own time constant.
    """

    def __init__(self, dof: int, timeout: float) -> None:
        self.timeout = timeout
        self._zero = np.zeros(dof)
        self.forget()

    def forget(self) -> None:
        """Drop the effort, as before the first one."""
        self._newest: Array | None = None
        self._held = self._zero
        self.received = False
        self.age = np.inf

    @property
    def lost(self) -> bool:
        """Whether there was an effort and it is too old."""
        return self.received and self.age > self.timeout

    def receive(self, effort: Array) -> None:
        """Take a new effort (dof,) N·m; the newest counts."""
        self._newest = effort

    def effort(self, dt: float) -> Array:
        """Return the effort (dof,) N·m of a step that lasts `dt` s."""
        newest, self._newest = self._newest, None
        if newest is not None:
            self._held, self.received, self.age = newest, True, 0.0
        else:
            self.age += dt
        return self._zero if self.age > self.timeout else self._held
