"""Checks of the arguments that users pass in."""

from __future__ import annotations

import math
from reprlib import repr as shortened

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gaik_core.errors import GaikError, NotFiniteError, ShapeError

Array = NDArray[np.float64]

_FLOAT = np.dtype(np.float64)  # made once: a solve has microseconds


def array_of(what: str, value: ArrayLike) -> Array:
    """`value` as a contiguous array of float64; raises ShapeError where it is no array of numbers."""
    try:
        return np.ascontiguousarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise GaikError(f"{what} is {shortened(value)}; expected an array of numbers") from None


def unit_vector(what: str, value: ArrayLike, length: int) -> Array:
    """`value` (length,) made a unit vector; raises GaikError where it is zero or not finite."""
    array = finite_vector(what, value, length)
    largest = float(np.abs(array).max())
    if largest == 0.0:
        raise GaikError(f"{what} is {array.tolist()}; expected anything but zero")
    array /= largest  # so that 1e200 does not overflow
    array /= np.linalg.norm(array)
    return array


def finite(what: str, array: Array) -> Array:
    """The array itself; raises NotFiniteError, which of many vectors names the first that is not."""
    good = np.isfinite(array)
    if not good.all():
        first = tuple(np.argwhere(~good)[0][:-1])
        raise NotFiniteError(what + "".join(f"[{i}]" for i in first), array[first].tolist())
    return array


def copied_vector(what: str, value: ArrayLike, length: int) -> Array:
    """A copy of `value` as an array (length,), contiguous and not yet known to be finite."""
    try:
        array = np.array(value, _FLOAT)
    except (TypeError, ValueError):
        raise GaikError(f"{what} is {shortened(value)}; expected an array of numbers") from None
    if array.shape != (length,):
        raise ShapeError(what, array.shape, f"({length},)")
    return array


def finite_vector(what: str, value: ArrayLike, length: int) -> Array:
    """`value` as a finite array (length,)."""
    return finite(what, copied_vector(what, value, length))


def rows(what: str, value: ArrayLike, length: int) -> Array:
    """`value` as a finite array (m, length)."""
    array = array_of(what, value)
    if array.ndim != 2 or array.shape[1] != length:
        raise ShapeError(what, np.shape(value), f"(m, {length})")
    return finite(what, array)


def is_number(value: object) -> bool:
    """Whether a value is a real number, of Python or of NumPy; True and False are none."""
    return isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool)


def positive(what: str, value: float) -> float:
    """`value`, a number above 0 and finite."""
    try:
        if 0.0 < value < math.inf:
            return float(value)
    except (TypeError, ValueError):
        pass
    raise GaikError(f"{what} is {value!r}; expected a number above 0 and finite")


def count(what: str, value: int) -> int:
    """`value`, a whole number of at least 0."""
    if type(value) is int and value >= 0:
        return value
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < 0:
        raise GaikError(f"{what} is {value!r}; expected a whole number of at least 0")
    return int(value)
