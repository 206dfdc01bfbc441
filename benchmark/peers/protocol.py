"""What a solver is to the benchmark."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from problems import Problem

Array = NDArray[np.float64]

MAX_ITERATIONS = 500


class NotSolvableError(Exception):
    """A solver that cannot do a task; the message says why."""


class Solver(ABC):
    """One solver, set up for one problem.

    It takes its targets and starts as NumPy arrays, and poses as its documentation has them, and answers with an array.

    Attributes:
        name: as the tables have it.
        package: the distribution whose version the tables give.
        at_once: whether all targets are one to it; such a solver takes part in T4 alone.
    """

    name: ClassVar[str]
    package: ClassVar[str]
    at_once: ClassVar[bool] = False

    def __init__(self, problem: Problem) -> None:
        """Set up for a problem; raises NotSolvableError."""
        self.problem = problem

    @abstractmethod
    def targets(self) -> list[Any]:
        """The problem's targets as `solve` takes them."""

    @abstractmethod
    def start(self) -> Any:
        """The problem's start as `solve` takes it."""

    @abstractmethod
    def solve(self, target: Any, start: Any) -> Any:
        """One solve: an answer, which is also a start. This is what is timed."""

    @abstractmethod
    def angles(self, answers: list[Any]) -> Array:
        """(m, dof) joint values of the problem's chain."""


def homogeneous(problem: Problem) -> Array:
    """The targets as matrices (m, 4, 4); with the identity for an orientation that is free."""
    matrices = np.tile(np.eye(4), (len(problem.targets), 1, 1))
    matrices[:, :3, 3] = problem.targets
    if problem.orientations is not None:
        w, x, y, z = problem.orientations.T
        matrices[:, :3, :3] = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        ).transpose(2, 0, 1)
    return matrices
