"""The loop of the paper: measure the error, make one update, until the tip is where it should be."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from gaik_core.kernels.compiled import inlined, uncounted
from gaik_core.kernels.kinematics import Chain, kinematics
from gaik_core.kernels.limits import blocked_axes, blocked_joints, clamp_joints, hold_axes, move_inside
from gaik_core.kernels.rules import SLOTS, forget, step
from gaik_core.kernels.task import measure, task_rows

Array = NDArray[np.float64]

CONVERGED, ITERATION_LIMIT, STAGNATED, UNREACHABLE, LIMITED, NOT_FINITE, GOING = range(7)

IMPROVEMENT = 1e-6
"""A solve stagnates when the loss has not fallen by this share within the rule's window of updates."""

IMPATIENCE = 0.2
"""The share while other starts are left to try: a slow way is then not worth its updates."""

FAR = 10.0
"""Targets further than this many reaches, and twice the tolerance, are pulled in."""

LARGEST, POSE_SIZE = 9, 7
"""The numbers of the longest target, and of a pose."""

Stop = tuple[float, float, float, int, int]
"""Tolerance (m), orientation tolerance (rad), weight (m/rad), window and most updates."""

Outcome = tuple[int, int, float, float]
"""Status, updates made, distance left (m), angle left (rad)."""


@inlined
def square(vector: Array) -> float:
    """|v|²."""
    total = 0.0
    for k in range(vector.shape[0]):
        total += vector[k] * vector[k]
    return total


@inlined
def copy(source: Array, result: Array) -> None:
    """Element by element: a slice assignment in a loop costs more than an update."""
    for k in range(source.shape[0]):
        result[k] = source[k]


@inlined
def all_finite(vector: Array) -> bool:
    """Whether no element is NaN or infinite: zero times either is NaN."""
    total = 0.0
    for k in range(vector.shape[0]):
        total += 0.0 * vector[k]
    return total == 0.0


@inlined
def length(x: float, y: float, z: float) -> float:
    """Of a vector; scaled, so that 1e308 does not overflow."""
    largest = max(abs(x), abs(y), abs(z))
    if largest == 0.0:
        return 0.0
    x, y, z = x / largest, y / largest, z / largest
    return largest * math.sqrt(x * x + y * y + z * z)


@inlined
def distance_from_base(chain: Chain, target: Array) -> float:
    """How far a target is from the first axis (m)."""
    ends = chain[2]
    return float(length(target[0] - ends[0], target[1] - ends[1], target[2] - ends[2]))


@inlined
def unreachable(chain: Chain, target: Array, tolerance: float) -> bool:
    """Whether the lengths of the links alone rule a target out: too far, or in the hole around the first axis."""
    distance = distance_from_base(chain, target)
    return bool(distance > chain[2][11] + tolerance or distance < chain[2][10] - tolerance)


@inlined
def pull_in(chain: Chain, target: Array, tolerance: float, near: Array) -> None:
    """Write the target into `near` or, where it is far, a point on the way to it that is out of reach as well.

    The arm stretches toward either alike, and what is descended stays of a size that floating point can square.
    """
    copy(target, near)
    ends, distance = chain[2], distance_from_base(chain, target)
    furthest = FAR * ends[11] + 2.0 * tolerance
    if distance > furthest:
        for k in range(3):
            near[k] = ends[k] + (target[k] - ends[k]) * (furthest / distance)


@inlined
def take_out_blocked(chain: Chain, angles: Array, error: Array, jacobian: Array, normal: Array) -> int:
    """Take what would cross a limit out of the Jacobian; how many limits are in the way."""
    axes, couplings, _, limits, held = chain
    if limits.shape[1] == 0:
        return 0
    blocked = blocked_joints(limits, angles, error, jacobian)
    return int(blocked + blocked_axes(axes, couplings, held, angles, error, jacobian, normal))


@inlined
def hold_limits(chain: Chain, previous: Array, angles: Array) -> None:
    """Take an update back as far as it crosses limits."""
    axes, couplings, _, limits, held = chain
    if limits.shape[1] > 0:
        clamp_joints(limits, angles)
        hold_axes(axes, couplings, limits, held, previous, angles)


@inlined
def room(n: int, joints: int) -> int:
    """How many numbers of workspace a solve of `n` axes takes: one array, since each that is made costs 25 ns."""
    return LARGEST + 2 * POSE_SIZE + 7 * n + 10 * joints + SLOTS * max(SLOTS, joints)


@uncounted
def descend(
    algebra: int,
    chain: Chain,
    kind: int,
    target: Array,
    stop: Stop,
    rule: int,
    settings: Array,
    angles: Array,
    improvement: float,
    trace_angles: Array,
    trace_errors: Array,
    work: Array,
) -> Outcome:
    """Move `angles` in place until the error of the target is below its tolerance, or stops falling by `improvement`.

    Where it does not get there, `angles` end where they came nearest, and it is there that limits count as in the way.
    `trace_angles` (max_iterations + 1, d) and `trace_errors` (max_iterations + 1, 2) are filled as far as the solve
    goes; of length 0, they are left alone. `work` is what `room` asks for.
    """
    tolerance, orientation_tolerance, weight, window, max_iterations = stop
    axes, couplings, ends, limits, held = chain
    n, joints, rows = axes.shape[0], angles.shape[0], task_rows(kind)
    pose, error, free = work[:POSE_SIZE], work[POSE_SIZE : POSE_SIZE + rows], work[2 * POSE_SIZE :]
    turned, columns, free = free[:n], free[n : 7 * n].reshape((n, 6)), free[7 * n :]
    jacobian, free = free[: rows * joints].reshape((rows, joints)), free[rows * joints :]
    previous, nearest, normal = free[:joints], free[joints : 2 * joints], free[2 * joints : 3 * joints]
    state = free[3 * joints :][: SLOTS * max(SLOTS, joints)].reshape((SLOTS, max(SLOTS, joints)))
    forget(state)
    limited = limits.shape[1] > 0
    inside = not limited or move_inside(axes, couplings, limits, held, angles)
    copy(angles, nearest)
    ended = GOING if inside else LIMITED
    least, best, since, iterations = np.inf, np.inf, 0, 0
    while True:
        kinematics(algebra, axes, couplings, ends, angles, turned, columns, pose, jacobian)
        distance, turn = measure(kind, weight, target, pose, jacobian, error)
        if iterations < trace_errors.shape[0] and (ended == GOING or iterations == 0):
            copy(angles, trace_angles[iterations])
            trace_errors[iterations, 0], trace_errors[iterations, 1] = distance, turn
        if ended == GOING and distance < tolerance and turn < orientation_tolerance:
            return CONVERGED, iterations, distance, turn
        blocked = take_out_blocked(chain, angles, error, jacobian, normal)
        if ended != GOING:
            return LIMITED if ended == STAGNATED and blocked > 0 else ended, iterations, distance, turn
        loss = square(error)
        if loss < least:
            least = loss
            copy(angles, nearest)
        since += 1
        if loss < best * (1.0 - improvement):
            best, since = loss, 0
        if since >= window:
            ended = STAGNATED
        elif iterations >= max_iterations:
            ended = ITERATION_LIMIT
        else:
            if limited:
                copy(angles, previous)
            step(rule, angles, error, jacobian, state, settings)
            if all_finite(angles):
                hold_limits(chain, previous, angles)
                iterations += 1
            else:
                ended = STAGNATED
        if ended != GOING:
            copy(nearest, angles)


@uncounted
def solve_once(
    algebra: int,
    chain: Chain,
    kind: int,
    target: Array,
    stop: Stop,
    rule: int,
    settings: Array,
    angles: Array,
    improvement: float,
    trace_angles: Array,
    trace_errors: Array,
    work: Array,
) -> Outcome:
    """`descend`, with UNREACHABLE where the links prove it, and NOT_FINITE where target or start are not.

    The traces are filled as by `descend`; of length 0, they are left alone. `work` is what `room` asks for.
    """
    if not (all_finite(target) and all_finite(angles)):
        return NOT_FINITE, 0, np.nan, np.nan
    near, free = work[: target.shape[0]], work[LARGEST:]
    pull_in(chain, target, stop[0], near)
    status, iterations, distance, turn = descend(
        algebra, chain, kind, near, stop, rule, settings, angles, improvement, trace_angles, trace_errors, free,
    )  # fmt: skip
    if status != CONVERGED and unreachable(chain, target, stop[0]):
        status, tip = UNREACHABLE, free[:3]  # the descent has left its pose at the front
        distance = length(target[0] - tip[0], target[1] - tip[1], target[2] - tip[2])
    return status, iterations, distance, turn


@uncounted
def solve_with_restarts(
    algebra: int,
    chain: Chain,
    kind: int,
    target: Array,
    stop: Stop,
    rule: int,
    settings: Array,
    angles: Array,
    starts: Array,
    work: Array,
) -> tuple[int, int, float, float, int]:
    """`solve_once`; where that gets stuck, from each row of `starts` in turn, all within one budget of updates.

    Leaves in `angles` the best of all ends, gone on with until it stagnates. The outcome counts the updates of all
    attempts, and after it come the restarts. `work` is what `room` asks for.
    """
    tolerance, orientation_tolerance, weight, window, budget = stop
    attempt, free = work[: angles.shape[0]], work[angles.shape[0] :]
    no_trace, restarts = work[:0].reshape((0, 2)), 0
    improvement = IMPATIENCE if starts.shape[0] > 0 else IMPROVEMENT
    status, total, distance, turn = solve_once(
        algebra, chain, kind, target, stop, rule, settings, angles, improvement, no_trace, no_trace, free
    )
    if starts.shape[0] == 0:
        return status, total, distance, turn, restarts
    while status != CONVERGED and status != NOT_FINITE and total < budget:
        last = restarts == starts.shape[0] or status == UNREACHABLE
        copy(angles if last else starts[restarts], attempt)
        left = (tolerance, orientation_tolerance, weight, window, budget - total)
        outcome, iterations, reached, turned = solve_once(
            algebra, chain, kind, target, left, rule, settings, attempt,
            IMPROVEMENT if last else IMPATIENCE, no_trace, no_trace, free,
        )  # fmt: skip
        total += iterations
        if outcome == CONVERGED or reached + weight * turned < distance + weight * turn:
            status, distance, turn = outcome, reached, turned
            copy(attempt, angles)
        if last:
            break
        restarts += 1
    return status, total, distance, turn, restarts
