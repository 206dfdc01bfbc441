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
        factor: float,
        decades: tuple[float, float],
    ) -> None:
        """`series` are labels and colours; values are shown times `factor`, between the `decades`."""
        self._factor, self._decades = factor, decades
        self._began: float | None = None
        server.gui.add_html(_heading(title, series))
        lines = tuple(uplot.Series(stroke=colour, width=1.5, points={"show": False}) for _, colour in series)
        axis = uplot.Axis(stroke=AXIS, grid=GRID, ticks=GRID, font=FONT)
        self._plot = server.gui.add_uplot(
            (np.array([-1.0, 0.0]), *[np.full(2, decades[0])] * len(series)),
            (uplot.Series(label="s"), *lines),
            scales={"x": uplot.Scale(time=False), "y": uplot.Scale(distr=3, range=decades)},
            axes=(
                uplot.Axis(**axis, scale="x", size=26.0),
                uplot.Axis(**axis, scale="y", size=42.0),
            ),
            legend={"show": False},
            cursor={"show": False},
            height=130,
            padding=(6, 12, 0, 0),
        )

    def show(self, chart: StripChart, now: float) -> None:
        """Show the newest samples that have a value of every series, over the time in s since the first call."""
        if self._began is None:
            self._began = now
        times, *values = chart.columns(now)
        whole = np.isfinite(values).all(axis=0)  # the browser knows no NaN: it would draw a fall to zero
        if whole.sum() >= 2:
            shown = (np.clip(self._factor * column[whole], *self._decades) for column in values)
            self._plot.data = (now - self._began + times[whole], *shown)


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
