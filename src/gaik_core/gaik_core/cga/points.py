"""Positions in space as conformal points, and back."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gaik_core import arrays
from gaik_core.arrays import Array
from gaik_core.cga.basis import BLADES, E1, E2, E3, E4, E5, GRADES
from gaik_core.cga.multivector import Multivector, wrap
from gaik_core.errors import GaikError


class InfinitePointError(GaikError):
    """A vector with no weight on e0: it lies at infinity and has no position."""


def up(positions: ArrayLike) -> Multivector:
    """The conformal points p = x + ½ x² einf + e0 (eqs. 11, 46) of positions `(…, 3)`; p² = 0 and p·einf = -1."""
    positions = arrays.components("positions", positions, 3)
    half_square = 0.5 * np.sum(positions * positions, axis=-1)
    x = np.zeros((*positions.shape[:-1], BLADES))
    x[..., [E1, E2, E3]] = positions
    x[..., E4] = half_square - 0.5
    x[..., E5] = half_square + 0.5
    return wrap(x)


def down(points: Multivector) -> Array:
    """The positions `(…, 3)` of conformal points of any weight; of a sphere, its centre.

    InfinitePointError where the weight is zero to rounding, as for einf and planes; GaikError for what is no vector.
    """
    x = vector_components("a point", points)
    weight = weight_of(x)
    if np.any(np.abs(weight) <= 1e-15 * np.abs(x).max(axis=-1)):
        raise InfinitePointError("a vector with no weight on e0 lies at infinity: it has no position")
    positions: Array = x[..., [E1, E2, E3]] / weight[..., None]
    return positions


def distance(p: Multivector, q: Multivector) -> Array:
    """The Euclidean distance of two points of any weight, shape `(…)`.

    It is √(-2 p·q) of unit weights (eqs. 47, 48), but that loses all digits where the points are close together and far
    from the origin. InfinitePointError for a point at infinity.
    """
    distances: Array = np.linalg.norm(down(p) - down(q), axis=-1)
    return distances[()]


def weight_of(x: Array) -> Array:
    """-x·einf, the coefficient of e0 in a vector, shape `(…)`."""
    weight: Array = x[..., E5] - x[..., E4]
    return weight


def vector_components(what: str, x: Multivector) -> Array:
    """The components of what has to be a vector, to rounding; GaikError where it is not."""
    return graded_components(what, x, 1)


def graded_components(what: str, x: Multivector, grade: int) -> Array:
    """The components of what has to have one grade, to rounding; GaikError where it has another."""
    size = np.abs(x.components)
    if np.any(1e-9 * size.max(axis=-1) < size[..., grade != GRADES].max(axis=-1)):
        raise GaikError(f"{what} has grade {grade}; this has the grades {x.grades(1e-9 * float(size.max()))}")
    return x.components
