"""Checks of the arrays that users pass in."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gaik_core.errors import NotFiniteError, ShapeError

Array = NDArray[np.float64]


def finite_array(what: str, value: ArrayLike) -> Array:
    """`value` as a contiguous array of float64; raises NotFiniteError, or ShapeError where it is no array of numbers."""
    try:
        array = np.ascontiguousarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise ShapeError(what, np.shape(np.asarray(value, dtype=object)), "an array of numbers") from None
    if not np.isfinite(array).all():
        raise NotFiniteError(what, array.tolist())
    return array


def vector(what: str, value: ArrayLike, length: int) -> Array:
    """`value` as an array (length,)."""
    array = finite_array(what, value)
    if array.shape != (length,):
        raise ShapeError(what, np.shape(value), f"({length},)")
    return array


def rows(what: str, value: ArrayLike, length: int) -> Array:
    """`value` as an array (m, length)."""
    array = finite_array(what, value)
    if array.ndim != 2 or array.shape[1] != length:
        raise ShapeError(what, np.shape(value), f"(m, {length})")
    return array
