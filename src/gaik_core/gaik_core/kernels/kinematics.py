"""Forward kinematics and Jacobian of a chain, once by quaternions and once by screw rotors.

A chain comes as arrays (see `gaik_core.chain`), with n axes and d joints:

    axes (n, 11)       kind, direction u, link to the next axis, moment c × u, offset; all where every angle is zero
    couplings (k, 3)   axis, joint, factor: the angle of an axis is its offset + the sum of factor · joint
    ends (10,)         where the first axis stands, where the tip stands, the tip's orientation (w, x, y, z); all at zero
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gaik_core.kernels import conformal as c
from gaik_core.kernels import quaternion as q
from gaik_core.kernels.compiled import compiled

Array = NDArray[np.float64]

REVOLUTE, PRISMATIC = 0.0, 1.0
QUATERNION, CONFORMAL = 0, 1


@compiled
def axis_angles(axes: Array, couplings: Array, angles: Array, turned: Array) -> None:
    """Write each axis' angle: offset + C θ."""
    for i in range(axes.shape[0]):
        turned[i] = axes[i, 10]
    for k in range(couplings.shape[0]):
        turned[int(couplings[k, 0])] += couplings[k, 2] * angles[int(couplings[k, 1])]


@compiled
def by_quaternions(axes: Array, ends: Array, turned: Array, pose: Array, columns: Array) -> None:
    """Write the tip's pose (7,) and each axis' twist (6, n): sections 3.1 and 3.2, eqs. 23 and 39.

    Each link is rotated by the product of the quaternions before it; a column is the rotated axis crossed with what
    lies between it and the tip.
    """
    n = axes.shape[0]
    rotation = (1.0, 0.0, 0.0, 0.0)
    x, y, z = ends[0], ends[1], ends[2]
    for i in range(n):
        axis = (axes[i, 1], axes[i, 2], axes[i, 3])
        direction = q.rotate(rotation, axis)
        columns[0, i], columns[1, i], columns[2, i] = x, y, z
        columns[3, i], columns[4, i], columns[5, i] = direction
        if axes[i, 0] == REVOLUTE:
            rotation = q.multiply(rotation, q.from_axis_angle(axis, turned[i]))
        else:
            x, y, z = x + turned[i] * direction[0], y + turned[i] * direction[1], z + turned[i] * direction[2]
        link = q.rotate(rotation, (axes[i, 4], axes[i, 5], axes[i, 6]))
        x, y, z = x + link[0], y + link[1], z + link[2]
    for i in range(n):
        direction = (columns[3, i], columns[4, i], columns[5, i])
        if axes[i, 0] == REVOLUTE:
            arm = (x - columns[0, i], y - columns[1, i], z - columns[2, i])
            columns[0, i], columns[1, i], columns[2, i] = q.cross(direction, arm)
        else:
            columns[0, i], columns[1, i], columns[2, i] = direction
            columns[3, i], columns[4, i], columns[5, i] = 0.0, 0.0, 0.0
    pose[0], pose[1], pose[2] = x, y, z
    pose[3], pose[4], pose[5], pose[6] = q.multiply(rotation, (ends[6], ends[7], ends[8], ends[9]))


@compiled
def by_screw_rotors(axes: Array, ends: Array, turned: Array, pose: Array, columns: Array) -> None:
    """Write the tip's pose (7,) and each axis' twist (6, n): section 4, eqs. 50, 52 and 54.

    Each axis is a line, carried along by the screw rotors before it; a column is the tip's inner product with it.
    """
    n = axes.shape[0]
    motor = (1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for i in range(n):
        if axes[i, 0] == REVOLUTE:
            line = (axes[i, 1], axes[i, 2], axes[i, 3], axes[i, 7], axes[i, 8], axes[i, 9])
            step = c.screw_rotor(line, turned[i])
        else:
            line = (0.0, 0.0, 0.0, axes[i, 1], axes[i, 2], axes[i, 3])
            step = c.translator(line, turned[i])
        moved = c.move_line(motor, line)
        columns[3, i], columns[4, i], columns[5, i] = moved[0], moved[1], moved[2]
        columns[0, i], columns[1, i], columns[2, i] = moved[3], moved[4], moved[5]
        motor = c.multiply(motor, step)
    tip = c.move_point(motor, (ends[3], ends[4], ends[5]))
    for i in range(n):
        moved = (columns[3, i], columns[4, i], columns[5, i], columns[0, i], columns[1, i], columns[2, i])
        columns[0, i], columns[1, i], columns[2, i] = c.point_dot_line(tip, moved)
    pose[0], pose[1], pose[2] = tip
    turn = (motor[0], -motor[1], -motor[2], -motor[3])  # i, j, k are -e23, -e31, -e12
    pose[3], pose[4], pose[5], pose[6] = q.multiply(turn, (ends[6], ends[7], ends[8], ends[9]))


@compiled
def kinematics(
    algebra: int,
    axes: Array,
    couplings: Array,
    ends: Array,
    angles: Array,
    turned: Array,
    columns: Array,
    pose: Array,
    jacobian: Array,
) -> None:
    """Write the tip's pose (7,) and the Jacobian of all joints (6, d): metres above, radians below."""
    axis_angles(axes, couplings, angles, turned)
    if algebra == QUATERNION:
        by_quaternions(axes, ends, turned, pose, columns)
    else:
        by_screw_rotors(axes, ends, turned, pose, columns)
    jacobian[:] = 0.0
    for k in range(couplings.shape[0]):
        axis, joint, factor = int(couplings[k, 0]), int(couplings[k, 1]), couplings[k, 2]
        for row in range(6):
            jacobian[row, joint] += factor * columns[row, axis]


@compiled
def poses(algebra: int, axes: Array, couplings: Array, ends: Array, angles: Array, result: Array) -> None:
    """Write the tip's pose (m, 7) for each of m sets of angles (m, d)."""
    turned = np.empty(axes.shape[0])
    columns = np.empty((6, axes.shape[0]))
    for k in range(angles.shape[0]):
        axis_angles(axes, couplings, angles[k], turned)
        if algebra == QUATERNION:
            by_quaternions(axes, ends, turned, result[k], columns)
        else:
            by_screw_rotors(axes, ends, turned, result[k], columns)


@compiled
def joint_positions(axes: Array, couplings: Array, ends: Array, angles: Array, result: Array) -> None:
    """Write where each axis stands and, last, the tip (n + 1, 3)."""
    n = axes.shape[0]
    turned = np.empty(n)
    axis_angles(axes, couplings, angles, turned)
    rotation = (1.0, 0.0, 0.0, 0.0)
    x, y, z = ends[0], ends[1], ends[2]
    for i in range(n):
        result[i, 0], result[i, 1], result[i, 2] = x, y, z
        axis = (axes[i, 1], axes[i, 2], axes[i, 3])
        shift = (0.0, 0.0, 0.0)
        if axes[i, 0] == REVOLUTE:
            rotation = q.multiply(rotation, q.from_axis_angle(axis, turned[i]))
        else:
            shift = (turned[i] * axis[0], turned[i] * axis[1], turned[i] * axis[2])
        link = (shift[0] + axes[i, 4], shift[1] + axes[i, 5], shift[2] + axes[i, 6])
        moved = q.rotate(rotation, link)
        x, y, z = x + moved[0], y + moved[1], z + moved[2]
    result[n, 0], result[n, 1], result[n, 2] = x, y, z
