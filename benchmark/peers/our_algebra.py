"""gaik's own Motor and Multivector."""

from __future__ import annotations

from typing import Any

from algebra_problem import AlgebraProblem
from gaik_core.cga import Multivector, down, up
from gaik_core.versors import Motor
from peers.algebra_protocol import Array, Package


class OurAlgebra(Package):
    """`Motor.apply` to a point, and `*`."""

    name = "gaik"
    package = "gaik_core"

    def motions(self, problem: AlgebraProblem) -> list[tuple[Any, Any]]:
        return [(Motor(m), up(p)) for m, p in zip(problem.motors, problem.points, strict=True)]

    def move(self, motor: Any, point: Any) -> Any:
        return motor.apply(point)

    def position(self, moved: Any) -> Array:
        return down(moved)

    def factors(self, problem: AlgebraProblem) -> list[tuple[Any, Any]]:
        return [(Multivector(a), Multivector(b)) for a, b in zip(problem.left, problem.right, strict=True)]

    def multiply(self, a: Any, b: Any) -> Any:
        return a * b

    def components(self, product: Any) -> Array:
        return product.components
