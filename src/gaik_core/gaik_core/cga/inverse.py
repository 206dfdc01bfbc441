"""Norm and inverse of multivectors, on arrays `(…, 32)`."""

from __future__ import annotations

import numpy as np

from gaik_core.arrays import Array
from gaik_core.cga.basis import BITS, BLADES, GRADES, REVERSE, SIGNS
from gaik_core.cga.products import GEOMETRIC, product
from gaik_core.errors import GaikError

_EPSILON = float(np.finfo(float).eps)
_XOR = BITS[:, None] ^ BITS
_LEFT_SIGNS = SIGNS[_XOR, BITS]
"""Y ↦ X Y has the matrix x[k xor j] SIGNS[k xor j, j]."""


class NotInvertibleError(GaikError):
    """A multivector without an inverse, such as a null vector, or without a norm to divide by."""


def norm_squared(x: Array) -> Array:
    """⟨X X̃⟩₀, shape `(…)`: of either sign, as e5² = -1.

    x4² - x5² is taken as a product: in a motor far from the origin both are large and equal, and their squares would
    swamp the rest.
    """
    euclidean, on_e4, on_e5, on_e45 = x[..., :8], x[..., 8:16], x[..., 16:24], x[..., 24:]
    total: Array = np.sum(euclidean**2 - on_e45**2 + (on_e4 - on_e5) * (on_e4 + on_e5), axis=-1)
    return total


def normalise(x: Array) -> Array:
    """X / √|⟨X X̃⟩₀|; NotInvertibleError where that is zero to rounding."""
    squared = norm_squared(x)
    if np.any(_is_null(squared, x)):
        raise NotInvertibleError("a null multivector (⟨X X̃⟩₀ = 0) cannot be normalised")
    return x / np.sqrt(np.abs(squared))[..., None]


def inverse(x: Array) -> Array:
    """X⁻¹ with X X⁻¹ = X⁻¹ X = 1, of any multivector that has one; NotInvertibleError where there is none, to rounding.

    Where X X̃ is a scalar, as it is for versors and blades, X⁻¹ = X̃ / X X̃; else it comes by linear algebra.
    """
    x_reverse = x * REVERSE
    square = product(GEOMETRIC, x, x_reverse)
    remainder = np.abs(square[..., 1:]).max(axis=-1, initial=0.0)
    if np.all(remainder <= 16.0 * _EPSILON * np.abs(square[..., 0])):
        if np.any(_is_null(square[..., 0], x)):
            raise NotInvertibleError(_message("⟨X X̃⟩₀ is zero"))
        return x_reverse / square[..., :1]
    return _inverse_by_linear_algebra(x)


def _inverse_by_linear_algebra(x: Array) -> Array:
    """The solution Y of X Y = 1, where Y ↦ X Y is a matrix 32 by 32."""
    matrix = x[..., _XOR] * _LEFT_SIGNS
    one = np.zeros((BLADES, 1))
    one[0] = 1.0
    try:
        solution: Array = np.linalg.solve(matrix, np.broadcast_to(one, (*matrix.shape[:-1], 1)))[..., 0]
    except np.linalg.LinAlgError:
        raise NotInvertibleError(_message("X Y = 1 has no solution")) from None
    # the Frobenius norm of such a matrix is √32 times the norm of its multivector, so this is the condition number
    condition = BLADES * np.sqrt(np.sum(x * x, axis=-1) * np.sum(solution * solution, axis=-1))
    if not np.all(condition < 1.0 / (BLADES * _EPSILON)):
        raise NotInvertibleError(_message("X Y = 1 has no solution"))
    return solution


def _is_null(squared: Array, x: Array) -> np.ndarray:
    null: np.ndarray = np.abs(squared) <= 4.0 * _EPSILON * np.sum(x * x, axis=-1)
    return null


def _message(reason: str) -> str:
    return f"the multivector has no inverse: {reason}, to rounding"


def grades(x: Array, tolerance: float) -> tuple[int, ...]:
    """The grades of which some component is larger than the tolerance."""
    present = np.abs(x.reshape(-1, BLADES)).max(axis=0, initial=0.0) > tolerance
    return tuple(int(grade) for grade in np.unique(GRADES[present]))
