"""The live plots: tracking error and loop period against time."""

from __future__ import annotations

import html
from collections.abc import Sequence

import numpy as np
import viser
from viser import uplot

from gaik_ros.viewer.strip_chart import StripChart

AXIS = "#8a929c"
GRID: uplot.Axis_Grid = {"stroke": "#e6e9ed", "width": 1}
FONT = "11px sans-serif"


class Plot:
    """One strip chart as lines over time; upward in decades, for what may be small for long and large for a moment."""

    def __init__(
        self,
        server: viser.ViserServer,
        title: str,
        series: Sequence[tuple[str, str]],
        window: float,
        factor: float,
        decades: tuple[float, float],
    ) -> None:
        """`series` are labels and colours; values are shown times `factor`, between the `decades`."""
        self._factor, self._decades = factor, decades
        server.gui.add_html(_heading(title, series))
        lines = tuple(uplot.Series(stroke=colour, width=1.5, points={"show": False}) for _, colour in series)
        axis = uplot.Axis(stroke=AXIS, grid=GRID, ticks=GRID, font=FONT)
        self._plot = server.gui.add_uplot(
            (np.array([-window, 0.0]), *[np.full(2, np.nan)] * len(series)),
            (uplot.Series(label="s"), *lines),
            scales={
                "x": uplot.Scale(time=False, range=(-window, 0.0)),
                "y": uplot.Scale(distr=3, range=decades),
            },
            axes=(
                uplot.Axis(**axis, scale="x", size=26.0, space=40.0),
                uplot.Axis(**axis, scale="y", size=42.0),
            ),
            legend={"show": False},
            cursor={"show": False},
            height=130,
            padding=(6, 12, 0, 0),
        )

    def show(self, chart: StripChart, now: float) -> None:
        """Show the newest samples."""
        times, *values = chart.columns(now)
        if times.size >= 2:
            self._plot.data = (times, *(np.clip(self._factor * column, *self._decades) for column in values))


def _heading(title: str, series: Sequence[tuple[str, str]]) -> str:
    """What is plotted, and which line is what."""
    chips = " ".join(
        f'<span style="white-space:nowrap"><span style="color:{colour}">■</span> {html.escape(label)}</span>'
        for label, colour in series
    )
    return (
        f'<div style="font-size:0.8em;margin:6px 14px 0"><b>{html.escape(title)}</b>'
        f'<div style="display:flex;gap:12px">{chips}</div></div>'
    )
