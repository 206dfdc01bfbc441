"""How late a control loop has lately been, and how much of its gains that leaves.

An effort that acts for longer than it was meant to, or that answers an old state, is a gain that swings the device:
a loop of gain g 1/s that is held for h s diverges as soon as g h > 2. So the gains fall as lateness grows, the
derivative's first, since it has most of the gain at high frequencies, and come back once it is over (ADR 5).
"""

from __future__ import annotations

import math

MEMORY = 0.3  # s: how fast a past lateness is forgotten
MOST = 0.05  # s: a longer one counts as this; what lasts longer is a watchdog's business
SPAN = 2.5  # times what is tolerated, the derivative is gone and the rest begins to fall


class Lateness:
    """Remembers the worst lateness of the last moments and gives the shares of the gains."""

    def __init__(self, tolerated: float) -> None:
        """`tolerated` in s, above 0: up to this the gains are full."""
        self.tolerated = tolerated
        self.worst = 0.0  # s

    def note(self, late: float, dt: float) -> None:
        """A step of `dt` s whose tick or state came `late` s later than it should."""
        self.worst = max(min(late, MOST), self.worst * math.exp(-dt / MEMORY))

    @property
    def share(self) -> float:
        """Of the proportional gain, in (0, 1]: lateness times gain stays what it is at the end of the span."""
        end = SPAN * self.tolerated
        return 1.0 if self.worst <= end else end / self.worst

    @property
    def derivative_share(self) -> float:
        """Of the derivative gain, in [0, 1]."""
        if self.worst <= self.tolerated:
            return 1.0
        return max(0.0, (SPAN * self.tolerated - self.worst) / ((SPAN - 1.0) * self.tolerated))
