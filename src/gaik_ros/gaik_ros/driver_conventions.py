"""Between our conventions and a driver's: joint angles by a linear map, joint efforts into a force on the tip.

The map of the angles is θ_d = S C θ + o: C is the chain's coupling where the driver measures each angle from the link
before it (the Touch's elbow: θ3 - θ2), the identity otherwise; S has the signs, o the offsets. Rates follow it
without o; efforts go against it, τ = (S C)ᵀ τ_d, so that the power τ·θ' is the same on both sides.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gaik_core import KinematicChain

Array = NDArray[np.float64]

FULL = 2.0
"""The force is whole where the smallest singular value is this many times the one at which it is zero."""


class JointConvention:
    """A driver's joint angles beside ours."""

    def __init__(self, chain: KinematicChain, relative: bool, signs: ArrayLike, offsets: ArrayLike) -> None:
        """`signs` (dof,) of ±1 and `offsets` (dof,) rad of the driver's angles.

        Raises ValueError where they are others, or where `relative` angles are asked for of a chain with passive axes.
        """
        if relative and len(chain.joints) != chain.dof:
            raise ValueError(f"{chain.name} has passive axes; a driver's angles cannot be told from ours")
        turned, moved = (np.array(values, dtype=np.float64) for values in (signs, offsets))
        if turned.shape != (chain.dof,) or not np.isin(turned, (-1.0, 1.0)).all():
            raise ValueError(
                f"joint_signs are {turned.tolist()}: they may be {chain.dof} numbers, each 1 or -1"
            )
        if moved.shape != (chain.dof,) or not np.isfinite(moved).all():
            raise ValueError(f"joint_offsets are {moved.tolist()}: they may be {chain.dof} numbers")
        if relative:
            moved = moved + turned * chain.offset
        self._to = turned[:, None] * (chain.coupling if relative else np.eye(chain.dof))
        self._from = np.linalg.inv(self._to)
        self._offsets = moved

    def to_driver(self, angles: Array) -> Array:
        """The driver's angles (dof,) rad for ours."""
        return self._to @ angles + self._offsets

    def from_driver(self, angles: Array) -> Array:
        """Our angles (dof,) rad for the driver's."""
        return self._from @ (angles - self._offsets)

    def rates_to_driver(self, rates: Array) -> Array:
        """The driver's rates (dof,) rad/s for ours."""
        return self._to @ rates

    def rates_from_driver(self, rates: Array) -> Array:
        """Our rates (dof,) rad/s for the driver's."""
        return self._from @ rates

    def efforts_to_driver(self, efforts: Array) -> Array:
        """The driver's efforts (dof,) N·m for ours."""
        return self._from.T @ efforts

    def efforts_from_driver(self, efforts: Array) -> Array:
        """Our efforts (dof,) N·m for the driver's."""
        return self._to.T @ efforts


def signed_axes(text: str) -> Array:
    """The rotation (3, 3) whose rows are the axes named, as in "x -z y": what of ours each axis of the driver is.

    Raises ValueError where they are no right-handed axes.
    """
    words = text.split()
    rows = np.zeros((3, 3))
    if len(words) == 3:
        for row, word in zip(rows, words, strict=True):
            axis = word.removeprefix("-")
            if axis in ("x", "y", "z"):
                row["xyz".index(axis)] = -1.0 if word.startswith("-") else 1.0
    if np.linalg.det(rows) < 0.5:
        raise ValueError("it may be three right-handed axes, such as x -z y")
    return rows


def has_tip_force(chain: KinematicChain) -> bool:
    """Whether joint efforts make a force on the tip: where three joints move it in space."""
    anywhere = chain.home + np.linspace(0.3, 0.7, chain.dof)  # home itself may be singular
    return chain.dof == 3 and bool(np.linalg.matrix_rank(chain.jacobian(anywhere)) == 3)


@dataclass(frozen=True)
class TipForce:
    """A force (3,) N on the tip, in our frame, and the share of what was asked for: below 1 where it was cut."""

    vector: Array
    share: float


def tip_force(jacobian: Array, efforts: Array, max_force: float, singular_value: float) -> TipForce:
    """The force that does at the tip what `efforts` (3,) N·m do at the joints: f = J⁻ᵀ τ, so that f·v = τ·θ'.

    Its direction is kept where it is cut: to `max_force` N, and towards singular poses, where no finite force does
    what the efforts do: to zero once the smallest singular value of the Jacobian (3, 3) is `singular_value` m/rad or
    less, linearly from FULL times that on.
    """
    left, values, right = np.linalg.svd(jacobian)
    share = float(np.clip((values[-1] / singular_value - 1.0) / (FULL - 1.0), 0.0, 1.0))
    if share == 0.0:
        return TipForce(np.zeros(3), 0.0)
    force = left @ ((right @ efforts) / values)
    size = float(np.linalg.norm(force))
    if share * size > max_force:
        share = max_force / size
    return TipForce(share * force, share)
