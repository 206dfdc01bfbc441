"""T5: a motor that moves a point, and the full product of two multivectors of G(4,1), one at a time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

EINF = (3, 4)
"""Bits of e4 and e5, whose sum is e∞."""
METRIC = (1.0, 1.0, 1.0, 1.0, -1.0)


@dataclass(frozen=True, eq=False)
class AlgebraProblem:
    """Operands; components (…, 32) belong to the blade whose bits their index has, bit i for e(i+1).

    Attributes:
        motors: (m, 32) unit motors (1 - ½ t e∞) R.
        points: (m, 3) positions.
        moved: (m, 3) where the motors take them, by rotation matrices.
        left, right: (m, 32) factors.
        products: (m, 32) their products, by the definition of the product of blades.
    """

    motors: Array
    points: Array
    moved: Array
    left: Array
    right: Array
    products: Array


def algebra_problem(count: int = 200) -> AlgebraProblem:
    """Random operands with their results."""
    rng = np.random.default_rng(0)
    quaternions = rng.normal(size=(count, 4))
    quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
    shifts, points = rng.normal(size=(count, 3)), rng.normal(size=(count, 3))
    left, right = rng.normal(size=(count, 32)), rng.normal(size=(count, 32))
    w, u = quaternions[:, :1], quaternions[:, 1:]
    turned = points + 2 * np.cross(u, np.cross(u, points) + w * points)
    return AlgebraProblem(
        motors=np.array([_motor(q, t) for q, t in zip(quaternions, shifts, strict=True)]),
        points=points,
        moved=turned + shifts,
        left=left,
        right=right,
        products=np.array([product(a, b) for a, b in zip(left, right, strict=True)]),
    )


def product(a: Array, b: Array) -> Array:
    """The geometric product of two multivectors (32,), blade by blade."""
    result = np.zeros(32)
    for i in range(32):
        for j in range(32):
            result[i ^ j] += _sign(i, j) * a[i] * b[j]
    return result


def _sign(i: int, j: int) -> float:
    """The sign of the product of two basis blades: of the swaps that sort it, times the squares of what they share."""
    swaps = sum((i >> shift & j).bit_count() for shift in range(1, 5))
    return float((-1) ** swaps * np.prod([METRIC[bit] for bit in range(5) if (i & j) >> bit & 1]))


def _motor(quaternion: Array, shift: Array) -> Array:
    """(1 - ½ t e∞) R with R = w - (x e23 - y e13 + z e12)."""
    rotor, translator = np.zeros(32), np.zeros(32)
    w, x, y, z = quaternion
    rotor[0b00000], rotor[0b00110], rotor[0b00101], rotor[0b00011] = w, -x, y, -z
    translator[0] = 1.0
    for axis in range(3):
        for bit in EINF:
            translator[1 << axis | 1 << bit] = -0.5 * shift[axis]
    return product(translator, rotor)
