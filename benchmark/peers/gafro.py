"""gafro: conformal geometric algebra for robots in C++, by its Python binding."""

from __future__ import annotations

from typing import Any

import numpy as np
import pygafro

from algebra_problem import AlgebraProblem, product
from peers.algebra_protocol import Array, Package

MOTOR_BITS = (0b00000, 0b00011, 0b00101, 0b00110, 0b01001, 0b01010, 0b01100, 0b01111)
"""Of gafro's eight components: 1, e12, e13, e23, e1∞, e2∞, e3∞, e123∞, the last four by their part in e4."""


class Gafro(Package):
    """`Motor.apply` to a Point, and `*` of two multivectors with all 32 components."""

    name = "pygafro"
    package = "pygafro"

    def __init__(self) -> None:
        self.full = type(pygafro.Multivector.create(list(range(32)), np.zeros(32)))
        self.to_orthonormal = _null_blades()
        self.to_null = np.linalg.inv(self.to_orthonormal)

    def motions(self, problem: AlgebraProblem) -> list[tuple[Any, Any]]:
        return [
            (pygafro.Motor(m[list(MOTOR_BITS)]), pygafro.Point(*p.tolist()))
            for m, p in zip(problem.motors, problem.points, strict=True)
        ]

    def move(self, motor: Any, point: Any) -> Any:
        return motor.apply(point)

    def position(self, moved: Any) -> Array:
        return np.asarray(moved.getEuclideanPoint())

    def factors(self, problem: AlgebraProblem) -> list[tuple[Any, Any]]:
        return [(self._make(a), self._make(b)) for a, b in zip(problem.left, problem.right, strict=True)]

    def multiply(self, a: Any, b: Any) -> Any:
        return a * b

    def components(self, product: Any) -> Array:
        return self.to_orthonormal @ np.asarray(product.vector()).ravel()

    def _make(self, components: Array) -> Any:
        return self.full(self.to_null @ components)


def _null_blades() -> Array:
    """(32, 32): column k has gafro's blade k, an outer product of e0, e1, e2, e3, e∞ by its bits, on e1 … e5."""
    vectors = np.zeros((5, 32))
    vectors[0, [8, 16]] = -0.5, 0.5
    vectors[1, 1] = vectors[2, 2] = vectors[3, 4] = 1.0
    vectors[4, [8, 16]] = 1.0, 1.0
    grades = np.array([k.bit_count() for k in range(32)])
    columns = []
    for k in range(32):
        blade = np.eye(32)[0]
        for bit in range(5):
            if k >> bit & 1:
                grade = grades[np.flatnonzero(blade)[0]]
                blade = np.where(grades == grade + 1, product(blade, vectors[bit]), 0.0)
        columns.append(blade)
    return np.array(columns).T
