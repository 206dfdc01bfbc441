"""Keeping the angles inside the limits: of each joint, and of each axis whose angle several joints share.

limits (2, d)      lowest and highest value of each joint
held (h, 3)        axis, lowest and highest angle, for the axes that have such limits
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gaik_core.kernels.compiled import compiled, inlined

Array = NDArray[np.float64]

SWEEPS, START_SWEEPS = 20, 10_000
"""Rounds over the held axes before a projection gives up: of an update, and of a start, which has no way back.

One is enough unless axes share joints.
"""

OVER = 1.5
"""How many times the way to its limit each round after SWEEPS turns an axis: narrow corners take many rounds else."""

MARGIN = 1e-12
"""An axis within this of its limit (rad) is on it: rounding of a sum of two angles."""


@inlined
def axis_angle(axis: int, axes: Array, couplings: Array, angles: Array) -> float:
    """Offset + C θ of one axis."""
    total = axes[axis, 10]
    for k in range(couplings.shape[0]):
        if int(couplings[k, 0]) == axis:
            total += couplings[k, 2] * angles[int(couplings[k, 1])]
    return float(total)


@inlined
def turn_axis(axis: int, by: float, couplings: Array, limits: Array, angles: Array) -> None:
    """Turn one axis by an angle: move each of its joints by as little as does it, without crossing its own limit."""
    for _ in range(couplings.shape[0]):
        square = 0.0
        for k in range(couplings.shape[0]):
            if int(couplings[k, 0]) == axis and has_room(
                by * couplings[k, 2], int(couplings[k, 1]), limits, angles
            ):
                square += couplings[k, 2] * couplings[k, 2]
        if square == 0.0 or by == 0.0:
            return
        turned = 0.0
        for k in range(couplings.shape[0]):
            joint, factor = int(couplings[k, 1]), couplings[k, 2]
            if int(couplings[k, 0]) == axis and has_room(by * factor, joint, limits, angles):
                before = angles[joint]
                angles[joint] = min(max(before + by * factor / square, limits[0, joint]), limits[1, joint])
                turned += factor * (angles[joint] - before)
        by -= turned


@inlined
def has_room(by: float, joint: int, limits: Array, angles: Array) -> bool:
    """Whether a joint can move the way of `by` at all."""
    return bool(angles[joint] < limits[1, joint] if by > 0.0 else angles[joint] > limits[0, joint])


@inlined
def axis_normal(axis: int, couplings: Array, normal: Array) -> None:
    """Write the direction in joint space that turns one axis: its row of C."""
    for j in range(normal.shape[0]):
        normal[j] = 0.0
    for k in range(couplings.shape[0]):
        if int(couplings[k, 0]) == axis:
            normal[int(couplings[k, 1])] += couplings[k, 2]


@inlined
def clamp_joints(limits: Array, angles: Array) -> None:
    """Move each joint onto the limit it has crossed."""
    for j in range(angles.shape[0]):
        angles[j] = min(max(angles[j], limits[0, j]), limits[1, j])


@inlined
def axes_hold(axes: Array, couplings: Array, held: Array, angles: Array) -> bool:
    """Whether every held axis is inside its limits."""
    for h in range(held.shape[0]):
        angle = axis_angle(int(held[h, 0]), axes, couplings, angles)
        if angle < held[h, 1] - MARGIN or angle > held[h, 2] + MARGIN:
            return False
    return True


@inlined
def project_axes(
    axes: Array, couplings: Array, limits: Array, held: Array, sweeps: int, angles: Array
) -> bool:
    """Turn each held axis into its limits, with no joint crossing its own; whether that succeeds."""
    for sweep in range(sweeps):
        if axes_hold(axes, couplings, held, angles):
            return True
        over = 1.0 if sweep < SWEEPS else OVER
        for h in range(held.shape[0]):
            axis = int(held[h, 0])
            angle = axis_angle(axis, axes, couplings, angles)
            by = min(max(angle, held[h, 1]), held[h, 2]) - angle
            turn_axis(axis, over * by, couplings, limits, angles)
    return axes_hold(axes, couplings, held, angles)


@inlined
def move_inside(axes: Array, couplings: Array, limits: Array, held: Array, angles: Array) -> bool:
    """Move angles inside the limits of joints and axes; whether that succeeds."""
    clamp_joints(limits, angles)
    return project_axes(axes, couplings, limits, held, START_SWEEPS, angles)


@inlined
def hold_axes(
    axes: Array, couplings: Array, limits: Array, held: Array, previous: Array, angles: Array
) -> None:
    """Keep an update inside the limits of the axes: projected, or cut short of the first it would cross.

    `previous` is inside; the limits are convex, so what lies between it and an update can be kept.
    """
    if project_axes(axes, couplings, limits, held, SWEEPS, angles):
        return
    share = 1.0
    for h in range(held.shape[0]):
        axis = int(held[h, 0])
        begin, end = axis_angle(axis, axes, couplings, previous), axis_angle(axis, axes, couplings, angles)
        if end > held[h, 2] and end > begin:
            share = min(share, max(0.0, (held[h, 2] - begin) / (end - begin)))
        elif end < held[h, 1] and end < begin:
            share = min(share, max(0.0, (held[h, 1] - begin) / (end - begin)))
    for j in range(angles.shape[0]):
        angles[j] = previous[j] + share * (angles[j] - previous[j])


@compiled
def can_hold(axes: Array, couplings: Array, limits: Array, held: Array, angles: Array) -> bool:
    """`move_inside`, for callers from Python."""
    return move_inside(axes, couplings, limits, held, angles)


@inlined
def blocked_joints(limits: Array, angles: Array, error: Array, jacobian: Array) -> int:
    """Take out of the Jacobian the joints that stand on a limit and would descend through it; how many they are."""
    blocked = 0
    for j in range(angles.shape[0]):
        if limits[0, j] < angles[j] < limits[1, j]:
            continue
        down = 0.0
        for row in range(error.shape[0]):
            down += jacobian[row, j] * error[row]
        if (angles[j] <= limits[0, j] and down < 0.0) or (angles[j] >= limits[1, j] and down > 0.0):
            for row in range(error.shape[0]):
                jacobian[row, j] = 0.0
            blocked += 1
    return blocked


@inlined
def blocked_axes(
    axes: Array,
    couplings: Array,
    held: Array,
    angles: Array,
    error: Array,
    jacobian: Array,
    normal: Array,
) -> int:
    """Likewise for held axes: take out the motion that would turn such an axis further; `normal` (d,) is workspace."""
    blocked = 0
    for h in range(held.shape[0]):
        axis = int(held[h, 0])
        angle = axis_angle(axis, axes, couplings, angles)
        if held[h, 1] + MARGIN < angle < held[h, 2] - MARGIN:
            continue
        axis_normal(axis, couplings, normal)
        turning = 0.0
        for row in range(error.shape[0]):
            for j in range(angles.shape[0]):
                turning += jacobian[row, j] * normal[j] * error[row]
        if (angle <= held[h, 1] + MARGIN and turning < 0.0) or (
            angle >= held[h, 2] - MARGIN and turning > 0.0
        ):
            remove_direction(normal, jacobian)
            blocked += 1
    return blocked


@inlined
def remove_direction(normal: Array, jacobian: Array) -> None:
    """J ← J (I - n nᵀ / nᵀ n)."""
    square = 0.0
    for j in range(normal.shape[0]):
        square += normal[j] * normal[j]
    for row in range(jacobian.shape[0]):
        along = 0.0
        for j in range(normal.shape[0]):
            along += jacobian[row, j] * normal[j]
        for j in range(normal.shape[0]):
            jacobian[row, j] -= along * normal[j] / square
