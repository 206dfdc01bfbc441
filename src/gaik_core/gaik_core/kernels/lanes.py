"""Levenberg-Marquardt for many positions: LANES solves in lock step, so that the compiler uses vector registers.

Every array has the lanes last, every formula is the one that a single solve uses, in a loop over the lanes that has no
branch. A lane whose target is reached takes up the next target at once. What does not converge in a few updates is left
to the solve of one target, which knows stagnation and restarts.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from gaik_core.kernels import conformal as c
from gaik_core.kernels import quaternion as q
from gaik_core.kernels.compiled import compiled, inlined
from gaik_core.kernels.kinematics import QUATERNION, REVOLUTE, Chain

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

LANES = 16
PATIENCE = 20
"""Updates after which a lane gives its target up to the solve of one target."""

LEFT_OVER = -1
"""Iterations of a target given up."""


@inlined
def sine_cosine(x: float) -> tuple[float, float]:
    """Sine and cosine without a branch or a call, to 2e-16 for |x| < 1e5 (Cody and Waite 1980, as in Cephes)."""
    n = math.floor(x * 0.6366197723675814 + 0.5)
    r = ((x - n * 1.5707963109016418) - n * 1.5893254712295857e-08) - n * 6.123233995736766e-17
    z = r * r
    sine = 1.58962301576546568060e-10 * z - 2.50507477628578072866e-8
    sine = (sine * z + 2.75573136213857245213e-6) * z - 1.98412698295895385996e-4
    sine = (sine * z + 8.33333333332211858878e-3) * z - 1.66666666666666307295e-1
    sine = r + r * z * sine
    cosine = -1.13585365213876817300e-11 * z + 2.08757008419747316778e-9
    cosine = (cosine * z - 2.75573141792967388112e-7) * z + 2.48015872888517045348e-5
    cosine = (cosine * z - 1.38888888888730564116e-3) * z + 4.16666666666665929218e-2
    cosine = 1.0 - 0.5 * z + z * z * cosine
    quadrant = n - 4.0 * math.floor(0.25 * n)
    odd = quadrant == 1.0 or quadrant == 3.0
    sign_of_sine = -1.0 if quadrant >= 2.0 else 1.0
    sign_of_cosine = -1.0 if quadrant == 1.0 or quadrant == 2.0 else 1.0
    return (
        sign_of_sine * (cosine if odd else sine),
        sign_of_cosine * (sine if odd else cosine),
    )


@inlined
def turn_axes(axes: Array, couplings: Array, angles: Array, turned: Array) -> None:
    """Angles (n, lanes) about the axes: offset + C θ."""
    for i in range(axes.shape[0]):
        for lane in range(LANES):
            turned[i, lane] = axes[i, 10]
    for k in range(couplings.shape[0]):
        axis, joint, factor = int(couplings[k, 0]), int(couplings[k, 1]), couplings[k, 2]
        for lane in range(LANES):
            turned[axis, lane] += factor * angles[joint, lane]


@inlined
def by_quaternions(axes: Array, ends: Array, turned: Array, tip: Array, columns: Array, state: Array) -> None:
    """Tips (3, lanes) and linear columns (n, 6, lanes): as `gaik_core.kernels.kinematics.by_quaternions`.

    `state` (8, lanes) keeps the rotation so far and the point reached.
    """
    for lane in range(LANES):
        state[0, lane], state[1, lane], state[2, lane], state[3, lane] = 1.0, 0.0, 0.0, 0.0
        state[4, lane], state[5, lane], state[6, lane] = ends[0], ends[1], ends[2]
    for i in range(axes.shape[0]):
        axis, link = (axes[i, 1], axes[i, 2], axes[i, 3]), (axes[i, 4], axes[i, 5], axes[i, 6])
        turns = 1.0 if axes[i, 0] == REVOLUTE else 0.0
        for lane in range(LANES):
            before = (state[0, lane], state[1, lane], state[2, lane], state[3, lane])
            x, y, z, angle = state[4, lane], state[5, lane], state[6, lane], turned[i, lane]
            direction = q.rotate(before, axis)
            slide = (1.0 - turns) * angle
            x, y, z = x + slide * direction[0], y + slide * direction[1], z + slide * direction[2]
            sine, cosine = sine_cosine(0.5 * turns * angle)
            after = q.multiply(before, q.from_half_angle(axis, cosine, sine))
            moved = q.rotate(after, link)
            columns[i, 0, lane], columns[i, 1, lane], columns[i, 2, lane] = x, y, z
            for k in range(3):
                columns[i, 3 + k, lane] = direction[k]
            for k in range(4):
                state[k, lane] = after[k]
            state[4, lane], state[5, lane], state[6, lane] = x + moved[0], y + moved[1], z + moved[2]
    for k in range(3):
        for lane in range(LANES):
            tip[k, lane] = state[4 + k, lane]
    for i in range(axes.shape[0]):
        turns = 1.0 if axes[i, 0] == REVOLUTE else 0.0
        for lane in range(LANES):
            u = (columns[i, 3, lane], columns[i, 4, lane], columns[i, 5, lane])
            x, y, z = columns[i, 0, lane], columns[i, 1, lane], columns[i, 2, lane]
            v = q.cross(u, (tip[0, lane] - x, tip[1, lane] - y, tip[2, lane] - z))
            columns[i, 0, lane] = turns * v[0] + (1.0 - turns) * u[0]
            columns[i, 1, lane] = turns * v[1] + (1.0 - turns) * u[1]
            columns[i, 2, lane] = turns * v[2] + (1.0 - turns) * u[2]


@inlined
def by_screw_rotors(
    axes: Array, ends: Array, turned: Array, tip: Array, columns: Array, motor: Array
) -> None:
    """Tips (3, lanes) and linear columns (n, 6, lanes): as `gaik_core.kernels.kinematics.by_screw_rotors`."""
    for lane in range(LANES):
        motor[0, lane] = 1.0
        for k in range(1, 8):
            motor[k, lane] = 0.0
    for i in range(axes.shape[0]):
        turns = axes[i, 0] == REVOLUTE
        line = (axes[i, 1], axes[i, 2], axes[i, 3], axes[i, 7], axes[i, 8], axes[i, 9])
        if not turns:
            line = (0.0, 0.0, 0.0, axes[i, 1], axes[i, 2], axes[i, 3])
        for lane in range(LANES):
            before = (
                motor[0, lane], motor[1, lane], motor[2, lane], motor[3, lane],
                motor[4, lane], motor[5, lane], motor[6, lane], motor[7, lane],
            )  # fmt: skip
            moved = c.move_line(before, line)
            for k in range(3):
                columns[i, k, lane], columns[i, 3 + k, lane] = moved[3 + k], moved[k]
            half = 0.5 * turned[i, lane]
            sine, cosine = sine_cosine(half)
            sine, cosine = (sine, cosine) if turns else (half, 1.0)
            after = c.multiply(before, c.from_half_angle(line, cosine, sine))
            for k in range(8):
                motor[k, lane] = after[k]
    for lane in range(LANES):
        whole = (
            motor[0, lane], motor[1, lane], motor[2, lane], motor[3, lane],
            motor[4, lane], motor[5, lane], motor[6, lane], motor[7, lane],
        )  # fmt: skip
        tip[0, lane], tip[1, lane], tip[2, lane] = c.move_point(whole, (ends[3], ends[4], ends[5]))
    for i in range(axes.shape[0]):
        for lane in range(LANES):
            moved = (
                columns[i, 3, lane], columns[i, 4, lane], columns[i, 5, lane],
                columns[i, 0, lane], columns[i, 1, lane], columns[i, 2, lane],
            )  # fmt: skip
            columns[i, 0, lane], columns[i, 1, lane], columns[i, 2, lane] = c.point_dot_line(
                (tip[0, lane], tip[1, lane], tip[2, lane]), moved
            )


@inlined
def joint_columns(couplings: Array, columns: Array, jacobian: Array) -> None:
    """The joints' Jacobian (d, 3, lanes) from the axes' columns."""
    for j in range(jacobian.shape[0]):
        for k in range(3):
            for lane in range(LANES):
                jacobian[j, k, lane] = 0.0
    for entry in range(couplings.shape[0]):
        axis, joint, factor = int(couplings[entry, 0]), int(couplings[entry, 1]), couplings[entry, 2]
        for k in range(3):
            for lane in range(LANES):
                jacobian[joint, k, lane] += factor * columns[axis, k, lane]


@inlined
def block_joints(limits: Array, angles: Array, error: Array, jacobian: Array) -> None:
    """Take out the joints that stand on a limit and would descend through it."""
    for j in range(angles.shape[0]):
        low, high = limits[0, j], limits[1, j]
        for lane in range(LANES):
            down = (
                jacobian[j, 0, lane] * error[0, lane]
                + jacobian[j, 1, lane] * error[1, lane]
                + jacobian[j, 2, lane] * error[2, lane]
            )
            stuck = (angles[j, lane] <= low and down < 0.0) or (angles[j, lane] >= high and down > 0.0)
            free = 0.0 if stuck else 1.0
            for k in range(3):
                jacobian[j, k, lane] *= free


@inlined
def levenberg_marquardt(
    angles: Array, error: Array, jacobian: Array, normal: Array, damping: float, bias: float
) -> None:
    """θ ← θ + Jᵀ (J Jᵀ + λ I)⁻¹ e in every lane, the 3 x 3 system solved by Cholesky; `error` becomes (…)⁻¹ e."""
    for lane in range(LANES):
        for k in range(6):
            normal[k, lane] = 0.0
    for j in range(angles.shape[0]):
        for lane in range(LANES):
            x, y, z = jacobian[j, 0, lane], jacobian[j, 1, lane], jacobian[j, 2, lane]
            normal[0, lane] += x * x
            normal[1, lane] += x * y
            normal[2, lane] += x * z
            normal[3, lane] += y * y
            normal[4, lane] += y * z
            normal[5, lane] += z * z
    for lane in range(LANES):
        ex, ey, ez = error[0, lane], error[1, lane], error[2, lane]
        trace = normal[0, lane] + normal[3, lane] + normal[5, lane]
        fade = 0.5 * damping * (ex * ex + ey * ey + ez * ez) + bias * trace / 3.0 + 1e-300
        a = math.sqrt(normal[0, lane] + fade)
        b, d = normal[1, lane] / a, normal[2, lane] / a
        e = math.sqrt(normal[3, lane] + fade - b * b)
        f = (normal[4, lane] - b * d) / e
        g = math.sqrt(normal[5, lane] + fade - d * d - f * f)
        ex = ex / a
        ey = (ey - b * ex) / e
        ez = (ez - d * ex - f * ey) / g
        ez = ez / g
        ey = (ey - f * ez) / e
        ex = (ex - b * ey - d * ez) / a
        error[0, lane], error[1, lane], error[2, lane] = ex, ey, ez
    for j in range(angles.shape[0]):
        for lane in range(LANES):
            angles[j, lane] += (
                jacobian[j, 0, lane] * error[0, lane]
                + jacobian[j, 1, lane] * error[1, lane]
                + jacobian[j, 2, lane] * error[2, lane]
            )


@inlined
def clamp(limits: Array, angles: Array) -> None:
    """Move each joint onto the limit it has crossed."""
    for j in range(angles.shape[0]):
        low, high = limits[0, j], limits[1, j]
        for lane in range(LANES):
            value = angles[j, lane]
            value = low if value < low else value
            angles[j, lane] = high if value > high else value


@compiled
def solve_lanes(
    algebra: int,
    chain: Chain,
    targets: Array,
    tolerance: float,
    max_iterations: int,
    settings: Array,
    angles: Array,
    errors: Array,
    iterations: Integers,
) -> None:
    """Solve `targets` (m, 3) from the rows of `angles` (m, d), in place; `iterations` of those given up is LEFT_OVER.

    The chain has limits of joints at most, not of axes.
    """
    axes, couplings, ends, limits, _ = chain
    n, joints, limited = axes.shape[0], angles.shape[1], limits.shape[1] > 0
    theta, turned, tip = np.zeros((joints, LANES)), np.zeros((n, LANES)), np.zeros((3, LANES))
    columns, state, jacobian = np.zeros((n, 6, LANES)), np.zeros((8, LANES)), np.zeros((joints, 3, LANES))
    wanted, error, normal = np.zeros((3, LANES)), np.zeros((3, LANES)), np.zeros((6, LANES))
    task, made, squares = np.full(LANES, -1), np.zeros(LANES, np.int64), np.zeros(LANES)
    patience, following, active = min(PATIENCE, max_iterations), 0, 0
    for lane in range(min(LANES, targets.shape[0])):
        take_up(following, lane, targets, angles, task, made, theta, wanted)
        following, active = following + 1, active + 1
    if limited:
        clamp(limits, theta)
    while active > 0:
        turn_axes(axes, couplings, theta, turned)
        if algebra == QUATERNION:
            by_quaternions(axes, ends, turned, tip, columns, state)
        else:
            by_screw_rotors(axes, ends, turned, tip, columns, state)
        joint_columns(couplings, columns, jacobian)
        for lane in range(LANES):
            x, y, z = (
                wanted[0, lane] - tip[0, lane],
                wanted[1, lane] - tip[1, lane],
                wanted[2, lane] - tip[2, lane],
            )
            error[0, lane], error[1, lane], error[2, lane] = x, y, z
            squares[lane] = x * x + y * y + z * z
            made[lane] += 1
        for lane in range(LANES):
            reached = squares[lane] < tolerance * tolerance
            if task[lane] < 0 or not (reached or made[lane] > patience):
                continue
            if reached:
                for j in range(joints):
                    angles[task[lane], j] = theta[j, lane]
            errors[task[lane]] = math.sqrt(squares[lane])
            iterations[task[lane]] = made[lane] - 1 if reached else LEFT_OVER
            for k in range(3):
                error[k, lane] = 0.0  # so that this round's update leaves what the lane now takes up as it is
            task[lane] = -1
            active -= 1
            if following < targets.shape[0]:
                take_up(following, lane, targets, angles, task, made, theta, wanted)
                following, active = following + 1, active + 1
        if limited:
            block_joints(limits, theta, error, jacobian)
        levenberg_marquardt(theta, error, jacobian, normal, settings[0], settings[1])
        if limited:
            clamp(limits, theta)


@inlined
def take_up(
    number: int,
    lane: int,
    targets: Array,
    angles: Array,
    task: Integers,
    made: Integers,
    theta: Array,
    wanted: Array,
) -> None:
    """Give a lane the target of a number, and the angles it starts from."""
    task[lane], made[lane] = number, 0
    for k in range(3):
        wanted[k, lane] = targets[number, k]
    for j in range(angles.shape[1]):
        theta[j, lane] = angles[number, j]
