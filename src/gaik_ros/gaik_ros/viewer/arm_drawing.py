"""The arm in the scene: from its URDF, or, where there is none, from the chain itself."""

from __future__ import annotations

from typing import Protocol

import numpy as np
import viser
from numpy.typing import NDArray

from gaik_core import KinematicChain
from gaik_core import quaternion as q
from gaik_ros.viewer.urdf_shapes import Colour, Link, Shape, UrdfShapes

Array = NDArray[np.float64]
Rgb = tuple[int, int, int]

STILL = 1e-6  # rad or m: a change below this is not drawn
LIGHT, DARK, RED = (200, 204, 210), (52, 56, 66), (204, 41, 36)


class ArmDrawing(Protocol):
    """An arm that can be moved."""

    def move(self, angles: Array) -> None:
        """Stand at joint values (dof,)."""

    def floor(self, points: Array, up: Array) -> Array:
        """A point (3,) of the plane that it stands on, given where its tip can be."""


def draw_arm(
    server: viser.ViserServer, chain: KinematicChain, shapes: UrdfShapes | None, origin_frame: str
) -> ArmDrawing:
    """Draw the arm at home; `origin_frame` is the URDF's link that is the scene's frame, the root where empty.

    ValueError: the URDF has not the chain's joints, or not that link.
    """
    if shapes is None:
        return ChainDrawing(server, chain)
    lacking = [name for name in chain.joint_names if name not in shapes.joint_names]
    if lacking:
        raise ValueError(f"the URDF has no joint {', '.join(lacking)}, which {chain.name} has")
    return UrdfDrawing(server, chain, shapes, origin_frame)


def up_of(shapes: UrdfShapes, origin_frame: str) -> Array:
    """The direction (3,) in `origin_frame` that is up in the URDF's root: its z axis, by REP-103."""
    _, turn = _origin(shapes, origin_frame)
    return q.rotate(q.conjugate(turn), np.array([0.0, 0.0, 1.0]))


def _origin(shapes: UrdfShapes, origin_frame: str) -> tuple[Array, Array]:
    if not origin_frame:
        return np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])
    return shapes.pose_in_root(origin_frame, {})


class UrdfDrawing:
    """The links as a tree of frames in the scene, so that a joint moves only its own frame."""

    def __init__(
        self, server: viser.ViserServer, chain: KinematicChain, shapes: UrdfShapes, origin_frame: str
    ) -> None:
        position, turn = _origin(shapes, origin_frame)
        back = q.conjugate(turn)
        self._root = -q.rotate(back, position)
        server.scene.add_frame("/arm", show_axes=False, position=self._root, wxyz=back)
        self._names = chain.joint_names
        self._drawn = np.full(chain.dof, np.nan)
        self._moving: list[tuple[Link, viser.FrameHandle]] = []
        paths = {"": "/arm"}
        for link in shapes.links:
            paths[link.name] = f"{paths[link.parent]}/{link.name}"
            at, turned = link.pose({})
            frame = server.scene.add_frame(paths[link.name], show_axes=False, position=at, wxyz=turned)
            if link.axis is not None:
                self._moving.append((link, frame))
            for number, shape in enumerate(link.shapes):
                _draw_shape(server, f"{paths[link.name]}/visual_{number}", shape)
        self.move(chain.home)

    def move(self, angles: Array) -> None:
        """Stand at joint values (dof,)."""
        if (np.abs(angles - self._drawn) < STILL).all():
            return
        self._drawn = np.array(angles)
        values = dict(zip(self._names, angles.tolist(), strict=True))
        for link, frame in self._moving:
            frame.position, frame.wxyz = link.pose(values)

    def floor(self, points: Array, up: Array) -> Array:
        """The root's origin: a URDF stands on its root's x-y plane."""
        return self._root


def _draw_shape(server: viser.ViserServer, name: str, shape: Shape) -> None:
    rgb, opacity = _rgb(shape.colour), (shape.colour[3] if shape.colour[3] < 1.0 else None)
    place = {"position": shape.position, "wxyz": shape.orientation}
    if shape.kind == "box":
        x, y, z = shape.size
        server.scene.add_box(name, rgb, (x, y, z), opacity=opacity, **place)
    elif shape.kind == "cylinder":
        radius, length = shape.size
        server.scene.add_cylinder(name, radius, length, rgb, opacity=opacity, **place)
    else:
        server.scene.add_icosphere(name, shape.size[0], rgb, subdivisions=4, opacity=opacity, **place)


def _rgb(colour: Colour) -> Rgb:
    red, green, blue = (round(255 * part) for part in colour[:3])
    return red, green, blue


class ChainDrawing:
    """Balls at the joints, a rod from each to the next, and the tip in red."""

    def __init__(self, server: viser.ViserServer, chain: KinematicChain) -> None:
        self._chain = chain
        self._drawn = np.full(chain.dof, np.nan)
        points = chain.frames(chain.home)
        lengths = np.linalg.norm(np.diff(points, axis=0), axis=-1)
        radius = 0.04 * float(lengths.max(initial=0.0)) or 0.005
        last = len(points) - 1
        self._balls = [
            server.scene.add_icosphere(
                f"/arm/ball_{number}",
                radius * (1.2 if number < last else 1.4),
                LIGHT if number < last else RED,
            )
            for number in range(len(points))
        ]
        self._rods = [
            server.scene.add_cylinder(f"/arm/rod_{number}", radius, 1.0, DARK)
            for number in range(len(lengths))
        ]
        self.move(chain.home)

    def move(self, angles: Array) -> None:
        """Stand at joint values (dof,)."""
        if (np.abs(angles - self._drawn) < STILL).all():
            return
        self._drawn = np.array(angles)
        points = self._chain.frames(angles)
        for ball, point in zip(self._balls, points, strict=True):
            ball.position = point
        for rod, start, end in zip(self._rods, points[:-1], points[1:], strict=True):
            length = float(np.linalg.norm(end - start))
            rod.visible = length > STILL
            rod.scale = (1.0, 1.0, length)
            rod.position, rod.wxyz = 0.5 * (start + end), z_turned_to(end - start)

    def floor(self, points: Array, up: Array) -> Array:
        """The lowest of where the tip can be and of where the first axis stands."""
        below = np.vstack([points, self._chain.frames(self._chain.home)[:1]])
        return up * float((below @ up).min())


def z_turned_to(direction: Array) -> Array:
    """A quaternion (4,) that turns the z axis to `direction` (3,); the identity for no direction."""
    length = float(np.linalg.norm(direction))
    if length == 0.0:
        return np.array([1.0, 0.0, 0.0, 0.0])
    x, y, z = direction / length
    if z < -1.0 + 1e-12:
        return np.array([0.0, 1.0, 0.0, 0.0])  # half a turn about x
    return q.normalise(np.array([1.0 + z, -y, x, 0.0]))
