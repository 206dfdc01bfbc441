"""What a redundant arm does with its freedom: keep the tip where it is, and move toward a preferred posture."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gaik_core.kernels.compiled import compiled, inlined
from gaik_core.kernels.descent import Stop, copy, square
from gaik_core.kernels.kinematics import Chain, kinematics
from gaik_core.kernels.limits import axis_angle, clamp_joints, hold_axes
from gaik_core.kernels.rules import SLOTS, forget, levenberg_marquardt, solve_normal
from gaik_core.kernels.task import measure, task_rows

Array = NDArray[np.float64]

POSTURE_TOLERANCE = 1e-4
"""The arm has settled when it could come no closer than by this (rad), to first order."""

CORRECTIONS = 5
"""Updates that may follow a step toward the posture to bring the tip back."""

SHORTEST = 1e-3
"""The smallest share of a step that is tried."""

GROWTH = 1.5
"""How a share that was good grows for the next step."""


@inlined
def null_space_part(jacobian: Array, normal: Array, weighed: Array, step: Array) -> None:
    """z ← z - Jᵀ (J Jᵀ)⁻¹ J z: what of a motion of the joints leaves the tip where it is (Liégeois 1977)."""
    rows, joints = jacobian.shape[0], jacobian.shape[1]
    trace = 0.0
    for i in range(rows):
        weighed[i] = 0.0
        for j in range(joints):
            weighed[i] += jacobian[i, j] * step[j]
        for k in range(i + 1):
            normal[i, k] = 0.0
            for j in range(joints):
                normal[i, k] += jacobian[i, j] * jacobian[k, j]
        trace += normal[i, i]
    if trace == 0.0:
        return
    for i in range(rows):
        normal[i, i] += 1e-12 * trace
    solve_normal(normal, weighed)
    for j in range(joints):
        for i in range(rows):
            step[j] -= jacobian[i, j] * weighed[i]


@inlined
def drop_blocked(limits: Array, angles: Array, step: Array, jacobian: Array) -> None:
    """Take out the joints that stand on a limit and would be moved through it."""
    for j in range(limits.shape[1]):
        if (angles[j] <= limits[0, j] and step[j] < 0.0) or (angles[j] >= limits[1, j] and step[j] > 0.0):
            step[j] = 0.0
            for i in range(jacobian.shape[0]):
                jacobian[i, j] = 0.0


@inlined
def drop_blocked_axes(
    axes: Array, couplings: Array, held: Array, angles: Array, step: Array, jacobian: Array
) -> None:
    """Likewise the joints of a held axis that stands on its limit."""
    for h in range(held.shape[0]):
        axis = int(held[h, 0])
        angle = axis_angle(axis, axes, couplings, angles)
        if held[h, 1] + 1e-9 < angle < held[h, 2] - 1e-9:
            continue
        for k in range(couplings.shape[0]):
            if int(couplings[k, 0]) == axis:
                joint = int(couplings[k, 1])
                step[joint] = 0.0
                for i in range(jacobian.shape[0]):
                    jacobian[i, joint] = 0.0


@inlined
def square_between(a: Array, b: Array) -> float:
    """|a - b|²."""
    total = 0.0
    for j in range(a.shape[0]):
        total += (a[j] - b[j]) * (a[j] - b[j])
    return total


@compiled
def settle(
    algebra: int,
    chain: Chain,
    kind: int,
    target: Array,
    stop: Stop,
    settings: Array,
    posture: Array,
    angles: Array,
) -> tuple[int, float, float]:
    """Move `angles`, which satisfy the target, toward `posture` for as long as they go on satisfying it.

    `settings` are those of Levenberg-Marquardt, which brings the tip back after each step. A step counts only if after
    that the posture is nearer than before. Returns the updates made, and the distance and the angle left.
    """
    tolerance, orientation_tolerance, weight, _, max_iterations = stop
    axes, couplings, ends, limits, held = chain
    n, joints = axes.shape[0], angles.shape[0]
    turned, columns, pose, error = np.empty(n), np.empty((n, 6)), np.empty(7), np.empty(task_rows(kind))
    jacobian, normal = np.empty((error.shape[0], joints)), np.zeros((SLOTS, SLOTS))
    step, kept, weighed = np.empty(joints), angles.copy(), np.empty(error.shape[0])
    share, iterations = 1.0, 0
    while True:
        kinematics(algebra, axes, couplings, ends, angles, turned, columns, pose, jacobian)
        distance, turn = measure(kind, weight, target, pose, jacobian, error)
        for j in range(joints):
            step[j] = posture[j] - angles[j]
        drop_blocked(limits, angles, step, jacobian)
        drop_blocked_axes(axes, couplings, held, angles, step, jacobian)
        null_space_part(jacobian, normal, weighed, step)
        apart = square_between(posture, angles)
        if square(step) < POSTURE_TOLERANCE**2 or share < SHORTEST or iterations >= max_iterations:
            return iterations, distance, turn
        copy(angles, kept)
        for j in range(joints):
            angles[j] += share * step[j]
        arrived = False
        forget(normal)
        for _ in range(CORRECTIONS + 1):
            if limits.shape[1] > 0:
                clamp_joints(limits, angles)
            hold_axes(axes, couplings, limits, held, kept, angles)
            iterations += 1
            kinematics(algebra, axes, couplings, ends, angles, turned, columns, pose, jacobian)
            distance, turn = measure(kind, weight, target, pose, jacobian, error)
            if distance < tolerance and turn < orientation_tolerance:
                arrived = square_between(posture, angles) < apart
                break
            if iterations >= max_iterations:
                break
            levenberg_marquardt(angles, error, jacobian, normal, settings)
        if arrived:
            share = min(1.0, GROWTH * share)
        else:
            copy(kept, angles)
            share *= 0.5
