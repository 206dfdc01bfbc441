"""Many targets in one call: each for itself, or one after the other along a path."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gaik_core.kernels.compiled import compiled, inlined
from gaik_core.kernels.descent import (
    CONVERGED,
    IMPROVEMENT,
    STAGNATED,
    Stop,
    copy,
    room,
    solve_once,
    solve_with_restarts,
)
from gaik_core.kernels.kinematics import Chain

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

STATUS, ITERATIONS, RESTARTS = range(3)
"""Columns of `counts`."""

DISTANCE, TURN = range(2)
"""Columns of `errors`."""

HALVINGS = 7
"""A path's step that jumps is solved again in 2, 4, … 2**HALVINGS pieces."""


@compiled
def solve_each(
    algebra: int,
    chain: Chain,
    kind: int,
    targets: Array,
    stop: Stop,
    rule: int,
    settings: Array,
    angles: Array,
    starts: Array,
    left: Integers,
    counts: Integers,
    errors: Array,
) -> None:
    """Solve those of `targets` (m, ·) whose numbers are in `left`, each from its row of `angles` (m, d), in place.

    `counts` (m, 3) and `errors` (m, 2) tell how each ended.
    """
    work = np.empty(room(chain[0].shape[0], angles.shape[1]))
    for k in range(left.shape[0]):
        i = left[k]
        status, iterations, distance, turn, restarts = solve_with_restarts(
            algebra, chain, kind, targets[i], stop, rule, settings, angles[i], starts, work
        )
        counts[i, STATUS], counts[i, ITERATIONS], counts[i, RESTARTS] = status, iterations, restarts
        errors[i, DISTANCE], errors[i, TURN] = distance, turn


@inlined
def largest_step(a: Array, b: Array) -> float:
    """The largest change of any joint."""
    largest = 0.0
    for j in range(a.shape[0]):
        largest = max(largest, abs(a[j] - b[j]))
    return largest


@compiled
def solve_along(
    algebra: int,
    chain: Chain,
    kind: int,
    targets: Array,
    stop: Stop,
    rule: int,
    settings: Array,
    start: Array,
    bound: float,
    angles: Array,
    counts: Integers,
    errors: Array,
) -> None:
    """Solve `targets` (m, 3) in order, each from the angles of the one before; write them into `angles` (m, d).

    A step of more than `bound` in any joint is a jump to another branch. It is walked again in smaller and smaller
    pieces of the straight way; where even the smallest jump, it is kept out of the result as STAGNATED.
    """
    no_trace, current, piece = np.empty((0, 2)), start.copy(), targets[:1].copy()[0]
    work = np.empty(room(chain[0].shape[0], start.shape[0]))
    for i in range(targets.shape[0]):
        copy(current, angles[i])
        status, iterations, distance, turn = solve_once(
            algebra, chain, kind, targets[i], stop, rule, settings, angles[i], IMPROVEMENT, no_trace, no_trace,
            work,
        )  # fmt: skip
        halvings = 0
        while i > 0 and largest_step(angles[i], current) > bound and halvings < HALVINGS:
            halvings += 1
            pieces = 2**halvings
            copy(current, angles[i])
            before, jumped = current.copy(), False
            for k in range(1, pieces + 1):
                for axis in range(3):
                    piece[axis] = targets[i - 1, axis] + k / pieces * (
                        targets[i, axis] - targets[i - 1, axis]
                    )
                status, more, distance, turn = solve_once(
                    algebra, chain, kind, piece, stop, rule, settings, angles[i], IMPROVEMENT, no_trace, no_trace,
                    work,
                )  # fmt: skip
                iterations += more
                jumped = jumped or largest_step(angles[i], before) > bound
                copy(angles[i], before)
            if not jumped:
                break
            if halvings == HALVINGS:
                status = STAGNATED if status == CONVERGED else status
        counts[i, STATUS], counts[i, ITERATIONS], counts[i, RESTARTS] = status, iterations, 0
        errors[i, DISTANCE], errors[i, TURN] = distance, turn
        copy(angles[i], current)
