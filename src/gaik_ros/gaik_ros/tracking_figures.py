"""The paper's Figs. 21 and 22 from recorded runs: desired in black, followed in red."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure, SubFigure
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.axes3d import Axes3D

from gaik_core.experiments.drawing import new_figure, save
from gaik_ros.tracking import Run, Series, tracking_error

DESIRED = {"color": "black", "linewidth": 2.6, "label": "desired"}
FOLLOWED = {"color": "red", "linewidth": 1.1, "label": "followed"}
DPI = 150
MOST_POINTS = 2000  # a curve looks no better with more
VIEW = {"elev": 25, "azim": 35, "vertical_axis": "y"}  # the paper's y is up, its x to the right


def draw_paths(runs: Sequence[Run], file: Path) -> None:
    """Write the paths in space (the paper's Fig. 21) to a PNG."""
    save(partial(paths_figure, runs), file, DPI)


def draw_joints(runs: Sequence[Run], file: Path) -> None:
    """Write each joint against time (the paper's Fig. 22) to a PNG."""
    save(partial(joints_figure, runs), file, DPI)


def paths_figure(runs: Sequence[Run], panel: float = 5.6) -> Figure:
    """The paths in space, a square panel of so many inches for each run."""
    figure = new_figure(panel * len(runs), panel)
    paths_on(figure, runs)
    return figure


def paths_on(figure: Figure | SubFigure, runs: Sequence[Run]) -> None:
    """Draw the paths in space on a figure or a part of one: a panel each, all axes of one scale, in mm."""
    for column, run in enumerate(runs, start=1):
        _draw_path(figure.add_subplot(1, len(runs), column, projection="3d"), run)
    legend_below(figure)


def joints_figure(runs: Sequence[Run]) -> Figure:
    """Each joint against time: a row for each joint, a column for each run."""
    names = runs[0].joint_names
    figure = new_figure(5.6 * len(runs), 2.2 * len(names) + 0.6)
    axes = figure.subplots(len(names), len(runs), sharex="col", squeeze=False)
    for column, run in enumerate(runs):
        desired, followed = (in_lap(run, series) for series in (run.joint_reference, run.joint_states))
        for row, name in enumerate(names):
            panel = axes[row, column]
            panel.plot(desired.time, desired.values[:, row], **DESIRED)
            panel.plot(followed.time, followed.values[:, row], **FOLLOWED)
            panel.set_ylabel(f"{name} [rad]")
        axes[0, column].set_title(run.name)
        axes[-1, column].set_xlabel("time [s]")
    legend_below(figure)
    return figure


def _draw_path(axes: Axes3D, run: Run) -> None:
    lap = np.linspace(run.course.start, run.course.end, MOST_POINTS)
    desired, followed = 1e3 * run.course.desired(lap), 1e3 * in_lap(run, run.tip).values
    axes.plot(*desired.T, **DESIRED)
    axes.plot(*followed.T, **FOLLOWED)
    middle, half = (desired.max(axis=0) + desired.min(axis=0)) / 2, 0.55 * np.ptp(desired, axis=0).max()
    space_in_mm(axes, middle, half)
    error = tracking_error(run)
    axes.set_title(f"{run.name}: error {1e3 * error.rms_m:.2f} mm RMS, {1e3 * error.max_m:.2f} mm at most")


def space_in_mm(axes: Axes3D, middle: Sequence[float], half: float, zoom: float = 1.0) -> None:
    """Show a cube about a point (3,), `half` to each side in mm, all axes of one scale, seen as the paper does.

    A `zoom` below 1 leaves the labels more room.
    """
    limits = [(centre - half, centre + half) for centre in middle]
    axes.set(xlim=limits[0], ylim=limits[1], zlim=limits[2])
    axes.set(xlabel="x [mm]", ylabel="y [mm]", zlabel="z [mm]")
    axes.set_box_aspect((1, 1, 1), zoom=zoom)
    axes.view_init(**VIEW)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_major_locator(MaxNLocator(5))


def in_lap(run: Run, series: Series) -> Series:
    """Return the part of a series that counts, thinned for drawing, its time from the start of the path."""
    part = series.between(run.course.start, run.course.end)
    step = max(1, part.time.size // MOST_POINTS)
    return Series(part.time[::step] - run.course.start, part.values[::step])


def legend_below(figure: Figure | SubFigure) -> None:
    """Put the legend of the first panel, which is that of all, under the figure."""
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), frameon=False)
