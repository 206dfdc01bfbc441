"""What a package for geometric algebra is to the benchmark."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from algebra_problem import AlgebraProblem

Array = NDArray[np.float64]


class Package(ABC):
    """One package. Operands are converted to its own types before the clock runs.

    Attributes:
        name: as the tables have it.
        package: the distribution whose version the tables give.
    """

    name: ClassVar[str]
    package: ClassVar[str]

    @abstractmethod
    def motions(self, problem: AlgebraProblem) -> list[tuple[Any, Any]]:
        """Motors and points as `move` takes them."""

    @abstractmethod
    def move(self, motor: Any, point: Any) -> Any:
        """M p M̃. This is what is timed."""

    @abstractmethod
    def position(self, moved: Any) -> Array:
        """(3,) the position of a point."""

    @abstractmethod
    def factors(self, problem: AlgebraProblem) -> list[tuple[Any, Any]]:
        """Multivectors as `multiply` takes them."""

    @abstractmethod
    def multiply(self, a: Any, b: Any) -> Any:
        """The full product a b. This is what is timed."""

    @abstractmethod
    def components(self, product: Any) -> Array:
        """(32,) by the bits of the blades on e1 … e5."""


def point_components(position: Array) -> Array:
    """(32,) of the conformal point x + ½ x² e∞ + e0, with e0 = (e5 - e4)/2 and e∞ = e4 + e5."""
    components = np.zeros(32)
    half = 0.5 * float(position @ position)
    components[[1, 2, 4]] = position
    components[8], components[16] = half - 0.5, half + 0.5
    return components
