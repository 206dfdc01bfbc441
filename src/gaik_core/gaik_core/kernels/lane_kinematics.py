"""Forward kinematics and Jacobian of LANES solves in lock step, once by quaternions and once by screw rotors.

Every array has the lanes last, and every formula is the one of `gaik_core.kernels.kinematics`, in a loop over the lanes
that has no branch, so that the compiler uses vector registers.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from gaik_core.kernels import conformal as c
from gaik_core.kernels import quaternion as q
from gaik_core.kernels.compiled import inlined
from gaik_core.kernels.kinematics import REVOLUTE

Array = NDArray[np.float64]

LANES = 16


@inlined
def sine_cosine(half: float) -> tuple[float, float]:
    """Sine and cosine of half an angle, or both with the other sign, to 3e-16 for |half| < 1e5; no branch, no call.

    A rotor and its negative are one rotation, so the angle is reduced by multiples of π, in two parts (Cody and Waite
    1980). The polynomials interpolate (sin r - r)/r³ and (cos r - 1 + r²/2)/r⁴ in r² at the Chebyshev points.
    """
    n = math.floor(half * 0.3183098861837907 + 0.5)
    r = (half - n * 3.1415926534682512) - n * 1.2154201013012384e-10
    z = r * r
    sine = 2.7314289869116175e-15 * z - 7.64396903111606e-13
    sine = (sine * z + 1.6058977272817488e-10) * z - 2.5052107616384624e-08
    sine = (sine * z + 2.755731921915843e-06) * z - 1.9841269841254955e-04
    sine = (sine * z + 8.333333333333316e-03) * z - 1.6666666666666666e-01
    cosine = 4.646409716539915e-14 * z - 1.1466250478625809e-11
    cosine = (cosine * z + 2.0876681513909434e-09) * z - 2.755731857284834e-07
    cosine = (cosine * z + 2.4801587298910888e-05) * z - 1.3888888888884763e-03
    cosine = cosine * z + 4.166666666666666e-02
    return r + r * z * sine, 1.0 - 0.5 * z + z * z * cosine


@inlined
def one_axis_each(axes: Array, couplings: Array, joints: int) -> bool:
    """Whether each joint's angle is the angle about one axis, so that neither angles nor columns need be summed."""
    if axes.shape[0] != joints or couplings.shape[0] != joints:
        return False
    for i in range(joints):
        if couplings[i, 0] != i or couplings[i, 1] != i or couplings[i, 2] != 1.0 or axes[i, 10] != 0.0:
            return False
    return True


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
def by_quaternions(
    axes: Array, ends: Array, turned: Array, tip: Array, twists: Array, columns: Array, state: Array
) -> None:
    """Tips (3, lanes) and linear columns (n, 3, lanes): as `gaik_core.kernels.kinematics.by_quaternions`.

    `twists` (n, 6, lanes) keeps each axis' direction and point, `state` (8, lanes) the rotation and the point reached.
    """
    for lane in range(LANES):
        state[0, lane], state[1, lane], state[2, lane], state[3, lane] = 1.0, 0.0, 0.0, 0.0
        state[4, lane], state[5, lane], state[6, lane] = ends[0], ends[1], ends[2]
    for i in range(axes.shape[0]):
        axis, link = (axes[i, 1], axes[i, 2], axes[i, 3]), (axes[i, 4], axes[i, 5], axes[i, 6])
        if axes[i, 0] == REVOLUTE:
            for lane in range(LANES):
                before = (state[0, lane], state[1, lane], state[2, lane], state[3, lane])
                x, y, z = state[4, lane], state[5, lane], state[6, lane]
                sine, cosine = sine_cosine(0.5 * turned[i, lane])
                after = q.multiply(before, q.from_half_angle(axis, cosine, sine))
                direction, moved = q.rotate(before, axis), q.rotate(after, link)
                for k in range(3):
                    twists[i, k, lane] = direction[k]
                twists[i, 3, lane], twists[i, 4, lane], twists[i, 5, lane] = x, y, z
                for k in range(4):
                    state[k, lane] = after[k]
                state[4, lane], state[5, lane], state[6, lane] = x + moved[0], y + moved[1], z + moved[2]
        else:
            for lane in range(LANES):
                slide = turned[i, lane]
                way = (link[0] + slide * axis[0], link[1] + slide * axis[1], link[2] + slide * axis[2])
                rotation = (state[0, lane], state[1, lane], state[2, lane], state[3, lane])
                direction, moved = q.rotate(rotation, axis), q.rotate(rotation, way)
                for k in range(3):
                    twists[i, k, lane] = direction[k]
                for k in range(3):
                    state[4 + k, lane] += moved[k]
    for k in range(3):
        for lane in range(LANES):
            tip[k, lane] = state[4 + k, lane]
    for i in range(axes.shape[0]):
        if axes[i, 0] == REVOLUTE:
            for lane in range(LANES):
                u = (twists[i, 0, lane], twists[i, 1, lane], twists[i, 2, lane])
                x, y, z = twists[i, 3, lane], twists[i, 4, lane], twists[i, 5, lane]
                v = q.cross(u, (tip[0, lane] - x, tip[1, lane] - y, tip[2, lane] - z))
                columns[i, 0, lane], columns[i, 1, lane], columns[i, 2, lane] = v
        else:
            for k in range(3):
                for lane in range(LANES):
                    columns[i, k, lane] = twists[i, k, lane]


@inlined
def by_screw_rotors(
    axes: Array, ends: Array, turned: Array, tip: Array, twists: Array, columns: Array, motor: Array
) -> None:
    """Tips (3, lanes) and linear columns (n, 3, lanes): as `gaik_core.kernels.kinematics.by_screw_rotors`.

    `twists` (n, 6, lanes) keeps each axis' line as it was moved, `motor` (8, lanes) the product so far.
    """
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
            for k in range(6):
                twists[i, k, lane] = moved[k]
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
                twists[i, 0, lane], twists[i, 1, lane], twists[i, 2, lane],
                twists[i, 3, lane], twists[i, 4, lane], twists[i, 5, lane],
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
