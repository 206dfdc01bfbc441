"""The joint reference that a node hands out: it moves to its goal under a speed limit of each joint."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


SHORTEST_STEP = 1e-6  # s: less than this is no time
JITTER = (
    0.02  # s: what a moving goal is ahead by no more than this is owed to the times its setpoints come at
)


class JointReference:
    """A position that follows its goal on a straight line in joint space, no joint above its speed limit.

    The limits of joints and axes are linear in the angles, so a line between two admissible positions is
    admissible all along.
    """

    def __init__(self, position: ArrayLike, speed_limit: ArrayLike) -> None:
        """Start at rest at `position` (dof,) rad; `speed_limit` (dof,) or one float, rad/s, above 0."""
        self.position = np.array(position, dtype=np.float64)
        self.velocity = np.zeros_like(self.position)
        self.goal = self.position.copy()
        self._goal_velocity = np.zeros_like(self.position)
        self.set_speed_limit(speed_limit)

    def set_speed_limit(self, speed_limit: ArrayLike) -> None:
        """Change the limit, (dof,) or one float, rad/s. ValueError: not above 0, or not finite."""
        limit = np.broadcast_to(np.asarray(speed_limit, dtype=np.float64), self.position.shape)
        if not (np.isfinite(limit).all() and (limit > 0.0).all()):
            raise ValueError(f"the speed limit is {limit.tolist()}: it must be above 0 and finite")
        self.speed_limit = limit

    @property
    def arrived(self) -> bool:
        """Whether the position is the goal."""
        return bool((self.position == self.goal).all())

    def aim(self, goal: ArrayLike, velocity: ArrayLike | None = None) -> None:
        """Go to `goal` (dof,) rad, which itself moves at `velocity` (dof,) rad/s, by default zero."""
        self.goal = np.array(goal, dtype=np.float64)
        moving = np.zeros_like(self.goal) if velocity is None else np.array(velocity, dtype=np.float64)
        self._goal_velocity = moving * self._slow_down(np.abs(moving))

    def rest(self) -> None:
        """The goal stands still from now on."""
        self._goal_velocity = np.zeros_like(self.goal)

    def stop(self) -> None:
        """Stay where the reference is now."""
        self.aim(self.position)

    def advance(self, dt: float) -> Array:
        """The position (dof,) after `dt` s.

        `velocity` is the goal's where that is reached, or moves and will be at once; else that of the way there.
        """
        if not dt >= SHORTEST_STEP:
            return self.position
        away = self.goal - self.position
        share = self._slow_down(np.abs(away) / dt)
        if share == 1.0:
            self.position = self.goal.copy()
            self.velocity = self._goal_velocity
        else:
            self.position = self.position + share * away
            ahead = float(((1.0 - share) * np.abs(away) / self.speed_limit).max())
            following = ahead < JITTER and bool(self._goal_velocity.any())
            self.velocity = self._goal_velocity if following else share * away / dt
        return self.position

    def _slow_down(self, speeds: Array) -> float:
        """The factor in (0, 1] that brings every one of `speeds`, rad/s, under its limit."""
        return 1.0 / max(1.0, float((speeds / self.speed_limit).max()))
