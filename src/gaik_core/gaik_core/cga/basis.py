"""The 32 basis blades of G(4,1), and the signs that the product of any two of them takes.

A blade is numbered by its bits: bit i says whether e(i+1) is a factor. So 3 is e12, 24 is e45, 31 the pseudoscalar.
The product of two blades is again a blade, up to its sign: e_A e_B = SIGNS[A, B] e_(A xor B).
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from gaik_core.arrays import Array
from gaik_core.errors import GaikError


class BladeNameError(GaikError):
    """A name that is no basis blade."""


VECTORS = 5
BLADES = 1 << VECTORS
SQUARES = (1.0, 1.0, 1.0, 1.0, -1.0)
"""e1² … e5² (eqs. 8 and 9)."""

BITS = np.arange(BLADES)
GRADES = np.array([index.bit_count() for index in range(BLADES)])
NAMES = tuple(
    "e" + "".join(str(bit + 1) for bit in range(VECTORS) if index >> bit & 1) if index else "1"
    for index in range(BLADES)
)

SCALAR, E4, E5, E45, PSEUDOSCALAR = 0, 8, 16, 24, 31
E1, E2, E3, E12, E13, E23, E123 = 1, 2, 4, 3, 5, 6, 7


def _sign(a: int, b: int) -> float:
    """The sign of e_A e_B: one -1 for each pair that sorting swaps, one e_i² for each factor that both share."""
    swaps = sum((a >> shift & b).bit_count() for shift in range(1, VECTORS))
    squares = math.prod(SQUARES[bit] for bit in range(VECTORS) if a & b & 1 << bit)
    return (-1.0) ** swaps * squares


SIGNS: Array = np.array([[_sign(a, b) for b in range(BLADES)] for a in range(BLADES)])

REVERSE: Array = (-1.0) ** (GRADES * (GRADES - 1) // 2)
INVOLUTION: Array = (-1.0) ** GRADES
CONJUGATE: Array = REVERSE * INVOLUTION


@cache
def grade_mask(grades: tuple[int, ...]) -> np.ndarray:
    """Which components have one of these grades, shape `(32,)`."""
    mask: np.ndarray = np.isin(GRADES, grades)
    return mask


def blade_index_and_sign(name: str) -> tuple[int, float]:
    """The index of the blade of this name, and the sign that sorting its factors takes: "e31" is -e13, "1" the scalar.

    BladeNameError where the name is not e and different digits from 1 to 5.
    """
    digits = name.removeprefix("e")
    if name == "1":
        return SCALAR, 1.0
    if not name.startswith("e") or not digits or set(digits) - set("12345") or len(set(digits)) < len(digits):
        raise BladeNameError(f"{name!r} is no basis blade; expected e and different digits from 1 to 5")
    index, sign = SCALAR, 1.0
    for digit in digits:
        factor = 1 << int(digit) - 1
        sign *= SIGNS[index, factor]
        index |= factor
    return index, sign
