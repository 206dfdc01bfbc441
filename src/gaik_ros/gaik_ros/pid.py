"""PID for several joints at once, parallel form, with filtered derivative, anti-windup and bumpless changes.

    u = p e + ∫ i e dt + d ė_f + k v_ref + b,   limited to [output_min, output_max]

where ė_f is the derivative of the error behind a first-order low-pass, and b is what keeps the output from
jumping where the law changes under it: chosen at the change, then decaying.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

SHORTEST_STEP = 1e-6  # s: a difference over less than this says nothing either
LONGEST_STEP = 0.1  # s: after a longer pause the error's difference says nothing about its derivative


@dataclass(frozen=True, eq=False)
class Gains:
    """The settings of a Pid, each (joints,) or one float for all joints; kept as arrays.

    Raises ValueError for values that are not finite, negative gains and times, and crossed limits.
    """

    p: Any = 3.1  # N·m/rad
    i: Any = 0.01  # N·m/(rad·s)
    d: Any = 0.3  # N·m·s/rad
    feed_forward: Any = 0.0  # N·m·s/rad, on the reference's velocity
    filter_time: Any = 0.05  # s, time constant of the derivative's low-pass; 0: none
    output_min: Any = -1.0  # N·m
    output_max: Any = 1.0  # N·m
    integral_min: Any = -1.0  # N·m, bounds of the integral's share of the output
    integral_max: Any = 1.0  # N·m
    anti_windup: bool = True  # the integral stands still while it would push further into the limit

    def __post_init__(self) -> None:
        for field in fields(self):
            if field.name == "anti_windup":
                continue
            values = np.asarray(getattr(self, field.name), dtype=np.float64)
            object.__setattr__(self, field.name, values)
            if not np.isfinite(values).all():
                raise ValueError(f"{field.name} is {values.tolist()}: it must be finite")
            if field.name in _NON_NEGATIVE and (values < 0.0).any():
                raise ValueError(f"{field.name} is {values.tolist()}: it must not be negative")
        for low, high in (("output_min", "output_max"), ("integral_min", "integral_max")):
            if (getattr(self, low) > 0.0).any() or (getattr(self, high) < 0.0).any():
                raise ValueError(f"{low} must not be above 0, nor {high} below")


_NON_NEGATIVE = ("p", "i", "d", "feed_forward", "filter_time")


class Pid:
    """The state of the controller. `output` is the last one given, N·m."""

    def __init__(self, joints: int, gains: Gains, blend_time: float = 0.1) -> None:
        """`blend_time` in s: how fast b decays after a change of the law."""
        self._joints = joints
        self._blend_time = blend_time
        self._error: Array | None = None
        self._integral = np.zeros(joints)  # the integral's share of the output, N·m
        self._derivative = np.zeros(joints)  # of the error, filtered, rad/s
        self._bias = np.zeros(joints)  # b
        self._resume_from: Array | None = None
        self._decays: tuple[float, float, Array] = (-1.0, 0.0, np.zeros(joints))
        self.output = np.zeros(joints)
        self.set_gains(gains)

    @property
    def integral(self) -> Array:
        """The integral's share of the output, (joints,), N·m."""
        return self._integral.copy()

    def set_gains(self, gains: Gains) -> None:
        """Change the gains without a jump of the output."""
        for field in fields(gains):
            np.broadcast_to(
                getattr(gains, field.name), (self._joints,)
            )  # ValueError: another number of joints
        self.gains = gains
        self._decays = (-1.0, 0.0, np.zeros(self._joints))
        self.resume()

    def resume(self) -> None:
        """Go on from the last output at the next step, whatever the law says then; b bridges the gap."""
        self._resume_from = self.output

    def reset(self, output: ArrayLike | None = None) -> None:
        """Forget integral and derivative; the output goes on from `output` (N·m), by default the last one."""
        self._integral = np.zeros(self._joints)
        self._derivative = np.zeros(self._joints)
        self._error = None
        self.output = np.array(self.output if output is None else output, dtype=np.float64)
        self.resume()

    def step(
        self,
        error: Array,
        dt: float,
        reference_velocity: Array | float = 0.0,
        share: float = 1.0,
        derivative_share: float = 1.0,
    ) -> Array:
        """The effort (joints,) N·m for `error` (joints,) rad, `dt` s after the last step.

        A `dt` of less than a microsecond changes nothing and gives the last output again. The shares, from 0 to 1, are
        of p and of d: what is left of them while the loop is late.
        """
        if not dt >= SHORTEST_STEP:
            return self.output
        g = self.gains
        blend, keep = self._decay(dt)
        if self._error is None or dt > LONGEST_STEP:
            self._derivative = np.zeros(self._joints)
            gained = np.zeros(self._joints)
        else:
            # Exact for an error that is a straight line between the samples.
            self._derivative = keep * self._derivative + (1.0 - keep) * ((error - self._error) / dt)
            gained = g.i * error * dt
        self._error = error
        integral = np.minimum(np.maximum(self._integral + gained, g.integral_min), g.integral_max)
        law = share * g.p * error + integral + derivative_share * g.d * self._derivative
        law = law + g.feed_forward * reference_velocity
        if self._resume_from is not None:
            self._bias = self._resume_from - law
            self._resume_from = None
        else:
            self._bias = blend * self._bias
        wanted = law + self._bias
        self.output = np.minimum(np.maximum(wanted, g.output_min), g.output_max)
        if g.anti_windup:
            winding = (wanted - self.output) * error > 0.0
            integral = np.where(winding, self._integral, integral)
        self._integral = integral
        return self.output

    def _decay(self, dt: float) -> tuple[float, Array]:
        """What b and the filtered derivative keep over `dt`; computed anew only for another dt."""
        if self._decays[0] != dt:
            blend = math.exp(-dt / self._blend_time) if self._blend_time > 0.0 else 0.0
            times = self.gains.filter_time
            keep = np.exp(-dt / np.maximum(times, 1e-12))
            self._decays = (dt, blend, keep)
        return self._decays[1], self._decays[2]
