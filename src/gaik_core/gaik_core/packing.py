"""A chain as the arrays the kernels take; their columns are described in `gaik_core.kernels.kinematics`."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from gaik_core.joint import Joint
from gaik_core.kernels.kinematics import PRISMATIC, REVOLUTE, Chain

Array = NDArray[np.float64]


def pack(joints: Sequence[Joint], origin: Array, orientation: Array) -> Chain:
    """Arrays of a chain that begins at `origin` and whose tip has `orientation` (w, x, y, z) at zero."""
    axes = np.zeros((len(joints), 11))
    point = origin.copy()
    for row, joint in zip(axes, joints, strict=True):
        row[0] = REVOLUTE if joint.kind == "revolute" else PRISMATIC
        row[1:4], row[4:7] = joint.axis, joint.link
        row[7:10] = np.cross(point, joint.axis)
        row[10] = joint.offset
        point = point + row[4:7]
    active = [joint for joint in joints if not joint.passive]
    held = [
        (i, joint.axis_lower, joint.axis_upper)
        for i, joint in enumerate(joints)
        if np.isfinite(joint.axis_lower) or np.isfinite(joint.axis_upper)
    ]
    names = [joint.name for joint in active]
    packed = (
        axes,
        couplings(joints, names),
        np.concatenate([origin, point, orientation, reach(joints)]),
        np.array([[joint.lower for joint in active], [joint.upper for joint in active]]),
        np.array(held, dtype=float).reshape(-1, 3),
    )
    return _read_only(packed)


def without_limits(packed: Chain) -> Chain:
    """The same chain with no limit to hold: any slide reaches as far as one likes."""
    axes, coupled, ends, _, _ = packed
    if (axes[:, 0] == PRISMATIC).any():
        ends = np.concatenate([ends[:10], (0.0, np.inf)])
    return _read_only((axes, coupled, ends, np.empty((2, 0)), np.empty((0, 3))))


def _read_only(packed: Chain) -> Chain:
    """The same arrays, of one type for the compiler, whether there are limits or not."""
    for array in packed:
        array.flags.writeable = False
    return packed


def couplings(joints: Sequence[Joint], names: Sequence[str]) -> Array:
    """(axis, joint, factor) for every factor of C that is not zero."""
    rows = []
    for axis, joint in enumerate(joints):
        if not joint.passive:
            rows.append((axis, names.index(joint.name), 1.0 + joint.coupling.get(joint.name, 0.0)))
        rows += [
            (axis, names.index(other), factor)
            for other, factor in joint.coupling.items()
            if joint.passive or other != joint.name
        ]
    return np.array(rows, dtype=float).reshape(-1, 3)


def reach(joints: Sequence[Joint]) -> tuple[float, float]:
    """Nearest and furthest the tip can be from the first axis, by the lengths of the links alone (m)."""
    lengths = [float(np.linalg.norm(joint.link)) for joint in joints]
    outer = sum(lengths) + sum(travel(joint) for joint in joints if joint.kind == "prismatic")
    return max(0.0, 2.0 * max(lengths) - outer) if np.isfinite(outer) else 0.0, outer


def travel(joint: Joint) -> float:
    """The furthest a prismatic joint moves either way (m)."""
    low, high = joint.axis_lower, joint.axis_upper
    if not joint.passive and not joint.coupling:
        low, high = max(low, joint.lower + joint.offset), min(high, joint.upper + joint.offset)
    return max(abs(low), abs(high))
