"""What a solve drives to zero: the error of the tip, and the Jacobian that belongs to it.

The loss is half the squared length of the error e; its gradient is -Jᵀ e exactly (eqs. 33 and 53), for each target:

    POSITION   p (3,)             e = p_d - p_f
    POINTING   p, d, a (9,)       below that w φ, φ the rotation vector that brings the tool axis a onto d
    POSE       p, quaternion (7,) below that w φ, φ the rotation vector from the tip's orientation to the target's

with w the weight in metres per radian.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from gaik_core.kernels import quaternion as q
from gaik_core.kernels.compiled import inlined

Array = NDArray[np.float64]

POSITION, POINTING, POSE = 0, 1, 2


@inlined
def task_rows(kind: int) -> int:
    """How many rows error and Jacobian have."""
    return 3 if kind == POSITION else 6


@inlined
def between(kind: int, begin: Array, end: Array, share: float, target: Array) -> None:
    """Write the target at a share of the way from one to another: straight, and turned the shorter way round."""
    nearer = 1.0
    if kind == POSE:
        cosine = begin[3] * end[3] + begin[4] * end[4] + begin[5] * end[5] + begin[6] * end[6]
        nearer = -1.0 if cosine < 0.0 else 1.0
    for k in range(end.shape[0]):
        start = begin[k] if k < 3 else nearer * begin[k]
        target[k] = start + share * (end[k] - start)
    if kind == POSE:
        make_unit(end, target, 3, 7)
    if kind == POINTING:
        make_unit(end, target, 3, 6)
        make_unit(end, target, 6, 9)


@inlined
def make_unit(end: Array, target: Array, first: int, last: int) -> None:
    """Scale a part of a target to length 1; between opposites, where there is none, take that of the end."""
    square = 0.0
    for k in range(first, last):
        square += target[k] * target[k]
    for k in range(first, last):
        target[k] = end[k] if square < 1e-12 else target[k] / math.sqrt(square)


@inlined
def turn_onto(tool: q.Vector, wanted: q.Vector) -> q.Vector:
    """The rotation vector that brings one unit vector onto another; from its opposite, about any axis across it."""
    axis = q.cross(tool, wanted)
    sine = math.sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2])
    cosine = tool[0] * wanted[0] + tool[1] * wanted[1] + tool[2] * wanted[2]
    if sine < 1e-12:
        if cosine > 0.0:
            return (0.0, 0.0, 0.0)
        across = q.cross(tool, (1.0, 0.0, 0.0)) if abs(tool[0]) < 0.9 else q.cross(tool, (0.0, 1.0, 0.0))
        norm = math.sqrt(across[0] * across[0] + across[1] * across[1] + across[2] * across[2])
        return (math.pi * across[0] / norm, math.pi * across[1] / norm, math.pi * across[2] / norm)
    scale = math.atan2(sine, cosine) / sine
    return (scale * axis[0], scale * axis[1], scale * axis[2])


@inlined
def tool_direction(pose: Array, target: Array) -> q.Vector:
    """The tool axis of a POINTING target where the tip now is."""
    orientation = (pose[3], pose[4], pose[5], pose[6])
    return q.rotate(orientation, (target[6], target[7], target[8]))


@inlined
def orientation_error(kind: int, target: Array, pose: Array) -> q.Vector:
    """The rotation vector φ from the tip's orientation to the target's."""
    if kind == POINTING:
        return turn_onto(tool_direction(pose, target), (target[3], target[4], target[5]))
    wanted = (target[3], target[4], target[5], target[6])
    return q.rotation_vector(q.multiply(wanted, q.conjugate((pose[3], pose[4], pose[5], pose[6]))))


@inlined
def measure(
    kind: int, weight: float, target: Array, pose: Array, jacobian: Array, error: Array
) -> tuple[float, float]:
    """Write the error, weigh the Jacobian's lower rows to match; the distance (m) and the angle (rad) left."""
    for row in range(3):
        error[row] = target[row] - pose[row]
    distance = math.sqrt(error[0] * error[0] + error[1] * error[1] + error[2] * error[2])
    if kind == POSITION:
        return distance, 0.0
    phi = orientation_error(kind, target, pose)
    for row in range(3):
        error[3 + row] = weight * phi[row]
    if kind == POINTING:
        remove_spin(tool_direction(pose, target), jacobian)
    for row in range(3, 6):
        for joint in range(jacobian.shape[1]):
            jacobian[row, joint] *= weight
    return distance, math.sqrt(phi[0] * phi[0] + phi[1] * phi[1] + phi[2] * phi[2])


@inlined
def remove_spin(tool: q.Vector, jacobian: Array) -> None:
    """Take out of the Jacobian the turning about the tool itself, which a POINTING target leaves free."""
    for joint in range(jacobian.shape[1]):
        spin = tool[0] * jacobian[3, joint] + tool[1] * jacobian[4, joint] + tool[2] * jacobian[5, joint]
        for row in range(3):
            jacobian[3 + row, joint] -= spin * tool[row]
