"""The same solve by quaternions and by screw rotors, with every iterate of both."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gaik_core.chain import KinematicChain
from gaik_core.experiments.findings import Comparison, Iterates
from gaik_core.solver import Solution, Trace, solve
from gaik_core.update_rules import UpdateRule

Array = NDArray[np.float64]

EXACT = 1e-12
"""A tolerance (m) that a descent of a set number of updates does not reach."""


class Both(NamedTuple):
    """Two solutions of one problem, each with its trace."""

    quaternion: Solution
    conformal: Solution

    @property
    def iterates(self) -> Iterates:
        """The angles at every step of both."""
        return Iterates(trace(self.quaternion).angles, trace(self.conformal).angles)


def solve_both(
    chain: KinematicChain,
    target: ArrayLike,
    start: ArrayLike,
    rule: UpdateRule,
    tolerance: float = EXACT,
    max_iterations: int = 1000,
) -> Both:
    """Solve one target by each algebra."""
    return Both(
        solve(chain, target, start, "quaternion", rule, tolerance, max_iterations, trace=True),
        solve(chain, target, start, "conformal", rule, tolerance, max_iterations, trace=True),
    )


def solve_path_both(
    chain: KinematicChain,
    targets: Iterable[ArrayLike],
    start: ArrayLike,
    rule: UpdateRule,
    tolerance: float,
    max_iterations: int,
) -> list[Both]:
    """Solve targets in order by each algebra, each from where it reached the one before."""
    paths: dict[str, list[Solution]] = {"quaternion": [], "conformal": []}
    for algebra, path in paths.items():
        angles = start
        for target in targets:
            path.append(solve(chain, target, angles, algebra, rule, tolerance, max_iterations, trace=True))
            angles = path[-1].angles
    return [Both(*pair) for pair in zip(paths["quaternion"], paths["conformal"], strict=True)]


def joined(solves: Iterable[Both]) -> Iterates:
    """The iterates of several solves, one after the other."""
    pairs = [solved.iterates for solved in solves]
    return Iterates(
        np.concatenate([pair.quaternion for pair in pairs]),
        np.concatenate([pair.conformal for pair in pairs]),
    )


def compare(
    quantity: str,
    unit: str,
    printed: ArrayLike | None,
    solved: Both,
    measure: Callable[[Solution], ArrayLike],
    decimals: int = 4,
    remark: str = "",
) -> Comparison:
    """A row whose two values are the same measure of either solution."""
    return Comparison(
        quantity, unit, printed, measure(solved.quaternion), measure(solved.conformal), decimals, remark
    )


def degrees(solution: Solution) -> Array:
    """The angles a solve ended at, in degrees."""
    return np.degrees(solution.angles)


def error(solution: Solution) -> float:
    """The distance a solve left (m)."""
    return solution.error


def updates(solution: Solution) -> int:
    """The updates a solve made."""
    return solution.iterations


def trace(solution: Solution) -> Trace:
    """The trace of a solution that was asked to keep one."""
    if solution.trace is None:
        raise ValueError("the solution has no trace; it was not asked for")
    return solution.trace
