"""Many targets in one call: each for itself, or one after the other along a path."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gaik_core.kernels.compiled import compiled, inlined, uncounted
from gaik_core.kernels.descent import (
    IMPROVEMENT,
    LARGEST,
    STAGNATED,
    UNREACHABLE,
    Outcome,
    Stop,
    copy,
    room,
    solve_once,
    solve_with_restarts,
)
from gaik_core.kernels.kinematics import Chain
from gaik_core.kernels.task import between

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


@uncounted
def walk(
    algebra: int,
    chain: Chain,
    kind: int,
    begin: Array,
    end: Array,
    pieces: int,
    stop: Stop,
    rule: int,
    settings: Array,
    bound: float,
    angles: Array,
    work: Array,
) -> tuple[bool, int, int, float, float]:
    """Solve `pieces` points of the straight way in order, the last one the end; `angles` in place.

    Returns whether any step was a jump, and the outcome of the last point with the updates of all. `work` is what
    `room_to_walk` asks for.
    """
    size, joints = end.shape[0], angles.shape[0]
    point, before, free = work[:size], work[size : size + joints], work[size + joints :]
    no_trace, jumped, total = work[:0].reshape((0, 2)), False, 0
    status, distance, turn = STAGNATED, np.inf, np.inf
    for k in range(1, pieces + 1):
        between(kind, begin, end, k / pieces, point)
        copy(angles, before)
        status, iterations, distance, turn = solve_once(
            algebra, chain, kind, end if k == pieces else point, stop, rule, settings, angles, IMPROVEMENT,
            no_trace, no_trace, free,
        )  # fmt: skip
        total += iterations
        jumped = jumped or largest_step(angles, before) > bound
    return jumped, status, total, distance, turn


@uncounted
def walk_without_jumps(
    algebra: int,
    chain: Chain,
    kind: int,
    begin: Array,
    end: Array,
    stop: Stop,
    rule: int,
    settings: Array,
    bound: float,
    current: Array,
    angles: Array,
    work: Array,
) -> Outcome:
    """`walk` from `current` in more and more pieces until no step is a jump.

    Where even of the smallest one is, the arm stays where it was, STAGNATED or UNREACHABLE.
    """
    tolerance, orientation_tolerance, weight, window, most = stop
    total, status, distance, turn = 0, STAGNATED, np.inf, np.inf
    # The last round makes no update: it measures where the arm stays. A second call of `walk` for that would be
    # compiled anew, and take seconds.
    for halvings in range(1, HALVINGS + 2):
        stays = halvings > HALVINGS
        copy(current, angles)
        jumped, status, iterations, distance, turn = walk(
            algebra, chain, kind, begin, end, 1 if stays else 2**halvings,
            (tolerance, orientation_tolerance, weight, window, 0 if stays else most),
            rule, settings, bound, angles, work,
        )  # fmt: skip
        total += iterations
        if not (jumped or stays):
            return status, total, distance, turn
    return status if status == UNREACHABLE else STAGNATED, total, distance, turn


@inlined
def room_to_walk(n: int, joints: int) -> int:
    """How many numbers of workspace `walk` takes."""
    return LARGEST + joints + room(n, joints)


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
    """Solve `targets` (m, ·) in order, each from the angles of the one before; write them into `angles` (m, d).

    A step of more than `bound` in any joint is a jump to another branch. It is walked again in smaller and smaller
    pieces of the straight way.
    """
    no_trace, current = np.empty((0, 2)), start.copy()
    work = np.empty(room_to_walk(chain[0].shape[0], start.shape[0]))
    for i in range(targets.shape[0]):
        copy(current, angles[i])
        status, iterations, distance, turn = solve_once(
            algebra, chain, kind, targets[i], stop, rule, settings, angles[i], IMPROVEMENT, no_trace, no_trace,
            work,
        )  # fmt: skip
        if i > 0 and largest_step(angles[i], current) > bound:
            status, more, distance, turn = walk_without_jumps(
                algebra, chain, kind, targets[i - 1], targets[i], stop, rule, settings, bound, current,
                angles[i], work,
            )  # fmt: skip
            iterations += more
        counts[i, STATUS], counts[i, ITERATIONS], counts[i, RESTARTS] = status, iterations, 0
        errors[i, DISTANCE], errors[i, TURN] = distance, turn
        copy(angles[i], current)
