"""Arrays whose last axis holds the components of a vector, a quaternion or a multivector."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gaik_core.errors import GaikError, ShapeError

Array = NDArray[np.float64]


def numbers(what: str, value: ArrayLike) -> Array:
    """`value` as float64, of any shape; GaikError where it is not made of real numbers."""
    array = np.asarray(value)
    if array.dtype.kind not in "biuf":
        raise GaikError(f"{what} has the type {array.dtype}; expected real numbers")
    return array.astype(np.float64, copy=False)


def components(what: str, value: ArrayLike, length: int) -> Array:
    """`value` as float64 `(…, length)`; ShapeError where the last axis has another length."""
    array = numbers(what, value)
    if array.ndim == 0 or array.shape[-1] != length:
        raise ShapeError(what, array.shape, f"(…, {length})")
    return array


def select(array: Array, index: object) -> Array:
    """`array[index]` by the leading axes only: the components on the last axis stay together."""
    leading = index if isinstance(index, tuple) else (index,)
    selected: Array = array[(*leading, slice(None))]
    return selected
