"""What a solve can be asked for: a position, a position with a tool direction, or a full pose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gaik_core.checks import copied_vector, finite_vector, unit_vector
from gaik_core.kernels.task import POINTING, POSE, POSITION
from gaik_core.versors import Motor, Orientation, unit_quaternion

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Pointing:
    """The tip at a position with an axis of the tool along a direction; turning about that axis is free.

    Attributes:
        position: (3,) in m, in the base frame.
        direction: (3,) in the base frame; made a unit vector.
        tool_axis: (3,) in the tip frame; made a unit vector.
    """

    position: ArrayLike
    direction: ArrayLike
    tool_axis: ArrayLike = (0.0, 0.0, 1.0)

    def packed(self) -> Array:
        """The nine numbers the kernels take."""
        return np.concatenate(
            [
                finite_vector("position", self.position, 3),
                unit_vector("direction", self.direction, 3),
                unit_vector("tool_axis", self.tool_axis, 3),
            ]
        )


@dataclass(frozen=True, eq=False)
class Pose:
    """The tip frame at a position with an orientation.

    Attributes:
        position: (3,) in m, in the base frame.
        orientation: (4,) quaternion (w, x, y, z) from the tip frame to the base frame, a Quaternion or a Rotor; made a
            unit quaternion.
    """

    position: ArrayLike
    orientation: Orientation = (1.0, 0.0, 0.0, 0.0)

    def packed(self) -> Array:
        """The seven numbers the kernels take."""
        return np.concatenate(
            [
                finite_vector("position", self.position, 3),
                unit_quaternion("orientation", self.orientation),
            ]
        )


_FRAMES = (Pointing, Pose, Motor)
Target = ArrayLike | Pointing | Pose | Motor


def pack_target(target: Target) -> tuple[int, Array]:
    """The kernels' number of the kind of target, and its numbers; raises ShapeError or NotFiniteError."""
    if type(target) is np.ndarray or not isinstance(target, _FRAMES):
        return POSITION, copied_vector("target", target, 3)
    if isinstance(target, Pointing):
        return POINTING, target.packed()
    if isinstance(target, Motor):
        target = Pose(target.translation, target.rotation)
    return POSE, target.packed()
