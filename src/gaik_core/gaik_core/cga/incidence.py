"""Where objects meet, what joins them, and how they mirror each other."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from gaik_core.arrays import Array
from gaik_core.cga.basis import BLADES, GRADES, VECTORS
from gaik_core.cga.inverse import norm_squared
from gaik_core.cga.multivector import Multivector, wrap
from gaik_core.cga.products import OUTER, dual, product, undual
from gaik_core.errors import GaikError

_RANK_TOLERANCE = 1e-9
_NULL_TOLERANCE = 1e-14
_BASIS_VECTORS = np.eye(BLADES)[1 << np.arange(VECTORS)]


def meet(a: Multivector, b: Multivector) -> Multivector:
    """The object of the points that two objects have in common: of two planes a line, of a sphere and a plane a circle.

    Where A ∧ B does not vanish it is that, and carries its orientation; where it does, because the two lie in
    something smaller than the whole space (two lines in a plane), the common part is found all the same, up to sign.
    Objects that share nothing but infinity meet in einf. `radius_squared` tells a real meet from an imaginary one.
    Each pair of broadcast objects is decided by itself. GaikError for what is no blade.
    """
    return _each_pair(_meet_of_outer_forms, a, b)


def join(a: Multivector, b: Multivector) -> Multivector:
    """The smallest object that contains both: of two points their pair, of a line and a point a plane.

    The outer product of the outer forms where that does not vanish; where the two share something, up to its sign.
    GaikError for what is no blade.
    """
    return _each_pair(_join_of_outer_forms, a, b)


def reflect(x: Multivector, mirror: Multivector) -> Multivector:
    """x mirrored in a plane, inverted in a sphere, turned by π about a line: V x V⁻¹, x involuted where V is odd."""
    even, odd = mirror.even().components.any(), mirror.odd().components.any()
    if even and odd:
        raise GaikError("a mirror has even grades or odd ones, not both")
    return mirror * (x.grade_involution() if odd else x) * mirror.inverse()


def outer_form(x: Multivector) -> Multivector:
    """The outer product of points of an object: its undual, but a point's is itself."""
    return wrap(_convert(x.components, undual))


def inner_form(x: Multivector) -> Multivector:
    """The object of an outer product of points: its dual, but a point's is itself."""
    return wrap(_convert(x.components, dual))


def _convert(x: Array, change: Callable[[Array], Array]) -> Array:
    """`change` of every multivector but the points, which are null vectors."""
    vector = x * (GRADES == 1)
    size = _NULL_TOLERANCE * np.sum(x * x, axis=-1)
    is_point = (np.abs(norm_squared(vector)) <= size) & (np.sum((x - vector) ** 2, axis=-1) <= size)
    return np.where(is_point[..., None], x, change(x))


def _each_pair(combine: Callable[[Array, Array], Array], a: Multivector, b: Multivector) -> Multivector:
    left, right = np.broadcast_arrays(outer_form(a).components, outer_form(b).components)
    result = np.empty(left.shape)
    for index in np.ndindex(left.shape[:-1]):
        result[index] = combine(left[index], right[index])
    return inner_form(wrap(result))


def _meet_of_outer_forms(a: Array, b: Array) -> Array:
    """The blade of the subspace that two blades share."""
    factors_a, factors_b = _factors(a), _factors(b)
    combinations, _, rank = _decompose(np.concatenate((factors_a, factors_b)))
    if rank == VECTORS:
        return undual(product(OUTER, dual(a), dual(b)))
    # a combination of all factors that vanishes says that its part in A is minus its part in B: a shared vector
    shared = combinations[: len(factors_a), rank:].T @ factors_a
    return _blade(shared, a, b)


def _join_of_outer_forms(a: Array, b: Array) -> Array:
    """The blade of the subspace that two blades span."""
    factors = np.concatenate((_factors(a), _factors(b)))
    _, spanning, rank = _decompose(factors)
    return product(OUTER, a, b) if rank == len(factors) else _blade(spanning[:rank], a, b)


def _factors(blade: Array) -> Array:
    """Vectors `(grade, 5)` that span a blade: those whose outer product with it is zero."""
    grades = np.unique(GRADES[np.abs(blade) > _RANK_TOLERANCE * np.abs(blade).max()])
    left, _, rank = _decompose(product(OUTER, _BASIS_VECTORS, blade))
    if len(grades) != 1 or VECTORS - rank != grades[0]:
        raise GaikError("meet and join take blades: this multivector is no outer product of vectors")
    return left[:, rank:].T


def _decompose(matrix: Array) -> tuple[Array, Array, int]:
    """The singular vectors on the left and on the right, and the rank."""
    left, values, right = np.linalg.svd(matrix)
    rank = int(np.sum(values > _RANK_TOLERANCE * values.max(initial=0.0)))
    return left, right, rank


def _blade(vectors: Array, a: Array, b: Array) -> Array:
    """The outer product of vectors `(k, 5)`, as large as a and b together, its largest component positive."""
    blade = np.zeros(BLADES)
    blade[0] = 1.0
    for vector in vectors:
        blade = product(OUTER, blade, vector @ _BASIS_VECTORS)
    size = np.linalg.norm(a) * np.linalg.norm(b) / np.linalg.norm(blade)
    result: Array = blade * np.copysign(size, blade[np.argmax(np.abs(blade))])
    return result
