"""clifford: multivectors of any algebra as arrays, products compiled by numba."""

from __future__ import annotations

from typing import Any

import clifford
import numpy as np

from algebra_problem import AlgebraProblem
from peers.algebra_protocol import Array, Package, point_components


class Clifford(Package):
    """`m * p * ~m`, and `*`."""

    name = "clifford"
    package = "clifford"

    def __init__(self) -> None:
        self.layout, _ = clifford.Cl(4, 1)
        self.bits = [sum(1 << (i - 1) for i in blade) for blade in self.layout.bladeTupList]

    def motions(self, problem: AlgebraProblem) -> list[tuple[Any, Any]]:
        points = [point_components(p) for p in problem.points]
        return [(self._make(m), self._make(p)) for m, p in zip(problem.motors, points, strict=True)]

    def move(self, motor: Any, point: Any) -> Any:
        return motor * point * ~motor

    def position(self, moved: Any) -> Array:
        return self.components(moved)[[1, 2, 4]]

    def factors(self, problem: AlgebraProblem) -> list[tuple[Any, Any]]:
        return [(self._make(a), self._make(b)) for a, b in zip(problem.left, problem.right, strict=True)]

    def multiply(self, a: Any, b: Any) -> Any:
        return a * b

    def components(self, product: Any) -> Array:
        components = np.zeros(32)
        components[self.bits] = product.value
        return components

    def _make(self, components: Array) -> Any:
        return self.layout.MultiVector(components[self.bits])
