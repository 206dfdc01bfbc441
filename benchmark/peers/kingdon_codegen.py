"""kingdon: products generated for the components that an operand has."""

from __future__ import annotations

from typing import Any

import numpy as np
from kingdon import Algebra

from algebra_problem import AlgebraProblem
from peers.algebra_protocol import Array, Package, point_components


class Kingdon(Package):
    """`m.sw(p)`, the sandwich product generated for motors and points, and `*`."""

    name = "kingdon"
    package = "kingdon"

    def __init__(self) -> None:
        self.algebra = Algebra(4, 1)

    def motions(self, problem: AlgebraProblem) -> list[tuple[Any, Any]]:
        motor_keys = tuple(np.flatnonzero(np.abs(problem.motors).max(axis=0) > 1e-15).tolist())
        return [
            (self._make(m, motor_keys), self._make(point_components(p), (1, 2, 4, 8, 16)))
            for m, p in zip(problem.motors, problem.points, strict=True)
        ]

    def move(self, motor: Any, point: Any) -> Any:
        return motor.sw(point)

    def position(self, moved: Any) -> Array:
        return self.components(moved)[[1, 2, 4]]

    def factors(self, problem: AlgebraProblem) -> list[tuple[Any, Any]]:
        every = tuple(range(32))
        return [
            (self._make(a, every), self._make(b, every))
            for a, b in zip(problem.left, problem.right, strict=True)
        ]

    def multiply(self, a: Any, b: Any) -> Any:
        return a * b

    def components(self, product: Any) -> Array:
        components = np.zeros(32)
        components[list(product.keys())] = product.values()
        return components

    def _make(self, components: Array, keys: tuple[int, ...]) -> Any:
        return self.algebra.multivector(keys=keys, values=components[list(keys)].tolist())
