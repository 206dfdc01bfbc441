"""The loop of the paper: measure the error, make one update, until the tip is where it should be."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gaik_core.kernels.compiled import compiled
from gaik_core.kernels.kinematics import kinematics
from gaik_core.kernels.limits import blocked_axes, blocked_joints, hold, project
from gaik_core.kernels.rules import SLOTS, step
from gaik_core.kernels.task import measure, task_rows

Array = NDArray[np.float64]

CONVERGED, ITERATION_LIMIT, STAGNATED, UNREACHABLE, LIMITED = range(5)

IMPROVEMENT = 1e-6
"""A solve stagnates when the loss has not fallen by this share within the rule's window of updates."""

Outcome = tuple[int, int, float, float]
"""Status, updates made, distance left (m), angle left (rad)."""


@compiled
def descend(
    algebra: int,
    axes: Array,
    couplings: Array,
    ends: Array,
    limits: Array,
    held: Array,
    kind: int,
    target: Array,
    stop: Array,
    rule: int,
    settings: Array,
    max_iterations: int,
    angles: Array,
    trace_angles: Array,
    trace_errors: Array,
) -> Outcome:
    """Move `angles` in place until the error of the target is below its tolerance.

    `stop` is (tolerance m, orientation tolerance rad, weight m/rad, window). `trace_angles` (max_iterations + 1, d) and
    `trace_errors` (max_iterations + 1, 2) are filled as far as the solve goes; of length 0, they are left alone.
    """
    n, joints = axes.shape[0], angles.shape[0]
    turned, columns, pose = np.empty(n), np.empty((6, n)), np.empty(7)
    full, error = np.empty((6, joints)), np.empty(task_rows(kind))
    jacobian = full[: error.shape[0]]
    state, previous = np.zeros((SLOTS, joints)), angles.copy()
    limited = limits.shape[1] > 0
    if limited:
        project(axes, couplings, limits, held, angles)
    best, since, iterations = np.inf, 0, 0
    while True:
        kinematics(algebra, axes, couplings, ends, angles, turned, columns, pose, full)
        distance, turn = measure(kind, stop[2], target, pose, full, error)
        if iterations < trace_errors.shape[0]:
            trace_angles[iterations] = angles
            trace_errors[iterations, 0], trace_errors[iterations, 1] = distance, turn
        if distance < stop[0] and turn < stop[1]:
            return CONVERGED, iterations, distance, turn
        loss = 0.0
        for row in range(error.shape[0]):
            loss += error[row] * error[row]
        if loss < best * (1.0 - IMPROVEMENT):
            best, since = loss, 0
        else:
            since += 1
        blocked = 0
        if limited:
            blocked = blocked_joints(limits, angles, error, jacobian)
            blocked += blocked_axes(axes, couplings, held, angles, error, jacobian)
        if since >= stop[3]:
            return LIMITED if blocked > 0 else STAGNATED, iterations, distance, turn
        if iterations >= max_iterations:
            return ITERATION_LIMIT, iterations, distance, turn
        previous[:] = angles
        step(rule, angles, error, jacobian, state, settings)
        if not np.isfinite(angles).all():
            angles[:] = previous
            return STAGNATED, iterations, distance, turn
        if limited:
            hold(axes, couplings, limits, held, previous, angles)
        iterations += 1


@compiled
def descend_with_restarts(
    algebra: int,
    axes: Array,
    couplings: Array,
    ends: Array,
    limits: Array,
    held: Array,
    kind: int,
    target: Array,
    stop: Array,
    rule: int,
    settings: Array,
    max_iterations: int,
    starts: Array,
    angles: Array,
) -> tuple[int, int, float, float, int]:
    """Descend from `angles`; where that gets stuck, from each row of `starts` in turn, all within one budget of updates.

    Leaves in `angles` the best of all ends and returns its outcome, the updates of all attempts and the number of restarts.
    """
    no_trace = np.empty((0, 2))
    attempt = angles.copy()
    status, total, distance, turn, restarts = ITERATION_LIMIT, 0, np.inf, np.inf, 0
    for k in range(starts.shape[0] + 1):
        if k > 0:
            attempt[:] = starts[k - 1]
        outcome, iterations, reached, turned = descend(
            algebra, axes, couplings, ends, limits, held, kind, target, stop, rule, settings,
            max_iterations - total, attempt, no_trace, no_trace,
        )  # fmt: skip
        total, restarts = total + iterations, k
        if outcome == CONVERGED or reached + stop[2] * turned < distance + stop[2] * turn:
            status, distance, turn = outcome, reached, turned
            angles[:] = attempt
        if outcome == CONVERGED or total >= max_iterations:
            break
    return status, total, distance, turn, restarts
