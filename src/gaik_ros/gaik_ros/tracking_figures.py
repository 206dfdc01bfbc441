"""The paper's Figs. 21 and 22 from recorded runs: desired in black, followed in red."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.axes3d import Axes3D

from gaik_ros.tracking import Run, Series, tracking_error

DESIRED = {"color": "black", "linewidth": 2.6, "label": "desired"}
FOLLOWED = {"color": "red", "linewidth": 1.1, "label": "followed"}
DPI = 150
MOST_POINTS = 2000  # a curve looks no better with more


def draw_paths(runs: Sequence[Run], file: Path) -> None:
    """Write the paths in space (the paper's Fig. 21) to a PNG: one panel each, all axes of one scale, in mm."""
    figure = Figure(figsize=(5.6 * len(runs), 5.6), layout="constrained")
    for column, run in enumerate(runs, start=1):
        _draw_path(figure.add_subplot(1, len(runs), column, projection="3d"), run)
    _legend(figure)
    _save(figure, file)


def draw_joints(runs: Sequence[Run], file: Path) -> None:
    """Write each joint against time (the paper's Fig. 22) to a PNG: a row for each joint, a column for each run."""
    names = runs[0].joint_names
    figure = Figure(figsize=(5.6 * len(runs), 2.2 * len(names) + 0.6), layout="constrained")
    axes = figure.subplots(len(names), len(runs), sharex="col", squeeze=False)
    for column, run in enumerate(runs):
        desired, followed = (_in_lap(run, series) for series in (run.joint_reference, run.joint_states))
        for row, name in enumerate(names):
            panel = axes[row, column]
            panel.plot(desired.time, desired.values[:, row], **DESIRED)
            panel.plot(followed.time, followed.values[:, row], **FOLLOWED)
            panel.set_ylabel(f"{name} [rad]")
            panel.grid(alpha=0.3)
        axes[0, column].set_title(run.name)
        axes[-1, column].set_xlabel("time [s]")
    _legend(figure)
    _save(figure, file)


def _draw_path(axes: Axes3D, run: Run) -> None:
    tip = _in_lap(run, run.tip)
    desired, followed = 1e3 * run.course.desired(tip.time + run.course.start), 1e3 * tip.values
    axes.plot(*desired.T, **DESIRED)
    axes.plot(*followed.T, **FOLLOWED)
    middle, half = (desired.max(axis=0) + desired.min(axis=0)) / 2, 0.55 * np.ptp(desired, axis=0).max()
    axes.set(xlim=_around(middle[0], half), ylim=_around(middle[1], half), zlim=_around(middle[2], half))
    axes.set_box_aspect((1, 1, 1))
    axes.view_init(elev=25, azim=35, vertical_axis="y")  # the paper's y is up, its x to the right
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_major_locator(MaxNLocator(5))
    axes.set(xlabel="x [mm]", ylabel="y [mm]", zlabel="z [mm]")
    error = tracking_error(run)
    axes.set_title(f"{run.name}: error {1e3 * error.rms_m:.2f} mm RMS, {1e3 * error.max_m:.2f} mm at most")


def _in_lap(run: Run, series: Series) -> Series:
    """Return the part of a series that counts, thinned for drawing, its time from the start of the path."""
    part = series.between(run.course.start, run.course.end)
    step = max(1, part.time.size // MOST_POINTS)
    return Series(part.time[::step] - run.course.start, part.values[::step])


def _around(middle: float, half: float) -> tuple[float, float]:
    return middle - half, middle + half


def _legend(figure: Figure) -> None:
    """Put the legend of the first panel, which is that of all, under the figure."""
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, frameon=False)


def _save(figure: Figure, file: Path) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    FigureCanvasAgg(figure)
    figure.savefig(file, dpi=DPI)
