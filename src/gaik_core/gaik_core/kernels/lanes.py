"""Levenberg-Marquardt for many positions: LANES solves in lock step, so that the compiler uses vector registers.

A lane whose target is reached takes up the next target at once. What does not converge in a few updates is left to the
solve of one target, which knows stagnation and restarts.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from gaik_core.kernels.compiled import compiled, inlined
from gaik_core.kernels.kinematics import QUATERNION, Chain
from gaik_core.kernels.lane_kinematics import (
    LANES,
    by_quaternions,
    by_screw_rotors,
    joint_columns,
    one_axis_each,
    turn_axes,
)
from gaik_core.kernels.rules import raised_damping

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

LEFT_OVER = -1
"""Iterations of a target given up."""


@inlined
def compare(wanted: Array, tip: Array, error: Array, squares: Array, raised: Array, made: Integers) -> None:
    """The error in every lane, its square, how much that raises the damping, and one more update counted."""
    for lane in range(LANES):
        x, y = wanted[0, lane] - tip[0, lane], wanted[1, lane] - tip[1, lane]
        z = wanted[2, lane] - tip[2, lane]
        error[0, lane], error[1, lane], error[2, lane] = x, y, z
        square = x * x + y * y + z * z
        raised[lane] = raised_damping(raised[lane], square, squares[lane])
        squares[lane] = square
        made[lane] += 1


@inlined
def normal_equations(limits: Array, angles: Array, error: Array, jacobian: Array, normal: Array) -> None:
    """J Jᵀ without the joints that stand on a limit and would descend through it; they leave `jacobian` too."""
    for lane in range(LANES):
        for k in range(6):
            normal[k, lane] = 0.0
    for j in range(angles.shape[0]):
        low, high = limits[0, j], limits[1, j]
        for lane in range(LANES):
            x, y, z = jacobian[j, 0, lane], jacobian[j, 1, lane], jacobian[j, 2, lane]
            down = x * error[0, lane] + y * error[1, lane] + z * error[2, lane]
            stuck = (angles[j, lane] <= low and down < 0.0) or (angles[j, lane] >= high and down > 0.0)
            free = 0.0 if stuck else 1.0
            x, y, z = free * x, free * y, free * z
            jacobian[j, 0, lane], jacobian[j, 1, lane], jacobian[j, 2, lane] = x, y, z
            normal[0, lane] += x * x
            normal[1, lane] += x * y
            normal[2, lane] += x * z
            normal[3, lane] += y * y
            normal[4, lane] += y * z
            normal[5, lane] += z * z


@inlined
def solve_normal_equations(
    normal: Array, error: Array, squares: Array, raised: Array, damping: float, bias: float
) -> None:
    """`error` becomes (J Jᵀ + λ² I)⁻¹ e, by L D Lᵀ (Golub and Van Loan, 4.1): three divisions and no root."""
    for lane in range(LANES):
        x, y, z = error[0, lane], error[1, lane], error[2, lane]
        xx, xy, xz = normal[0, lane], normal[1, lane], normal[2, lane]
        yy, yz, zz = normal[3, lane], normal[4, lane], normal[5, lane]
        fade = raised[lane] * (0.5 * damping * squares[lane] + bias * (xx + yy + zz) / 3.0) + 1e-300
        d0 = 1.0 / (xx + fade)
        l10, l20 = xy * d0, xz * d0
        d1 = 1.0 / (yy + fade - l10 * xy)
        yz -= l20 * xy
        l21 = yz * d1
        d2 = 1.0 / (zz + fade - l20 * xz - l21 * yz)
        y -= l10 * x
        z = (z - l20 * x - l21 * y) * d2
        y = y * d1 - l21 * z
        error[0, lane], error[1, lane], error[2, lane] = x * d0 - l10 * y - l20 * z, y, z


@inlined
def step(limits: Array, jacobian: Array, error: Array, angles: Array) -> None:
    """θ ← θ + Jᵀ e, no further than the limits."""
    for j in range(angles.shape[0]):
        low, high = limits[0, j], limits[1, j]
        for lane in range(LANES):
            value = angles[j, lane] + (
                jacobian[j, 0, lane] * error[0, lane]
                + jacobian[j, 1, lane] * error[1, lane]
                + jacobian[j, 2, lane] * error[2, lane]
            )
            value = low if value < low else value
            angles[j, lane] = high if value > high else value


@inlined
def take_up(
    number: int, lane: int, targets: Array, starts: Array, limits: Array, wanted: Array, angles: Array
) -> None:
    """Give a lane the target of a number, and the angles it starts from, pulled inside the limits."""
    for k in range(3):
        wanted[k, lane] = targets[number, k]
    for j in range(starts.shape[1]):
        angles[j, lane] = min(max(starts[number, j], limits[0, j]), limits[1, j])


@compiled
def solve_lanes(
    algebra: int,
    chain: Chain,
    targets: Array,
    tolerance: float,
    patience: int,
    settings: Array,
    angles: Array,
    errors: Array,
    iterations: Integers,
) -> None:
    """Solve `targets` (m, 3) from the rows of `angles` (m, d), in place; `iterations` of those given up is LEFT_OVER.

    A lane gives a target up after `patience` updates; before these the solve of one target may not stagnate either.
    There is a target for every lane at least, and the chain has limits of joints at most, not of axes.
    """
    axes, couplings, ends, limits, _ = chain
    n, joints, many = axes.shape[0], angles.shape[1], targets.shape[0]
    if limits.shape[1] == 0:
        limits = np.full((2, joints), math.inf)
        limits[0] = -math.inf
    direct = one_axis_each(axes, couplings, joints)
    theta, columns = np.zeros((joints, LANES)), np.zeros((n, 3, LANES))
    turned = theta if direct else np.zeros((n, LANES))
    jacobian = columns if direct else np.zeros((joints, 3, LANES))
    tip, twists, state = np.zeros((3, LANES)), np.zeros((n, 6, LANES)), np.zeros((8, LANES))
    wanted, error, normal = np.zeros((3, LANES)), np.zeros((3, LANES)), np.zeros((6, LANES))
    task, made = np.arange(LANES), np.zeros(LANES, np.int64)
    squares, raised = np.zeros(LANES), np.ones(LANES)
    following, active = LANES, LANES
    for lane in range(LANES):
        take_up(lane, lane, targets, angles, limits, wanted, theta)
    while active > 0:
        if not direct:
            turn_axes(axes, couplings, theta, turned)
        if algebra == QUATERNION:
            by_quaternions(axes, ends, turned, tip, twists, columns, state)
        else:
            by_screw_rotors(axes, ends, turned, tip, twists, columns, state)
        if not direct:
            joint_columns(couplings, columns, jacobian)
        compare(wanted, tip, error, squares, raised, made)
        for lane in range(LANES):
            reached = squares[lane] < tolerance * tolerance
            if task[lane] == many or not (reached or made[lane] > patience):
                continue
            if reached:
                for j in range(joints):
                    angles[task[lane], j] = theta[j, lane]
            errors[task[lane]] = math.sqrt(squares[lane])
            iterations[task[lane]] = made[lane] - 1 if reached else LEFT_OVER
            for k in range(3):
                error[k, lane] = 0.0  # so that this round's step leaves what the lane now takes up as it is
            task[lane], made[lane], squares[lane], raised[lane] = following, 0, 0.0, 1.0
            if following < many:
                take_up(following, lane, targets, angles, limits, wanted, theta)
                following += 1
            else:
                active -= 1
        normal_equations(limits, theta, error, jacobian, normal)
        solve_normal_equations(normal, error, squares, raised, settings[0], settings[1])
        step(limits, jacobian, error, theta)
