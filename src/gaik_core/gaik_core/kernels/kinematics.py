"""Forward kinematics and Jacobian of a chain, once by quaternions and once by screw rotors.

A chain comes as a tuple of arrays (made by `gaik_core.packing`), with n axes and d joints:

    axes (n, 11)       kind, direction u, link to the next axis, moment c × u, offset; as they stand at zero
    couplings (k, 3)   axis, joint, factor: the angle of an axis is its offset + the sum of factor · joint
    ends (12,)         first axis, tip, the tip's orientation (w, x, y, z), all at zero; nearest and furthest reach
    limits (2, d)      lowest and highest value of each joint; (2, 0) where no limit is to be held
    held (h, 3)        axis, lowest and highest angle, for the axes that have limits of their own

Kernels called inside a loop take the arrays one by one: unpacking the tuple counts references, which costs 70 ns.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gaik_core.kernels import conformal as c
from gaik_core.kernels import quaternion as q
from gaik_core.kernels.compiled import compiled, inlined

Array = NDArray[np.float64]
Chain = tuple[Array, Array, Array, Array, Array]

REVOLUTE, PRISMATIC = 0.0, 1.0
QUATERNION, CONFORMAL = 0, 1


@inlined
def axis_angles(axes: Array, couplings: Array, angles: Array, turned: Array) -> None:
    """Write each axis' angle: offset + C θ."""
    for i in range(axes.shape[0]):
        turned[i] = axes[i, 10]
    for k in range(couplings.shape[0]):
        turned[int(couplings[k, 0])] += couplings[k, 2] * angles[int(couplings[k, 1])]


@inlined
def by_quaternions(axes: Array, ends: Array, turned: Array, pose: Array, columns: Array) -> None:
    """Write the tip's pose (7,) and each axis' twist (n, 6): sections 3.1 and 3.2, eqs. 23 and 39.

    Each link is rotated by the product of the quaternions before it; a column is the rotated axis crossed with what
    lies between it and the tip.
    """
    n = axes.shape[0]
    rotation = (1.0, 0.0, 0.0, 0.0)
    x, y, z = ends[0], ends[1], ends[2]
    for i in range(n):
        axis = (axes[i, 1], axes[i, 2], axes[i, 3])
        direction = q.rotate(rotation, axis)
        columns[i, 0], columns[i, 1], columns[i, 2] = x, y, z
        columns[i, 3], columns[i, 4], columns[i, 5] = direction
        if axes[i, 0] == REVOLUTE:
            rotation = q.multiply(rotation, q.from_axis_angle(axis, turned[i]))
        else:
            x, y, z = x + turned[i] * direction[0], y + turned[i] * direction[1], z + turned[i] * direction[2]
        link = q.rotate(rotation, (axes[i, 4], axes[i, 5], axes[i, 6]))
        x, y, z = x + link[0], y + link[1], z + link[2]
    for i in range(n):
        direction = (columns[i, 3], columns[i, 4], columns[i, 5])
        if axes[i, 0] == REVOLUTE:
            arm = (x - columns[i, 0], y - columns[i, 1], z - columns[i, 2])
            columns[i, 0], columns[i, 1], columns[i, 2] = q.cross(direction, arm)
        else:
            columns[i, 0], columns[i, 1], columns[i, 2] = direction
            columns[i, 3], columns[i, 4], columns[i, 5] = 0.0, 0.0, 0.0
    pose[0], pose[1], pose[2] = x, y, z
    pose[3], pose[4], pose[5], pose[6] = q.multiply(rotation, (ends[6], ends[7], ends[8], ends[9]))


@inlined
def by_screw_rotors(axes: Array, ends: Array, turned: Array, pose: Array, columns: Array) -> None:
    """Write the tip's pose (7,) and each axis' twist (n, 6): section 4, eqs. 50, 52 and 54.

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
        columns[i, 3], columns[i, 4], columns[i, 5] = moved[0], moved[1], moved[2]
        columns[i, 0], columns[i, 1], columns[i, 2] = moved[3], moved[4], moved[5]
        motor = c.multiply(motor, step)
    tip = c.move_point(motor, (ends[3], ends[4], ends[5]))
    for i in range(n):
        moved = (columns[i, 3], columns[i, 4], columns[i, 5], columns[i, 0], columns[i, 1], columns[i, 2])
        columns[i, 0], columns[i, 1], columns[i, 2] = c.point_dot_line(tip, moved)
    pose[0], pose[1], pose[2] = tip
    turn = (motor[0], -motor[1], -motor[2], -motor[3])  # i, j, k are -e23, -e31, -e12
    pose[3], pose[4], pose[5], pose[6] = q.multiply(turn, (ends[6], ends[7], ends[8], ends[9]))


@inlined
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
    """Write the tip's pose (7,) and the joints' Jacobian: (3, d) of its position, or (6, d) with its turning below.

    `turned` (n,) and `columns` (n, 6) are workspace: the axes' angles and twists.
    """
    axis_angles(axes, couplings, angles, turned)
    if algebra == QUATERNION:
        by_quaternions(axes, ends, turned, pose, columns)
    else:
        by_screw_rotors(axes, ends, turned, pose, columns)
    for row in range(jacobian.shape[0]):
        for joint in range(jacobian.shape[1]):
            jacobian[row, joint] = 0.0
    for k in range(couplings.shape[0]):
        axis, joint, factor = int(couplings[k, 0]), int(couplings[k, 1]), couplings[k, 2]
        for row in range(jacobian.shape[0]):
            jacobian[row, joint] += factor * columns[axis, row]


@compiled
def poses(algebra: int, chain: Chain, angles: Array, result: Array) -> None:
    """Write the tip's pose (m, 7) for each of m sets of angles (m, d)."""
    axes, couplings, ends, _, _ = chain
    turned = np.empty(axes.shape[0])
    columns = np.empty((axes.shape[0], 6))
    for k in range(angles.shape[0]):
        axis_angles(axes, couplings, angles[k], turned)
        if algebra == QUATERNION:
            by_quaternions(axes, ends, turned, result[k], columns)
        else:
            by_screw_rotors(axes, ends, turned, result[k], columns)


@compiled
def joint_positions(chain: Chain, angles: Array, result: Array) -> None:
    """Write where each axis stands and, last, the tip (n + 1, 3)."""
    axes, couplings, ends, _, _ = chain
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
