"""Measuring solvers side by side: interleaved rounds in one process, success by gaik's own forward kinematics."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from peers.protocol import NotSolvableError, Solver
from problems import Problem

Array = NDArray[np.float64]

FEWEST = 10
"""A slow solver is timed on at least this many targets."""
INSIDE = 1e-9
"""A joint this far outside its limits still counts as inside (rad)."""
HOT = 0.1
"""A turn that is shorter than this many seconds is a rehearsal, and is timed over as many more as fill them."""


@dataclass(frozen=True)
class Result:
    """What one solver made of a problem.

    Attributes:
        name, package: of the solver.
        seconds: (rounds,) per solve.
        solved: share of the targets reached within the tolerances.
        inside: share of the answers inside the joint limits.
        targets: how many targets it was given: fewer than the problem has where it is slow.
    """

    name: str
    package: str
    seconds: Array
    solved: float
    inside: float
    targets: int

    @property
    def median(self) -> float:
        """Seconds per solve."""
        return float(np.median(self.seconds))

    def ratio(self, other: Result) -> float:
        """How many times longer this one took than another, round by round; the median."""
        return float(np.median(self.seconds / other.seconds))


def measure(
    problem: Problem, classes: Sequence[type[Solver]], rounds: int, budget: float
) -> tuple[list[Result], dict[str, str]]:
    """Run every solver over the targets `rounds` times, in turn, each for about `budget` seconds a round at most.

    Returns the results, the fastest first, and why a solver could not take part.
    """
    runs, refused = [], {}
    for kind in tqdm(classes, desc=f"{problem.key} set up", disable=None, leave=False):
        try:
            runs.append(_prepare(kind, problem, budget))
        except NotSolvableError as reason:
            if kind.package != "gaik_core":  # a variant of ours that means nothing here
                refused[kind.name] = str(reason)
        except Exception as error:
            if kind.package == "gaik_core":
                raise
            refused[kind.name] = f"failed with {error!r}"
    seconds = interleave([run.timed for run in runs], rounds, problem.key)
    results = [run.result(times / run.count) for run, times in zip(runs, seconds, strict=True)]
    return sorted(results, key=lambda result: result.median), refused


def interleave(tasks: Sequence[Callable[[], Any]], rounds: int, label: str) -> Array:
    """Seconds (tasks, rounds) of each task, all in turn, each round beginning with another."""
    seconds = np.empty((len(tasks), rounds))
    with tqdm(total=rounds * len(tasks), desc=label, disable=None, leave=False) as progress, _no_collection():
        for turn in range(rounds):
            for step in range(len(tasks)):
                i = (turn + step) % len(tasks)
                seconds[i, turn] = _hot(tasks[i])
                progress.update()
    return seconds


def _hot(task: Callable[[], Any]) -> float:
    """Seconds of a task in a loop of its own: the one before has left caches full of its own things."""
    first = _timed(task, 1)
    return first if first > HOT else _timed(task, max(1, round(HOT / first)))


def _timed(task: Callable[[], Any], times: int) -> float:
    begin = perf_counter()
    for _ in range(times):
        task()
    return (perf_counter() - begin) / times


@dataclass(frozen=True)
class _Run:
    """A solver that has been tried on as many targets as it has time for."""

    solver: Solver
    targets: list[Any]
    start: Any
    solved: float
    inside: float

    @property
    def count(self) -> int:
        return len(self.targets)

    def timed(self) -> list[Any]:
        return answers(self.solver, self.targets, self.start)

    def result(self, seconds: Array) -> Result:
        kind = self.solver
        return Result(kind.name, kind.package, seconds, self.solved, self.inside, self.count)


def _prepare(kind: type[Solver], problem: Problem, budget: float) -> _Run:
    solver = kind(problem)
    targets, start = solver.targets(), solver.start()
    answers(solver, targets[:2], start)  # compiles, fills caches
    begin = perf_counter()
    answers(solver, targets[:FEWEST], start)
    each = (perf_counter() - begin) / min(FEWEST, len(targets))
    targets = targets[: max(FEWEST, int(budget / each))]
    angles = solver.angles(answers(solver, targets, start))
    solved, inside = judge(problem.first(len(targets)), angles)
    return _Run(solver, targets, start, float(solved.mean()), float(inside.mean()))


def answers(solver: Solver, targets: Sequence[Any], start: Any) -> list[Any]:
    """All answers: from one start or, on a warm problem, each from the answer before."""
    if not solver.problem.warm:
        return [solver.solve(target, start) for target in targets]
    found = []
    for target in targets:
        start = solver.solve(target, start)
        found.append(start)
    return found


def judge(problem: Problem, angles: Array) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which answers (m, dof) reach their target, and which are inside the joint limits."""
    positions, turns = problem.chain.pose(angles)
    solved = np.linalg.norm(positions - problem.targets, axis=1) < problem.tolerance
    if problem.orientations is not None:
        cosine = np.abs((turns * problem.orientations).sum(axis=1)).clip(max=1.0)
        solved &= 2 * np.arccos(cosine) < problem.orientation_tolerance
    low, high = problem.chain.lower - INSIDE, problem.chain.upper + INSIDE
    return solved, ((angles >= low) & (angles <= high)).all(axis=1)


@contextmanager
def _no_collection() -> Iterator[None]:
    """No garbage collection while the clock runs."""
    gc.collect()
    gc.disable()
    try:
        yield
    finally:
        gc.enable()
