"""T4: many positions at once."""

from __future__ import annotations

import inspect
import os
from collections.abc import Sequence
from time import perf_counter
from typing import Any

import numpy as np

from gaik_core import LevenbergMarquardt, solve_batch
from measure import Result, answers, interleave, judge
from peers.protocol import Solver
from problems import Problem

PEER_TARGETS = 1000
"""Peers get the first targets only, one after another or all at once."""
BUDGET = 2.0
"""Seconds that a call of `solve_batch` may take."""


def measure_batch(problem: Problem, peers: Sequence[type[Solver]], rounds: int) -> list[Result]:
    """Seconds per target of `solve_batch`, on one core and on all where it can be told, and of each peer."""
    tasks, names, counts, shares = [], [], [], []
    for name, options in _ways():
        wanted = _affordable(problem, options)
        solution = _solve(wanted, options)
        tasks.append(lambda wanted=wanted, options=options: _solve(wanted, options))
        names.append((name, "gaik_core"))
        counts.append(len(wanted.targets))
        shares.append(judge(wanted, solution.angles))
    for kind in peers:
        solver = kind(problem.first(PEER_TARGETS))
        targets, start = solver.targets(), solver.start()
        found = answers(solver, targets, start)
        tasks.append(lambda solver=solver, targets=targets, start=start: answers(solver, targets, start))
        names.append((kind.name if kind.at_once else f"{kind.name}, one by one", kind.package))
        counts.append(len(solver.problem.targets))
        shares.append(judge(solver.problem, solver.angles(found)))
    seconds = interleave(tasks, rounds, problem.key) / np.array(counts)[:, None]
    results = [
        Result(*name, times, float(solved.mean()), float(inside.mean()), count)
        for name, times, (solved, inside), count in zip(names, seconds, shares, counts, strict=True)
    ]
    return sorted(results, key=lambda result: result.median)


def _ways() -> list[tuple[str, dict[str, Any]]]:
    cores = os.cpu_count() or 1
    if "workers" not in inspect.signature(solve_batch).parameters:
        return [("gaik solve_batch", {})]
    return [
        ("gaik solve_batch, 1 core", {"workers": 1}),
        ("gaik solve_batch, 1 core, conformal", {"workers": 1, "algebra": "conformal"}),
        (f"gaik solve_batch, {cores} cores", {"workers": cores}),
    ]


def _solve(problem: Problem, options: dict[str, Any]) -> Any:
    return solve_batch(
        problem.chain,
        problem.targets,
        problem.start,
        rule=LevenbergMarquardt(),
        tolerance=problem.tolerance,
        restarts=problem.restarts,
        **options,
    )


def _affordable(problem: Problem, options: dict[str, Any]) -> Problem:
    """The problem, or its first targets where all of them would take longer than a few seconds."""
    few = problem.first(1000)
    _solve(few.first(32), options)  # compiles
    begin = perf_counter()
    _solve(few, options)
    each = (perf_counter() - begin) / len(few.targets)
    return problem.first(max(1000, int(BUDGET / each)))
