"""How a batch is shared out: over the processors, and on each over the lanes of its vector registers."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gaik_core.kernels import many
from gaik_core.kernels.descent import CONVERGED, Stop
from gaik_core.kernels.kinematics import Chain
from gaik_core.kernels.lanes import LANES, LEFT_OVER, solve_lanes
from gaik_core.kernels.task import POSITION
from gaik_core.solution import STATUS, Solutions
from gaik_core.update_rules import LevenbergMarquardt, UpdateRule

Array = NDArray[np.float64]

SHARE = 4 * LANES
"""Fewer targets than this are not worth a thread."""

_STATUS = np.array([status.value for status in STATUS])


@dataclass(frozen=True)
class BatchProblem:
    """What the solves of a batch have in common, and the targets (m, 3)."""

    algebra: int
    chain: Chain
    targets: Array
    stop: Stop
    rule: UpdateRule
    starts: Array

    @property
    def fits_lanes(self) -> bool:
        """Whether the lanes know the rule, and the limits are of joints alone."""
        return (
            type(self.rule) is LevenbergMarquardt and len(self.chain[4]) == 0 and len(self.targets) >= LANES
        )


@dataclass(frozen=True)
class BatchResult:
    """What the solves of a batch write: angles (m, dof), and counts and errors as in `gaik_core.kernels.many`."""

    angles: Array
    counts: NDArray[np.int64]
    errors: Array

    @classmethod
    def of(cls, angles: Array) -> BatchResult:
        """Room for as many solves as there are rows of angles."""
        return cls(angles, np.zeros((len(angles), 3), dtype=np.int64), np.zeros((len(angles), 2)))

    def solutions(self) -> Solutions:
        """As the public functions return it."""
        status = self.counts[:, many.STATUS]
        fields: dict[str, Any] = {
            "angles": self.angles,
            "error": self.errors[:, many.DISTANCE],
            "iterations": self.counts[:, many.ITERATIONS],
            "converged": status == CONVERGED,
            "status": _STATUS[status],
            "orientation_error": self.errors[:, many.TURN],
            "restarts": self.counts[:, many.RESTARTS],
        }
        return Solutions(**fields)


def solve_in_parallel(problem: BatchProblem, result: BatchResult, workers: int | None) -> None:
    """Solve a batch in as many threads as there are processors, or `workers`; kernels hold no interpreter lock."""
    size = len(problem.targets)
    threads = max(1, min(workers or len(os.sched_getaffinity(0)), size // SHARE))
    if threads == 1:
        solve_slice(problem, result, slice(0, size))
        return
    edges = np.linspace(0, size, threads + 1).astype(int)
    slices = [slice(begin, end) for begin, end in pairwise(edges)]
    with ThreadPoolExecutor(threads) as pool:
        for done in [pool.submit(solve_slice, problem, result, part) for part in slices]:
            done.result()


def solve_slice(problem: BatchProblem, result: BatchResult, part: slice) -> None:
    """Solve a part of a batch: in lanes where the problem fits them, and what they leave over one by one."""
    targets, angles = problem.targets[part], result.angles[part]
    counts, errors = result.counts[part], result.errors[part]
    common = (problem.rule.settings, angles)
    left = np.arange(len(targets))
    if problem.fits_lanes:
        distances, iterations = np.zeros(len(targets)), np.zeros(len(targets), dtype=np.int64)
        tolerance, budget = problem.stop[0], problem.stop[-1]
        solve_lanes(
            problem.algebra, problem.chain, targets, tolerance, budget, *common, distances, iterations
        )
        counts[:, many.ITERATIONS], errors[:, many.DISTANCE] = iterations, distances
        left = np.flatnonzero(iterations == LEFT_OVER)
    many.solve_each(
        problem.algebra, problem.chain, POSITION, targets, problem.stop, problem.rule.kernel, *common,
        problem.starts, left, counts, errors,
    )  # fmt: skip
