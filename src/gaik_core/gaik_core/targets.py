"""What a solve can be asked for: a position, a position with a tool direction, or a full pose."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gaik_core.checks import copied_vector, finite, finite_vector, rows, unit_vector
from gaik_core.errors import GaikError
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
Targets = ArrayLike | Sequence[Pointing] | Sequence[Pose] | Sequence[Motor] | Motor
"""Positions (m, 3), an array of motors, or a sequence of targets of one kind."""


def pack_target(target: Target) -> tuple[int, Array]:
    """The kernels' number of the kind of target, and its numbers; raises ShapeError or NotFiniteError."""
    if type(target) is np.ndarray or not isinstance(target, _FRAMES):
        return POSITION, copied_vector("target", target, 3)
    if isinstance(target, Pointing):
        return POINTING, target.packed()
    if isinstance(target, Motor):
        target = Pose(target.translation, target.rotation)
    return POSE, target.packed()


_KINDS = {POSITION: "positions", POINTING: "Pointings", POSE: "Poses or Motors"}


def pack_targets(targets: Targets) -> tuple[int, Array]:
    """The kernels' number of the kind that all targets are of, and their numbers (m, ·).

    Raises GaikError where they are not of one kind, and what is wrong with which.
    """
    many: Any = targets
    motors = isinstance(many, Motor) and many.shape != ()
    if isinstance(many, _FRAMES) and not motors:
        raise GaikError(f"targets is one {type(many).__name__}; expected a sequence of them")
    frames = isinstance(many, list | tuple) and any(isinstance(target, _FRAMES) for target in many)
    if not (motors or frames):
        return POSITION, rows("targets", many, 3)
    packed = [_pack_one_of_many(number, target) for number, target in enumerate(many)]
    kinds = sorted({kind for kind, _ in packed}) or [POSE]
    if len(kinds) > 1:
        raise GaikError(f"targets are {' and '.join(_KINDS[kind] for kind in kinds)}; expected one kind")
    return kinds[0], np.array([numbers for _, numbers in packed]).reshape(len(packed), -1)


def _pack_one_of_many(number: int, target: Target) -> tuple[int, Array]:
    try:
        kind, numbers = pack_target(target)
        return kind, finite("target", numbers)
    except GaikError as reason:
        raise GaikError(f"targets[{number}]: {reason}") from None
