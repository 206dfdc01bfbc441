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
from gaik_core.kernels.lane_kinematics import LANES
from gaik_core.kernels.lanes import LEFT_OVER, solve_lanes
from gaik_core.kernels.task import POSITION
from gaik_core.solution import STATUS, Solutions
from gaik_core.update_rules import LevenbergMarquardt, UpdateRule

Array = NDArray[np.float64]

SHARE = 4 * LANES
"""Fewer targets than this are not worth a thread."""

_STATUS = np.array(STATUS, dtype=object)


@dataclass(frozen=True)
class BatchProblem:
    """What the solves of a batch have in common, the targets (m, ·) and the angles to start from (m, dof)."""

    algebra: int
    chain: Chain
    kind: int
    targets: Array
    first: Array
    stop: Stop
    rule: UpdateRule
    starts: Array

    @property
    def fits_lanes(self) -> bool:
        """Whether it is positions that are wanted, the lanes know the rule, and the limits are of joints alone."""
        return (
            self.kind == POSITION
            and type(self.rule) is LevenbergMarquardt
            and len(self.chain[4]) == 0
            and len(self.targets) >= LANES
        )


@dataclass(frozen=True)
class BatchResult:
    """What the solves of a batch write: angles (m, dof), and counts and errors as in `gaik_core.kernels.many`."""

    angles: Array
    counts: NDArray[np.int64]
    errors: Array

    @classmethod
    def of(cls, solves: int, dof: int) -> BatchResult:
        """Room for so many solves."""
        return cls(np.empty((solves, dof)), np.zeros((solves, 3), dtype=np.int64), np.zeros((solves, 2)))

    def part(self, part: slice) -> BatchResult:
        """A part of it, to be written by one thread."""
        return BatchResult(self.angles[part], self.counts[part], self.errors[part])

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


def _processors() -> int:
    """How many this process may use; not every system can say that, and then how many there are."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def solve_in_parallel(problem: BatchProblem, result: BatchResult, workers: int | None) -> None:
    """Solve a batch in as many threads as there are processors, or `workers`; kernels hold no interpreter lock."""
    size = len(problem.targets)
    threads = max(1, min(workers or _processors(), size // SHARE))
    if threads == 1:
        solve_slice(problem, result, slice(None))
        return
    edges = np.linspace(0, size, threads + 1).astype(int)
    slices = [slice(begin, end) for begin, end in pairwise(edges)]
    with ThreadPoolExecutor(threads - 1) as pool:
        others = [pool.submit(solve_slice, problem, result, part) for part in slices[1:]]
        solve_slice(problem, result, slices[0])
        for other in others:
            other.result()


def solve_slice(problem: BatchProblem, result: BatchResult, part: slice) -> None:
    """Solve a part of a batch: in lanes where the problem fits them, and what they leave over one by one."""
    targets, result = problem.targets[part], result.part(part)
    result.angles[:] = problem.first[part]
    common = (problem.rule.settings, result.angles)
    if problem.fits_lanes:
        iterations, distances = result.counts[:, many.ITERATIONS], result.errors[:, many.DISTANCE]
        tolerance, _, _, window, budget = problem.stop
        patience = min(window, budget)
        solve_lanes(
            problem.algebra, problem.chain, targets, tolerance, patience, *common, distances, iterations
        )
        left = np.flatnonzero(iterations == LEFT_OVER)
    else:
        left = np.arange(len(targets))
    many.solve_each(
        problem.algebra, problem.chain, problem.kind, targets, problem.stop, problem.rule.kernel, *common,
        problem.starts, left, result.counts, result.errors,
    )  # fmt: skip
