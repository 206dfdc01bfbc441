"""The page as a whole, and how often which part of it is drawn."""

from __future__ import annotations

import numpy as np
import viser
from numpy.typing import NDArray

from gaik_core import KinematicChain
from gaik_ros.viewer.board import Board
from gaik_ros.viewer.controls import SuiteParameters
from gaik_ros.viewer.panel import Actions, Panel
from gaik_ros.viewer.picture import Picture
from gaik_ros.viewer.scene import Drag, Grab, Scene
from gaik_ros.viewer.server import address, start_server
from gaik_ros.viewer.urdf_shapes import UrdfShapes

Array = NDArray[np.float64]

# s: the arm is drawn at every step, the rest at these intervals
LINES, WORDS, PARAMETERS = 0.1, 0.25, 1.0


class Page:
    """Serves the page and draws on it; `step` is to be called regularly, by one thread."""

    def __init__(
        self,
        host: str,
        port: int,
        chain: KinematicChain,
        shapes: UrdfShapes | None,
        origin_frame: str,
        up: Array,
    ) -> None:
        """ValueError: no page can be served there, or chain and URDF do not fit together."""
        self.server: viser.ViserServer = start_server(host, port)
        try:
            self.scene = Scene(self.server, chain, shapes, origin_frame, up)
        except BaseException:
            self.server.stop()
            raise
        self._panel: Panel | None = None
        self._due = {LINES: 0.0, WORDS: 0.0, PARAMETERS: 0.0}

    @property
    def address(self) -> str:
        """Where the page is, for a browser."""
        return address(self.server)

    @property
    def visitors(self) -> int:
        """How many browsers show it."""
        return len(self.server.get_clients())

    def connect(
        self,
        title: str,
        actions: Actions,
        parameters: SuiteParameters,
        periods_of: str,
        grab: Grab,
        drag: Drag,
    ) -> None:
        """Add what users act by, once there is something to act on."""
        self._panel = Panel(self.server, title, actions, parameters, periods_of)
        self.scene.on_drag(grab, drag)

    def step(self, picture: Picture, board: Board, now: float) -> None:
        """Draw what is due; nothing while nobody looks."""
        if self._panel is None or not self.visitors:
            return
        with self.server.atomic():
            self.scene.draw(picture)
            if self._is_due(LINES, now):
                self.scene.draw_lines(picture)
            if self._is_due(WORDS, now):
                self._panel.show(picture, board, now)
            if self._is_due(PARAMETERS, now):
                self._panel.show_parameters()

    def _is_due(self, interval: float, now: float) -> bool:
        if now < self._due[interval]:
            return False
        self._due[interval] = now + interval
        return True

    def stop(self) -> None:
        """End the server."""
        self.server.stop()
