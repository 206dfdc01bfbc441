"""A chain as the arrays the kernels take (their columns are described in `gaik_core.kernels.kinematics` and `.limits`)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gaik_core.joint import Joint
from gaik_core.kernels.kinematics import PRISMATIC, REVOLUTE

Array = NDArray[np.float64]


class PackedChain(NamedTuple):
    """What the kernels need to know of a chain; read-only arrays."""

    axes: Array
    couplings: Array
    ends: Array
    limits: Array
    held: Array


def pack(joints: Sequence[Joint], origin: Array, orientation: Array) -> PackedChain:
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
    packed = PackedChain(
        axes=axes,
        couplings=couplings(joints, [joint.name for joint in active]),
        ends=np.concatenate([origin, point, orientation]),
        limits=np.array([[joint.lower for joint in active], [joint.upper for joint in active]]),
        held=np.array(held, dtype=float).reshape(-1, 3),
    )
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
