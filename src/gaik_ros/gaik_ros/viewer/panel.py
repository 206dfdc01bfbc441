"""The 2D part of the page: the verdict, buttons, parameters, plots, and how the nodes are."""

from __future__ import annotations

import html
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import viser
from numpy.typing import NDArray

from gaik_ros.health import ERROR, OK, WARN
from gaik_ros.viewer.board import Board, NodeHealth
from gaik_ros.viewer.controls import GAINS, LAP, SOLVER, Controls, SuiteParameters
from gaik_ros.viewer.picture import Picture
from gaik_ros.viewer.plots import Plot
from gaik_ros.viewer.scene import BAD, DESIRED, FOLLOWED, GOOD, VOLUME
from gaik_ros.viewer.suite_client import SuiteError
from gaik_ros.viewer.words import Words

Array = NDArray[np.float64]

MILLI = 1e3
LEVELS = {OK: GOOD, WARN: BAD, ERROR: (205, 43, 49)}
SILENT = (168, 176, 186)
NOTICE = 8.0  # s


@dataclass(frozen=True)
class Actions:
    """What the buttons do. Each may raise SuiteError; the words that they return are shown."""

    start: Callable[[str], str]  # by the name of a path
    stop: Callable[[], str]
    reset: Callable[[], str]
    go_to: Callable[[Array], None]  # (3,) m
    show_workspace: Callable[[bool], None]


class Panel:
    """Everything beside the scene."""

    def __init__(
        self,
        server: viser.ViserServer,
        title: str,
        actions: Actions,
        parameters: SuiteParameters,
        periods_of: str,
    ) -> None:
        """`periods_of` is the full name of the node whose loop periods are plotted."""
        self._server, self._actions, self._periods_of = server, actions, periods_of
        gui = server.gui
        gui.configure_theme(show_logo=False, show_share_button=False, brand_color=DESIRED)
        gui.set_panel_label(title)
        gui.main_panel.dock_right()
        gui.main_panel.set_width(340)
        self._verdict = gui.add_html("")
        self._add_buttons()
        with gui.add_folder("Paths"):
            gui.add_html(_legend())
            self._add_workspace_switch()
            lap = Controls(server, parameters.trajectory, LAP, self.notify)
        with gui.add_folder("Inverse kinematics"):
            solver = Controls(server, parameters.ik, SOLVER, self.notify)
        with gui.add_folder("PID controller"):
            gains = Controls(server, parameters.controller, GAINS, self.notify)
        with gui.add_folder("Nodes"):
            self._nodes = gui.add_html("")
        self._controls = (lap, solver, gains)
        self._add_plots()

    def _add_buttons(self) -> None:
        gui = self._server.gui
        for label, buttons in (("Follow", ("Circle", "Lemniscate")), ("Motion", ("Stop", "Reset"))):
            group = gui.add_button_group(label, buttons)
            group.on_click(lambda event: self._press(event.target.value, event.client))
        self._setpoint = gui.add_vector3(
            "Setpoint (mm)", (0.0, 0.0, 0.0), step=0.5, hint="right, up and toward the user: x, y, z"
        )

        @self._setpoint.on_update
        async def _(event: viser.GuiEvent[Any]) -> None:
            if event.client is not None:  # a user; None is our own `show`
                self._actions.go_to(np.array(self._setpoint.value) / MILLI)

    def _add_workspace_switch(self) -> None:
        switch = self._server.gui.add_checkbox("Reachable workspace", True)
        switch.on_update(lambda _: self._actions.show_workspace(switch.value))

    def _add_plots(self) -> None:
        panel = self._server.gui.add_panel()
        with panel.add_tab("Live"):
            self._errors = Plot(
                self._server,
                "Distance of the tip (mm) over time (s)",
                (("to the setpoint", css(DESIRED)), ("to the reference", css(FOLLOWED))),
                MILLI,
                (0.01, 100.0),
            )
            self._periods = Plot(
                self._server,
                f"Period of {self._periods_of.rsplit('/', 1)[-1]} (ms) over time (s)",
                (("median", css(GOOD)), ("99 %", css(BAD)), ("longest", css(SILENT))),
                MILLI,
                (0.1, 100.0),
            )
        panel.float(x=15, y=-15, width=330)

    def _press(self, label: str, client: viser.ClientHandle | None) -> None:
        try:
            if label == "Stop":
                said = self._actions.stop()
            elif label == "Reset":
                said = self._actions.reset()
            else:
                said = self._actions.start(label.lower())
        except SuiteError as reason:
            self.notify(f"{label} does not work", str(reason), client)
        else:
            if client is not None:
                client.add_notification(label, said, auto_close_seconds=2.0)

    def notify(self, title: str, text: str, client: viser.ClientHandle | None = None) -> None:
        """Show a complaint to one user, or to all."""
        for one in [client] if client is not None else list(self._server.get_clients().values()):
            one.add_notification(title, text, color="orange", auto_close_seconds=NOTICE)

    def show(self, picture: Picture, board: Board, now: float) -> None:
        """Show what may lag a little."""
        self._errors.show(picture.errors, now)
        self._periods.show(board.periods[self._periods_of], now)
        self._verdict.content = verdict_html(picture.verdict)
        self._nodes.content = nodes_html(board.health(now))
        point = picture.setpoint if picture.setpoint is not None else picture.tip
        self._setpoint.value = tuple(round(MILLI * value, 1) + 0.0 for value in point.tolist())

    def show_parameters(self) -> None:
        """Show the parameters that are in force."""
        for controls in self._controls:
            controls.show()


def css(rgb: tuple[int, int, int]) -> str:
    """A colour as the browser has it."""
    return "#{:02x}{:02x}{:02x}".format(*rgb)


def verdict_html(words: Words) -> str:
    """The verdict, with a coloured edge."""
    colour = css(GOOD if words.good else BAD)
    return (
        f'<div style="border-left:4px solid {colour};padding:2px 10px;margin:8px 12px;min-height:4.6em">'
        f'<b style="color:{colour}">{html.escape(words.headline)}</b>'
        f'<div style="font-size:0.85em;line-height:1.4">{html.escape(words.sentence)}</div></div>'
    )


def nodes_html(nodes: Sequence[NodeHealth]) -> str:
    """One row for each node: a dot in the colour of its level, its name, its rate, what it says."""
    rows = []
    for node in nodes:
        dot = f'<span style="color:{css(LEVELS.get(node.level, SILENT))}">●</span>'
        rate = "" if math.isnan(node.rate) else f"{node.rate:.0f} Hz"
        rows.append(
            f"<tr><td>{dot} {html.escape(node.name)}</td>"
            f'<td style="text-align:right;white-space:nowrap;padding-left:8px">{rate}</td></tr>'
        )
        if node.message != "ok":
            rows.append(f'<tr><td colspan="2" style="opacity:.7">{html.escape(node.message)}</td></tr>')
    return f'<table style="font-size:0.85em;margin:4px 12px;width:calc(100% - 24px)">{"".join(rows)}</table>'


def _legend() -> str:
    entries = ((DESIRED, "desired"), (FOLLOWED, "followed"), (VOLUME, "reachable"))
    chips = " ".join(
        f'<span style="white-space:nowrap;margin-right:12px"><span style="color:{css(colour)}">■</span> {name}</span>'
        for colour, name in entries
    )
    return f'<div style="font-size:0.85em;margin:4px 12px">{chips}</div>'
