"""What a URDF looks like: its links as a tree of frames, each with the boxes, cylinders and spheres it consists of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from gaik_core import quaternion as q
from gaik_core.errors import UrdfError
from gaik_core.urdf_reader import UrdfTree

Array = NDArray[np.float64]
Colour = tuple[float, float, float, float]

GREY: Colour = (0.6, 0.6, 0.62, 1.0)
PARTS = {"box": 3, "cylinder": 2, "sphere": 1}
"""The geometries that are drawn, and how many numbers give their size. Meshes are passed over."""


@dataclass(frozen=True, eq=False)
class Shape:
    """A solid in its link's frame."""

    kind: Literal["box", "cylinder", "sphere"]
    size: tuple[float, ...]  # m: edges x, y, z; radius and length along z; radius
    position: Array  # (3,) m
    orientation: Array  # (4,) unit quaternion, w first
    colour: Colour  # red, green, blue, opacity, each 0 to 1


@dataclass(frozen=True, eq=False)
class Link:
    """A link, its shapes, and how it hangs from its parent."""

    name: str
    parent: str  # empty for the root
    shapes: tuple[Shape, ...]
    position: Array  # (3,) m, in the parent's frame with the joint at zero
    orientation: Array  # (4,)
    axis: Array | None = None  # (3,) of its joint; None where the joint is fixed
    slides: bool = False  # along the axis, instead of turning about it
    value: str = ""  # the joint whose value moves it: its own, or the one it mimics
    factor: float = 1.0
    offset: float = 0.0

    def pose(self, values: Mapping[str, float]) -> tuple[Array, Array]:
        """Position (3,) and orientation (4,) in the parent's frame; a joint without a value stands at zero."""
        if self.axis is None:
            return self.position, self.orientation
        value = self.factor * values.get(self.value, 0.0) + self.offset
        if self.slides:
            return self.position + q.rotate(self.orientation, value * self.axis), self.orientation
        return self.position, q.multiply(self.orientation, q.from_axis_angle(self.axis, value))


class UrdfShapes:
    """The links of a URDF, given as text or as the path of a file; parents come before their children."""

    def __init__(self, text_or_path: str | Path) -> None:
        """Raises UrdfError, in one line, for what is no URDF."""
        self._tree = UrdfTree(text_or_path)
        root = _element(text_or_path)
        visuals = {link.get("name", ""): link.findall("visual") for link in root.findall("link")}
        colours = {
            material.get("name", ""): colour
            for material in root.iter("material")
            if (colour := _rgba(material)) is not None
        }
        above = {joint.child: joint for joint in self._tree.joints.values()}
        self.links: tuple[Link, ...] = tuple(
            self._link(name, above.get(name), _shapes(visuals[name], colours)) for name in self._in_order()
        )

    @property
    def joint_names(self) -> set[str]:
        """The joints that have a value of their own."""
        return {link.value for link in self.links if link.value}

    def pose_in_root(self, name: str, values: Mapping[str, float]) -> tuple[Array, Array]:
        """Position (3,) and orientation (4,) of a link in the root's frame. UrdfError: there is no such link."""
        self._tree.check_link("link", name)
        by_name = {link.name: link for link in self.links}
        position, orientation = np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])
        while name:
            shift, turn = by_name[name].pose(values)
            position, orientation = shift + q.rotate(turn, position), q.multiply(turn, orientation)
            name = by_name[name].parent
        return position, orientation

    def _in_order(self) -> list[str]:
        order = [self._tree.root]
        for name in order:  # grows while it is walked
            order += [joint.child for joint in self._tree.joints.values() if joint.parent == name]
        return order

    def _link(self, name: str, joint: Any, shapes: tuple[Shape, ...]) -> Link:
        if joint is None:
            return Link(name, "", shapes, np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]))
        origin = (None, None) if joint.origin is None else (joint.origin.xyz, joint.origin.rpy)
        position, orientation = _pose(*origin)
        if joint.type not in ("revolute", "continuous", "prismatic"):
            return Link(name, joint.parent, shapes, position, orientation)
        axis = np.array([1.0, 0.0, 0.0] if joint.axis is None else joint.axis, dtype=float)
        mimic = joint.mimic
        drive = (joint.name, 1.0, 0.0)
        if mimic is not None:
            drive = (mimic.joint, 1.0 if mimic.multiplier is None else mimic.multiplier, mimic.offset or 0.0)
        length = float(np.linalg.norm(axis))
        if length == 0.0:
            raise self._tree.error(f"joint {joint.name!r}: axis is zero; expected a direction")
        return Link(
            name,
            joint.parent,
            shapes,
            position,
            orientation,
            axis / length,
            joint.type == "prismatic",
            *drive,
        )


def _element(text_or_path: str | Path) -> ElementTree.Element:
    if isinstance(text_or_path, str) and "<" in text_or_path:
        return ElementTree.fromstring(text_or_path)
    return ElementTree.fromstring(Path(text_or_path).read_bytes())


def _shapes(visuals: list[ElementTree.Element], colours: Mapping[str, Colour]) -> tuple[Shape, ...]:
    return tuple(shape for visual in visuals if (shape := _shape(visual, colours)) is not None)


def _shape(visual: ElementTree.Element, colours: Mapping[str, Colour]) -> Shape | None:
    solid = next((part for kind in PARTS for part in visual.findall(f"geometry/{kind}")), None)
    if solid is None:
        return None
    attributes = {"box": ("size",), "cylinder": ("radius", "length"), "sphere": ("radius",)}[solid.tag]
    size = tuple(number for name in attributes for number in _numbers(solid.get(name, "")))
    if len(size) != PARTS[solid.tag]:
        raise UrdfError(
            f"URDF: a {solid.tag} has {len(size)} numbers for its size; expected {PARTS[solid.tag]}"
        )
    origin, material = visual.find("origin"), visual.find("material")
    xyz, rpy = (None, None) if origin is None else (origin.get("xyz"), origin.get("rpy"))
    position, orientation = _pose(_numbers(xyz or "") or None, _numbers(rpy or "") or None)
    colour = GREY
    if material is not None:
        colour = _rgba(material) or colours.get(material.get("name", ""), GREY)
    return Shape(solid.tag, size, position, orientation, colour)  # type: ignore[arg-type]


def _pose(xyz: Any, rpy: Any) -> tuple[Array, Array]:
    """A URDF origin: a shift, and turns by roll, pitch and yaw about the fixed axes x, y and z."""
    turn = np.array([1.0, 0.0, 0.0, 0.0])
    for axis, angle in zip(np.eye(3), rpy or (0.0, 0.0, 0.0), strict=True):
        turn = q.multiply(q.from_axis_angle(axis, angle), turn)
    return np.array(xyz or (0.0, 0.0, 0.0), dtype=float), turn


def _rgba(material: ElementTree.Element) -> Colour | None:
    colour = material.find("color")
    numbers = [] if colour is None else _numbers(colour.get("rgba", ""))
    return (numbers[0], numbers[1], numbers[2], numbers[3]) if len(numbers) == 4 else None


def _numbers(text: str) -> list[float]:
    try:
        return [float(word) for word in text.split()]
    except ValueError:
        raise UrdfError(f"URDF: {text!r}; expected numbers") from None
