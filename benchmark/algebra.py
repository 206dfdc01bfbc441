"""Measuring the packages for geometric algebra (T5)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from algebra_problem import AlgebraProblem
from measure import Result, interleave
from peers.algebra_protocol import Package


def measure_algebra(
    problem: AlgebraProblem, classes: Sequence[type[Package]], rounds: int
) -> tuple[list[Result], list[Result]]:
    """Seconds per motion of a point, and per full product; `solved` is the share of right results (to 1e-9)."""
    packages = [kind() for kind in classes]
    motions = [package.motions(problem) for package in packages]
    factors = [package.factors(problem) for package in packages]
    moved = [
        np.array([package.position(package.move(*pair)) for pair in pairs])
        for package, pairs in zip(packages, motions, strict=True)
    ]
    multiplied = [
        np.array([package.components(package.multiply(*pair)) for pair in pairs])
        for package, pairs in zip(packages, factors, strict=True)
    ]
    tasks = [
        lambda p=p, pairs=pairs: [p.move(*pair) for pair in pairs]
        for p, pairs in zip(packages, motions, strict=True)
    ]
    tasks += [
        lambda p=p, pairs=pairs: [p.multiply(*pair) for pair in pairs]
        for p, pairs in zip(packages, factors, strict=True)
    ]
    seconds = interleave(tasks, rounds, "T5") / len(problem.points)
    first, second = np.split(seconds, 2)
    return _results(packages, first, moved, problem.moved), _results(
        packages, second, multiplied, problem.products
    )


def _results(
    packages: Sequence[Package], seconds: np.ndarray, found: Sequence[np.ndarray], wanted: np.ndarray
) -> list[Result]:
    results = [
        Result(
            p.name,
            p.package,
            times,
            float(np.isclose(f, wanted, atol=1e-9).all(axis=1).mean()),
            1.0,
            len(wanted),
        )
        for p, times, f in zip(packages, seconds, found, strict=True)
    ]
    return sorted(results, key=lambda result: result.median)
