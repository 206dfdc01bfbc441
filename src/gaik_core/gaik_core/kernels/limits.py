"""Keeping the angles inside the limits: of each joint, and of each axis whose angle several joints share.

limits (2, d)      lowest and highest value of each joint
held (h, 3)        axis, lowest and highest angle, for the axes that have such limits
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gaik_core.kernels.compiled import compiled

Array = NDArray[np.float64]

SWEEPS = 20
MARGIN = 1e-12
"""An axis within this of its limit (rad) is on it: rounding of a sum of two angles."""


@compiled
def axis_angle(axis: int, axes: Array, couplings: Array, angles: Array) -> float:
    """Offset + C θ of one axis."""
    total = axes[axis, 10]
    for k in range(couplings.shape[0]):
        if int(couplings[k, 0]) == axis:
            total += couplings[k, 2] * angles[int(couplings[k, 1])]
    return float(total)


@compiled
def turn_axis(axis: int, by: float, couplings: Array, angles: Array) -> None:
    """Move the joints by as little as turns one axis by an angle."""
    square = 0.0
    for k in range(couplings.shape[0]):
        if int(couplings[k, 0]) == axis:
            square += couplings[k, 2] * couplings[k, 2]
    for k in range(couplings.shape[0]):
        if int(couplings[k, 0]) == axis:
            angles[int(couplings[k, 1])] += by * couplings[k, 2] / square


@compiled
def clamp_joints(limits: Array, angles: Array) -> None:
    """Move each joint onto the limit it has crossed."""
    for j in range(angles.shape[0]):
        angles[j] = min(max(angles[j], limits[0, j]), limits[1, j])


@compiled
def axes_hold(axes: Array, couplings: Array, held: Array, angles: Array) -> bool:
    """Whether every held axis is inside its limits."""
    for h in range(held.shape[0]):
        angle = axis_angle(int(held[h, 0]), axes, couplings, angles)
        if angle < held[h, 1] - MARGIN or angle > held[h, 2] + MARGIN:
            return False
    return True


@compiled
def project(axes: Array, couplings: Array, limits: Array, held: Array, angles: Array) -> bool:
    """Move the angles into the limits by projection onto each in turn; whether that succeeded."""
    clamp_joints(limits, angles)
    for _ in range(SWEEPS):
        if axes_hold(axes, couplings, held, angles):
            return True
        for h in range(held.shape[0]):
            axis = int(held[h, 0])
            angle = axis_angle(axis, axes, couplings, angles)
            turn_axis(axis, min(max(angle, held[h, 1]), held[h, 2]) - angle, couplings, angles)
        clamp_joints(limits, angles)
    return axes_hold(axes, couplings, held, angles)


@compiled
def hold(axes: Array, couplings: Array, limits: Array, held: Array, previous: Array, angles: Array) -> None:
    """Keep an update inside the limits: projected, or cut short of the first limit it would cross.

    `previous` is inside; the limits are convex, so what lies between it and an update can be kept.
    """
    if project(axes, couplings, limits, held, angles):
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
            jacobian[:, j] = 0.0
            blocked += 1
    return blocked


@compiled
def blocked_axes(
    axes: Array, couplings: Array, held: Array, angles: Array, error: Array, jacobian: Array
) -> int:
    """Likewise for held axes: take out the motion of the joints that would turn such an axis further."""
    blocked = 0
    normal = np.zeros(angles.shape[0])
    for h in range(held.shape[0]):
        axis = int(held[h, 0])
        angle = axis_angle(axis, axes, couplings, angles)
        if held[h, 1] + MARGIN < angle < held[h, 2] - MARGIN:
            continue
        normal[:] = 0.0
        turn_axis(axis, 1.0, couplings, normal)
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


@compiled
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
