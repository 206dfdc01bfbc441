"""First-order joint dynamics `τ θ' + κ θ = K u`, stepped exactly and held inside the joint limits.

The paper names "first-order joint dynamics" only; K, τ and κ are a choice (see the defaults of `JointModel`).
Nothing here knows ROS or reads a clock: a step takes an effort and a duration.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from touch_sim.joint_limits import JointLimits

Array = NDArray[np.float64]


@dataclass(frozen=True)
class JointModel:
    """The constants of `τ θ' + κ θ = K u`; each a number for all joints or one per joint, shape (dof,).

    gain           K in rad/(N·m), positive
    time_constant  τ in s, positive
    stiffness      κ, no unit, not negative; 0 is a viscous axis that integrates (a damper of τ/K N·m·s/rad)
    effort_limit   largest effort taken, N·m, positive; a larger one is cut to it
    """

    gain: ArrayLike = 1.0
    time_constant: ArrayLike = 0.05
    stiffness: ArrayLike = 0.0
    effort_limit: ArrayLike = 1.0

    def __post_init__(self) -> None:
        for name in ("gain", "time_constant", "effort_limit"):
            values = np.asarray(getattr(self, name), dtype=float)
            if not (np.isfinite(values) & (values > 0.0)).all():
                raise ValueError(f"{name} must be positive and finite, not {getattr(self, name)}")
        stiffness = np.asarray(self.stiffness, dtype=float)
        if not (np.isfinite(stiffness) & (stiffness >= 0.0)).all():
            raise ValueError(f"stiffness must be zero or positive and finite, not {self.stiffness}")


def hold_factor(stiffness: Array, time_constant: Array, dt: float) -> Array:
    """Return the factor f of the exact step `θ + f θ'(0)` under a constant effort, in s.

    The axis decays with the rate κ/τ, so f = (1 - exp(-κ dt/τ)) τ/κ, which tends to dt as κ tends to 0.
    """
    decay = stiffness * dt / time_constant
    # expm1 keeps every digit where the decay is small; exactly zero has the limit 1.
    ratio = np.divide(-np.expm1(-decay), decay, out=np.ones_like(decay), where=decay > 0.0)
    return np.asarray(dt * ratio)


class JointDynamics:
    """The joints of one device: their angles, their velocity, and the step under an effort.

    `angles` (dof,) rad and `velocity` (dof,) rad/s hold after the last step, `effort` (dof,) N·m acted in it, cut
    to its limit. A step replaces them and never changes them in place, so that a caller may keep them.
    """

    def __init__(self, model: JointModel, limits: JointLimits, angles: ArrayLike) -> None:
        self.limits = limits
        self.set_model(model)
        self.reset(angles)

    def set_model(self, model: JointModel) -> None:
        """Put other constants in force; the joints stay where they are."""
        self.model = model
        self.gain, self.time_constant, self.stiffness, self.effort_limit = (
            np.broadcast_to(np.asarray(value, dtype=float), self.limits.lower.shape).copy()
            for value in (model.gain, model.time_constant, model.stiffness, model.effort_limit)
        )
        self.mobility = self.gain / self.time_constant
        self._hold_dt: float | None = None
        self._hold = np.zeros_like(self.gain)

    def reset(self, angles: ArrayLike) -> None:
        """Put the joints to `angles` (dof,) rad, at rest. Raise ValueError where these break a limit."""
        start = np.array(angles, dtype=float)
        self.limits.check(start)
        self.angles: Array = start
        self.velocity: Array = np.zeros_like(start)
        self.effort: Array = np.zeros_like(start)

    def step(self, effort: ArrayLike, dt: float) -> None:
        """Advance by `dt` s under the constant `effort` (dof,) N·m: the exact zero-order hold.

        Each joint moves monotonically during a step, so that stopping at a limit is exact as well. Raise
        ValueError, with nothing changed, for an effort that is not finite or a negative dt.
        """
        asked = np.asarray(effort, dtype=float)
        if asked.shape != self.angles.shape or not np.isfinite(asked).all():
            raise ValueError(f"effort must be {self.angles.size} finite numbers, not {asked.tolist()}")
        if not 0.0 <= dt < np.inf:
            raise ValueError(f"dt must be zero or positive, not {dt}")
        if dt != self._hold_dt:
            self._hold, self._hold_dt = hold_factor(self.stiffness, self.time_constant, dt), dt
        given = np.minimum(np.maximum(asked, -self.effort_limit), self.effort_limit)

        free = self.angles + self._hold * self._free_velocity(self.angles, given)
        angles = self.limits.hold(self.angles, free, self.mobility)
        velocity = self._free_velocity(angles, given)
        if (angles != free).any() and dt > 0.0:
            # On a limit: what the limit lets through of the velocity.
            velocity = (self.limits.hold(angles, angles + velocity * dt, self.mobility) - angles) / dt
        self.angles, self.velocity, self.effort = angles, velocity, given

    def _free_velocity(self, angles: Array, effort: Array) -> Array:
        """Return θ' = (K u - κ θ)/τ in rad/s."""
        return np.asarray((self.gain * effort - self.stiffness * angles) / self.time_constant)
