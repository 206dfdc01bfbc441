"""Limits of joints, and of axes that several joints turn together, as hard stops.

The Touch's stop between its arms limits θ3 - θ2: a push against it turns shoulder and elbow together.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from gaik_core import KinematicChain

Array = NDArray[np.float64]

TOLERANCE = 1e-9  # rad; a start this far outside is rounding, not a mistake


@dataclass(frozen=True)
class JointLimits:
    """`lower <= angles <= upper` and `axis_lower <= coupling @ angles + offset <= axis_upper`, all in rad.

    lower, upper (dof,); coupling (axes, dof); offset, axis_lower, axis_upper (axes,); infinite where there is
    none.
    """

    lower: Array
    upper: Array
    coupling: Array
    offset: Array
    axis_lower: Array
    axis_upper: Array
    joint_names: tuple[str, ...] = ()
    axis_names: tuple[str, ...] = ()

    @classmethod
    def of_joints(cls, lower: Array, upper: Array) -> JointLimits:
        """Return limits of the joints alone."""
        lower, upper = np.array(lower, dtype=float), np.array(upper, dtype=float)
        none = np.zeros(0)
        return cls(lower, upper, np.zeros((0, lower.size)), none, none, none)

    @classmethod
    def of_chain(cls, chain: KinematicChain) -> JointLimits:
        """Return the limits of a robot; axes without a limit of their own are left out."""
        limited = np.isfinite(chain.axis_lower) | np.isfinite(chain.axis_upper)
        return cls(
            lower=np.array(chain.lower, dtype=float),
            upper=np.array(chain.upper, dtype=float),
            coupling=np.asarray(chain.coupling, dtype=float)[limited],
            offset=np.asarray(chain.offset, dtype=float)[limited],
            axis_lower=np.asarray(chain.axis_lower, dtype=float)[limited],
            axis_upper=np.asarray(chain.axis_upper, dtype=float)[limited],
            joint_names=tuple(chain.joint_names),
            axis_names=tuple(
                name for name, has_limit in zip(chain.axis_names, limited, strict=True) if has_limit
            ),
        )

    def check(self, angles: Array) -> None:
        """Raise ValueError where `angles` (dof,) are not finite or break a limit, whose name it says."""
        if angles.shape != self.lower.shape or not np.isfinite(angles).all():
            raise ValueError(f"angles must be {self.lower.size} finite numbers, not {angles.tolist()}")
        joints = zip(_named(self.joint_names, "joint", angles), angles, self.lower, self.upper, strict=True)
        turned = self.coupling @ angles + self.offset
        axes = zip(
            _named(self.axis_names, "axis", turned), turned, self.axis_lower, self.axis_upper, strict=True
        )
        for name, value, low, high in (*joints, *axes):
            if not low - TOLERANCE <= value <= high + TOLERANCE:
                raise ValueError(f"{name} is at {value:.6g} rad, its limits are {low:.6g} to {high:.6g} rad")

    def hold(self, previous: Array, moved: Array, mobility: Array) -> Array:
        """Return `moved` (dof,) pushed back inside the limits; `previous` (dof,) is inside.

        A stop between two joints pushes each back in proportion to its `mobility` (dof,), the speed that an
        effort gives it, as the stop's equal and opposite efforts would.
        """
        angles = np.minimum(np.maximum(moved, self.lower), self.upper)
        if not self.axis_lower.size or not self._excess(angles).any():
            return np.asarray(angles)
        # Each pass either satisfies an axis or lays one more joint on its own stop.
        for _ in range(self.lower.size * self.axis_lower.size):
            for axis in np.flatnonzero(self._excess(angles)):
                angles = self._push_back(angles, int(axis), mobility)
        if np.abs(self._excess(angles)).max() > TOLERANCE:
            return self._last_inside(previous, angles)
        return angles

    def _excess(self, angles: Array) -> Array:
        """Return how far each axis is beyond its limits, (axes,) rad, signed."""
        turned = self.coupling @ angles + self.offset
        return np.asarray(turned - np.minimum(np.maximum(turned, self.axis_lower), self.axis_upper))

    def _push_back(self, angles: Array, axis: int, mobility: Array) -> Array:
        """Return `angles` with one axis moved back to its limit by the joints that are free to give way."""
        row, excess = self.coupling[axis], self._excess(angles)[axis]
        direction = -np.sign(excess) * row
        free = np.where(direction > 0.0, angles < self.upper, angles > self.lower) & (row != 0.0)
        way = np.where(free, mobility * row, 0.0)
        if not free.any():
            return angles
        moved = angles - way * excess / (row @ way)
        return np.asarray(np.minimum(np.maximum(moved, self.lower), self.upper))

    def _last_inside(self, previous: Array, angles: Array) -> Array:
        """Return the last point of the line from `previous` to `angles` that is inside every axis limit."""
        start, end = (self.coupling @ point + self.offset for point in (previous, angles))
        limit = np.where(end > start, self.axis_upper, self.axis_lower)
        room = np.divide(limit - start, end - start, out=np.ones_like(start), where=end != start)
        return previous + float(np.clip(room.min(), 0.0, 1.0)) * (angles - previous)


def _named(names: tuple[str, ...], kind: str, values: Array) -> list[str]:
    """Return the names with their kind, or numbered ones where there are none."""
    return [f"{kind} {name}" for name in names or range(values.size)]
