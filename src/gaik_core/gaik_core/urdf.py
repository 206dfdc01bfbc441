"""A kinematic chain out of a URDF: the joints between two links, as axes in the base link's frame at zero."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gaik_core import quaternion as q
from gaik_core.chain import KinematicChain
from gaik_core.joint import Joint, Kind, Vector
from gaik_core.urdf_reader import UrdfTree, listed

Array = NDArray[np.float64]

KINDS: dict[str, Kind] = {"revolute": "revolute", "continuous": "revolute", "prismatic": "prismatic"}


class Drive(NamedTuple):
    """What moves a joint: its angle is factor · (the value of the joint `value`) + offset."""

    value: str
    factor: float
    offset: float


class Axis(NamedTuple):
    """A joint that moves, where it stands in the base frame at zero (m), and its unit direction there."""

    joint: Any
    drive: Drive
    point: Array
    direction: Array


def chain_from_urdf(
    text_or_path: str | Path, base: str | None = None, tip: str | None = None, name: str | None = None
) -> KinematicChain:
    """The chain between two links of a URDF.

    Fixed joints become part of the links; revolute, continuous and prismatic joints become axes. A mimic joint is a
    passive axis that follows the joint it mimics, with its own limits as the axis' limits. Where the joint it mimics is
    not between the two links (the other finger of a gripper, say), that joint's value is a value of the chain all the
    same, under its own name and within its own limits. `home` is zero, moved into the limits. Soft limits, efforts and
    velocities are left out.

    Args:
        text_or_path: the URDF's text, or the path of a file. xacro must have been expanded.
        base: link whose frame is the chain's base frame; by default the link that has no parent.
        tip: link whose frame is the tip's; by default the only link below `base` that has no children.
        name: of the chain; by default the robot's.

    Raises:
        UrdfError: what is wrong, in one line.
    """
    tree = UrdfTree(text_or_path)
    base = tree.root if base is None else base
    tip = _only_leaf(tree, base) if tip is None else tip
    axes, tip_point, tip_turn = _lay_out(tree, tree.path(base, tip))
    if not axes:
        raise tree.error(f"no joint between {base!r} and {tip!r} can move")
    return KinematicChain(
        _joints(tree, axes, tip_point),
        name=tree.name if name is None else name,
        description=f"{base} to {tip}",
        origin=axes[0].point,
        orientation=tip_turn,
    )


def _only_leaf(tree: UrdfTree, base: str) -> str:
    leaves = tree.leaves(base)
    if len(leaves) != 1:
        raise tree.error(
            f"tip: below {base!r} {len(leaves)} links have no children; name one of {listed(leaves)}"
        )
    return leaves[0]


def _lay_out(tree: UrdfTree, path: Sequence[Any]) -> tuple[list[Axis], Array, Array]:
    """The axes along a path of joints, and where the last link stands and how it is turned; all at zero."""
    axes: list[Axis] = []
    point, turn = np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])
    for joint in path:
        shift, rotation = _origin(tree, joint)
        point = point + q.rotate(turn, shift)
        turn = q.multiply(turn, rotation)
        if joint.type == "fixed":
            continue
        direction = _direction(tree, joint)
        drive = _drive(tree, joint)
        if drive.factor != 0.0:
            axes.append(Axis(joint, drive, point, q.rotate(turn, direction)))
        elif KINDS[joint.type] == "revolute":  # a mimic joint that stands still at its offset
            turn = q.multiply(turn, q.from_axis_angle(direction, drive.offset))
        else:
            point = point + q.rotate(turn, drive.offset * direction)
    return axes, point, q.normalise(turn)


def _joints(tree: UrdfTree, axes: Sequence[Axis], tip: Array) -> list[Joint]:
    """The chain's joints: a value belongs to its own axis or, where that is not on the chain, to the first it moves."""
    own = {axis.drive.value: axis for axis in reversed(axes)}
    own.update({axis.joint.name: axis for axis in axes if axis.joint.name == axis.drive.value})
    homes = {value: _home(tree, value, axes) for value in own}
    ends = [axis.point for axis in axes[1:]] + [tip]
    joints = []
    for axis, end in zip(axes, ends, strict=True):
        value, factor, offset = axis.drive
        active, mimics = own[value] is axis, axis.joint.name != value
        lower, upper = _limits(tree, tree.joints[value]) if active else (-math.inf, math.inf)
        axis_lower, axis_upper = _limits(tree, axis.joint) if mimics else (-math.inf, math.inf)
        joints.append(
            Joint(
                name=value if active else axis.joint.name,
                axis=_vector(axis.direction),
                link=_vector(end - axis.point),
                kind=KINDS[axis.joint.type],
                coupling={value: factor - active} if mimics else {},
                passive=not active,
                offset=offset,
                lower=lower,
                upper=upper,
                axis_lower=axis_lower,
                axis_upper=axis_upper,
                home=homes[value] if active else 0.0,
            )
        )
    return joints


def _origin(tree: UrdfTree, joint: Any) -> tuple[Array, Array]:
    """Where a joint stands in its parent's frame: a vector and a quaternion (roll, pitch, yaw about fixed x, y, z)."""
    if joint.origin is None:
        return np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])
    shift = _numbers(tree, joint, "origin xyz", joint.origin.xyz)
    roll, pitch, yaw = (
        q.from_axis_angle(axis, angle)
        for axis, angle in zip(np.eye(3), _numbers(tree, joint, "origin rpy", joint.origin.rpy), strict=True)
    )
    return shift, q.multiply(yaw, q.multiply(pitch, roll))


def _direction(tree: UrdfTree, joint: Any) -> Array:
    """The unit vector of a joint's axis in its own frame."""
    if joint.type not in KINDS:
        kinds = ", ".join(["fixed", *KINDS])
        raise tree.error(
            f"joint {joint.name!r} is of type {joint.type!r}; between base and tip it may be {kinds}"
        )
    axis = _numbers(tree, joint, "axis", [1.0, 0.0, 0.0] if joint.axis is None else joint.axis)
    norm = float(np.linalg.norm(axis))
    if norm == 0.0:
        raise tree.error(
            f"joint {joint.name!r}: axis is {axis.tolist()}; expected a direction other than zero"
        )
    return axis / norm


def _drive(tree: UrdfTree, joint: Any) -> Drive:
    """What moves a joint: itself, or the joint it mimics."""
    mimic = joint.mimic
    if mimic is None:
        return Drive(joint.name, 1.0, 0.0)
    leader = tree.joints.get(mimic.joint)
    if leader is None or leader.type not in KINDS:
        what = "there is none" if leader is None else f"which is {leader.type}"
        raise tree.error(f"joint {joint.name!r} mimics joint {mimic.joint!r}; {what}")
    if leader.mimic is not None:
        raise tree.error(
            f"joint {joint.name!r} mimics {leader.name!r}, which itself mimics {leader.mimic.joint!r}; "
            "a mimic joint may follow only a joint that has a value of its own"
        )
    factor = 1.0 if mimic.multiplier is None else mimic.multiplier
    offset = 0.0 if mimic.offset is None else mimic.offset
    return Drive(leader.name, *_numbers(tree, joint, "mimic", [factor, offset], 2).tolist())


def _limits(tree: UrdfTree, joint: Any) -> tuple[float, float]:
    """The lowest and highest angle (rad) or travel (m) of a joint."""
    if joint.type == "continuous":
        return -math.inf, math.inf
    if joint.limit is None:
        free = ", or the type continuous" if joint.type == "revolute" else ""
        raise tree.error(f"joint {joint.name!r} is {joint.type} without <limit>; give it one{free}")
    lower, upper = float(joint.limit.lower), float(joint.limit.upper)
    if not lower <= upper or lower == math.inf or upper == -math.inf:
        raise tree.error(
            f"joint {joint.name!r}: limits are [{lower:g}, {upper:g}]; the lower must not be above the upper"
        )
    return lower, upper


def _home(tree: UrdfTree, value: str, axes: Sequence[Axis]) -> float:
    """Zero, moved into the limits of a value and of every axis it moves."""
    lower, upper = _limits(tree, tree.joints[value])
    for axis in axes:
        if axis.drive.value == value and axis.joint.name != value:
            ends = [(end - axis.drive.offset) / axis.drive.factor for end in _limits(tree, axis.joint)]
            lower, upper = max(lower, min(ends)), min(upper, max(ends))
    if lower > upper:
        raise tree.error(
            f"joint {value!r} and the joints that mimic it have no value within the limits of all"
        )
    return min(max(0.0, lower), upper)


def _numbers(tree: UrdfTree, joint: Any, what: str, values: Sequence[float], length: int = 3) -> Array:
    array = np.array(values, dtype=float)
    if array.shape != (length,) or not np.isfinite(array).all():
        raise tree.error(f"joint {joint.name!r}: {what} is {values}; expected {length} finite numbers")
    return array


def _vector(array: Array) -> Vector:
    x, y, z = array.tolist()
    return x, y, z
