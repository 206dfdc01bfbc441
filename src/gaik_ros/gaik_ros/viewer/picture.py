"""What is drawn, from what was heard: no messages, no page and no clock in it; times in s are handed in."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from gaik_core import KinematicChain
from gaik_ros.viewer.strip_chart import StripChart
from gaik_ros.viewer.trail import Trail
from gaik_ros.viewer.words import NOTHING_YET, Words, nearest_point, verdict_in_words

Array = NDArray[np.float64]

ERROR_WINDOW = 30.0  # s
FRESH = 1.0  # s: a state older than this is not the device's any more


class Picture:
    """The arm, the setpoint, both paths, the errors over time and the last verdict.

    Attributes:
        angles: (dof,) rad, the device's; home before the first.
        tip: (3,) m, by forward kinematics from `angles`.
        setpoint: (3,) m, the newest; None before the first.
        nearest: (3,) m, where the tip goes because it cannot reach the setpoint; None where it can.
        desired, followed: the trails of the setpoint and of the tip.
        errors: the tip's distance in m from the setpoint, and from the reference that the controller follows.
        verdict: the last, in words.
    """

    def __init__(self, chain: KinematicChain) -> None:
        self._chain = chain
        self._state_time: float | None = None
        self._reference: Array | None = None  # (3,) m, the tip of the joint reference
        self._aimed: float | None = None  # m, the error at the last setpoint; None where it was taken
        self.angles: Array = chain.home
        self.tip: Array = chain.forward(chain.home)
        self.setpoint: Array | None = None
        self.nearest: Array | None = None
        self.desired, self.followed = Trail(), Trail()
        self.errors = StripChart(2, ERROR_WINDOW)
        self.verdict: Words = NOTHING_YET

    def hear_state(self, angles: Array, now: float) -> None:
        """The device is at `angles` (dof,) rad."""
        self._state_time = now
        self.angles, self.tip = angles, self._chain.forward(angles)
        self.followed.add(self.tip)

    def hear_reference(self, angles: Array) -> None:
        """The controller is to be at `angles` (dof,) rad."""
        self._reference = self._chain.forward(angles)

    def hear_setpoint(self, position: Array, angles: Array | None) -> None:
        """The tip is to be at `position` (3,) m; the device was at `angles` (dof,) when that was said.

        The error on a moving path means the distance at the same moment: a state heard some ms later would
        show a tip that has meanwhile gone on toward the setpoint.
        """
        if not np.isfinite(position).all():
            return
        self.setpoint = position
        self.desired.add(position)
        if angles is not None:
            self._aimed = float(np.linalg.norm(position - self._chain.forward(angles)))

    def hear_verdict(self, values: Mapping[str, str], message: str) -> None:
        """What ik_node says of a setpoint."""
        self.verdict = verdict_in_words(values, message)
        nearest = nearest_point(values)
        self.nearest = None if nearest is None else np.array(nearest)

    def live(self, now: float) -> bool:
        """Whether the device is heard."""
        return self._state_time is not None and now - self._state_time <= FRESH

    def sample(self, now: float) -> None:
        """Take one sample of the errors, NaN where there is nothing to compare."""
        aimed, self._aimed = self._aimed, None
        if aimed is None:
            aimed = self._distance(self.setpoint, now)
        self.errors.add(now, (aimed, self._distance(self._reference, now)))

    def _distance(self, point: Array | None, now: float) -> float:
        return np.nan if point is None or not self.live(now) else float(np.linalg.norm(self.tip - point))

    def clear(self) -> None:
        """Forget both paths."""
        self.desired.clear()
        self.followed.clear()
