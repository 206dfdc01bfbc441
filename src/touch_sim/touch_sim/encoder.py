"""Encoders of the joints: what a driver reads of the true angles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Encoder:
    """Gaussian noise, then quantisation, then a velocity made from successive readings as drivers do.

    resolution              rad per count; 0 for none
    noise                   standard deviation in rad of each reading; 0 for none
    seed                    of the noise: the same seed gives the same readings
    velocity_time_constant  of the first-order filter on the differences of readings, s

    An encoder with neither resolution nor noise passes angles and velocity through untouched.
    """

    def __init__(
        self,
        resolution: float = 0.0,
        noise: float = 0.0,
        seed: int = 0,
        velocity_time_constant: float = 0.01,
    ) -> None:
        values = {"resolution": resolution, "noise": noise, "velocity_time_constant": velocity_time_constant}
        for name, value in values.items():
            if not 0.0 <= value < np.inf:
                raise ValueError(f"{name} must be zero or positive and finite, not {value}")
        self.resolution, self.noise, self.seed = resolution, noise, seed
        self.velocity_time_constant = velocity_time_constant
        self.reset()

    def reset(self) -> None:
        """Forget the last reading and start the noise again from the seed."""
        self._random = np.random.default_rng(self.seed)
        self._last: Array | None = None
        self._velocity: Array | None = None

    def read(self, angles: Array, velocity: Array, dt: float) -> tuple[Array, Array]:
        """Return the angles (dof,) rad and velocity (dof,) rad/s read `dt` s after the reading before."""
        if self.resolution == 0.0 and self.noise == 0.0:
            return angles, velocity
        reading = angles
        if self.noise > 0.0:
            reading = reading + self._random.normal(0.0, self.noise, angles.shape)
        if self.resolution > 0.0:
            reading = np.round(reading / self.resolution) * self.resolution
        return reading, self._filtered_velocity(reading, dt)

    def _filtered_velocity(self, reading: Array, dt: float) -> Array:
        """Return the low-passed difference of readings; zero at the first one."""
        if self._last is None or self._velocity is None:
            self._velocity = np.zeros_like(reading)
        elif dt > 0.0:
            slope = (reading - self._last) / dt
            weight = dt / (self.velocity_time_constant + dt)
            self._velocity = self._velocity + weight * (slope - self._velocity)
        self._last = reading
        return self._velocity
