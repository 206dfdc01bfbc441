"""The 3D part of the page, in the frame in which setpoints are given."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import viser
from numpy.typing import NDArray

from gaik_core import KinematicChain
from gaik_core.workspace import Workspace, find_workspace
from gaik_ros.viewer.arm_drawing import draw_arm, up_of, z_turned_to
from gaik_ros.viewer.picture import Picture
from gaik_ros.viewer.surface import surface_of
from gaik_ros.viewer.trail import Trail
from gaik_ros.viewer.urdf_shapes import UrdfShapes

Array = NDArray[np.float64]

DESIRED, FOLLOWED = (31, 119, 180), (255, 127, 14)
GOOD, BAD = (34, 160, 84), (224, 122, 16)
VOLUME = (120, 160, 220)
CELLS, SAMPLES = 56, 100_000  # enough to look at, in a fraction of a second
MOVED = 1e-5  # m: a setpoint that moved less is not drawn anew

Grab = Callable[[], None]
Drag = Callable[[Array], None]


class Scene:
    """The arm, both paths, the reachable workspace and the ball that is dragged."""

    def __init__(
        self,
        server: viser.ViserServer,
        chain: KinematicChain,
        shapes: UrdfShapes | None,
        origin_frame: str,
        up: Array,
    ) -> None:
        """`up` (3,) is the direction up where there is no URDF to tell. ValueError: URDF and chain do not fit."""
        self._server = server
        up = up if shapes is None else up_of(shapes, origin_frame)
        self.arm = draw_arm(server, chain, shapes, origin_frame)
        server.scene.set_up_direction(up)
        workspace = find_workspace(chain, CELLS, SAMPLES)
        self._size = float(np.linalg.norm(workspace.upper - workspace.lower))
        self._draw_workspace(workspace)
        self._draw_surroundings(self.arm.floor(workspace.tips, up), up)
        self._lines = {
            name: server.scene.add_line_segments(
                f"/{name}", np.zeros((0, 2, 3)), colour, thickness=thickness, thickness_units="screen"
            )
            for name, colour, thickness in (("desired", DESIRED, 3.0), ("followed", FOLLOWED, 2.5))
        }
        self._versions = {"desired": -1, "followed": -1}
        self._handle = _Handle(server, self._size, chain.forward(chain.home))
        self._miss = server.scene.add_line_segments(
            "/miss", np.zeros((0, 2, 3)), BAD, thickness=1.5, thickness_units="screen"
        )
        self._look(0.5 * (workspace.lower + workspace.upper), up)

    def on_drag(self, grab: Grab, drag: Drag) -> None:
        """Call `drag` with each position (3,) m of the ball while it is held, and `grab` after the first."""
        self._handle.on_drag(grab, drag)

    def draw(self, picture: Picture) -> None:
        """Draw what moves often."""
        self.arm.move(picture.angles)
        self._handle.follow(picture.setpoint if picture.setpoint is not None else picture.tip)

    def draw_lines(self, picture: Picture) -> None:
        """Draw what is larger and may lag a little."""
        self._draw_trail("desired", picture.desired)
        self._draw_trail("followed", picture.followed)
        self._handle.colour(GOOD if picture.verdict.good else BAD)
        miss = picture.nearest is not None and picture.setpoint is not None
        self._miss.points = np.array([[picture.setpoint, picture.nearest]]) if miss else np.zeros((0, 2, 3))

    def _draw_trail(self, name: str, trail: Trail) -> None:
        if trail.version != self._versions[name]:
            self._versions[name] = trail.version
            self._lines[name].points = trail.segments()

    def show_workspace(self, shown: bool) -> None:
        """Show or hide the reachable workspace."""
        if self._volume is not None:
            self._volume.visible = shown

    def _draw_workspace(self, workspace: Workspace) -> None:
        vertices, faces = surface_of(workspace)
        self._volume: Any = None
        if len(faces):
            self._volume = self._server.scene.add_mesh_simple(
                "/workspace",
                vertices,
                faces,
                color=VOLUME,
                opacity=0.13,
                side="double",
                cast_shadow=False,
                receive_shadow=False,
            )

    def _draw_surroundings(self, floor: Array, up: Array) -> None:
        """A grid through the point `floor`, and the axes of the frame."""
        scene, cell = self._server.scene, 10.0 ** math.floor(math.log10(self._size / 2.0))
        scene.add_grid(
            "/grid",
            width=20.0 * cell,
            height=20.0 * cell,
            cell_size=cell,
            section_size=5.0 * cell,
            cell_color=(214, 218, 224),
            section_color=(186, 192, 200),
            fade_distance=4.0 * self._size,
            fade_from="origin",
            position=floor,
            wxyz=z_turned_to(up),
        )
        length = 0.09 * self._size
        scene.add_frame("/axes", axes_length=length, axes_radius=0.02 * length, origin_radius=0.04 * length)
        for name, direction in zip("xyz", np.eye(3), strict=True):
            scene.add_label(f"/axes/{name}", name, position=1.2 * length * direction, anchor="center-center")

    def _look(self, centre: Array, up: Array) -> None:
        """The view that the page opens with: the frame's x to the right, from its left and a little above."""
        right = np.eye(3)[0 if abs(up[0]) < 0.9 else 1]
        toward = np.cross(right, up)
        camera = self._server.initial_camera
        camera.position = centre + self._size * (-0.46 * right + 0.26 * up + 0.74 * toward)
        camera.look_at = centre
        camera.fov = math.radians(45.0)


class _Handle:
    """A ball, dragged in the plane of the screen, in a cross of arrows, dragged along each axis."""

    def __init__(self, server: viser.ViserServer, size: float, position: Array) -> None:
        self._cross = server.scene.add_transform_controls(
            "/setpoint",
            scale=0.14 * size,
            disable_rotations=True,
            depth_test=False,
            line_width=2.5,
            position=position,
        )
        self._ball = server.scene.add_icosphere("/setpoint/ball", 0.024 * size, GOOD)
        self._held = False
        self._grip = np.zeros(3)  # from where the ball was taken to its centre

    def on_drag(self, grab: Grab, drag: Drag) -> None:
        def moved(event: Any, position: Array) -> None:
            self._held = event.phase != "end"
            drag(position)
            if event.phase == "start":
                grab()

        # Asynchronous ones are called in order.
        @self._cross.on_update
        async def _(event: viser.TransformControlsEvent) -> None:
            moved(event, np.array(self._cross.position))

        @self._ball.on_drag
        async def _(event: viser.SceneNodeDragEvent[Any]) -> None:
            if event.phase == "start":
                self._grip = np.array(self._cross.position) - np.array(event.start_position)
            position = np.array(event.end_position) + self._grip
            self._cross.position = position
            moved(event, position)

    def follow(self, position: Array) -> None:
        """Go to `position` (3,) m, unless it is held."""
        if not self._held and np.abs(position - self._cross.position).max() > MOVED:
            self._cross.position = position

    def colour(self, rgb: tuple[int, int, int]) -> None:
        self._ball.color = rgb
