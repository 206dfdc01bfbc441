"""The pictures of docs/benchmarks.md."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from report import Task
from scaling import Scaling

OURS, PEER = "#1b6ca8", "#b8b8b8"


def plot_tasks(tasks: Sequence[Task], path: Path) -> None:
    """A panel of bars per task, the fastest on top; gaik in blue."""
    columns = 2
    rows = -(-len(tasks) // columns)
    heights = [
        max(len(task.results) for task in tasks[row * columns : (row + 1) * columns]) for row in range(rows)
    ]
    figure = Figure(figsize=(13, 0.34 * sum(heights) + 1.1 * rows), layout="constrained")
    axes = figure.subplots(rows, columns, gridspec_kw={"height_ratios": heights}, squeeze=False)
    for axis, task in zip(axes.flat, tasks, strict=False):
        _bars(axis, task)
    for axis in axes.flat[len(tasks) :]:
        axis.set_visible(False)
    figure.savefig(path, dpi=110)


def _bars(axis: Axes, task: Task) -> None:
    rate = task.key == "T4"
    values = np.array([1 / r.median if rate else 1e6 * r.median for r in task.results])
    colours = [OURS if r.package == "gaik_core" else PEER for r in task.results]
    bars = axis.barh([r.name for r in task.results], values, color=colours)
    labels = []
    for value, r in zip(values, task.results, strict=True):
        label = f"{value:,.0f}".replace(",", " ") if value >= 100 else f"{value:.3g}"
        labels.append(label if r.solved >= 0.9995 else f"{label}  ({100 * r.solved:.1f} % solved)")
    axis.bar_label(bars, labels, padding=4, fontsize=9)
    axis.set_xscale("log")
    axis.set_xlim(values.min() / 2, values.max() * 20)
    axis.invert_yaxis()
    axis.set_title(f"{task.key}: {task.title}", fontsize=10, loc="left")
    axis.set_xlabel("targets per second" if rate else "µs each (logarithmic)", fontsize=9)
    axis.spines[["top", "right"]].set_visible(False)


def plot_scaling(scaling: Scaling, path: Path) -> None:
    """Time per iteration over joints, with the straight line nearest to it."""
    figure = Figure(figsize=(7, 4.2), layout="constrained")
    axis = figure.subplots()
    joints = np.array(scaling.joints)
    for name, times, marker in zip(scaling.names, 1e6 * scaling.seconds.T, "osd^", strict=False):
        slope, base = np.polyfit(joints, times, 1)
        (line,) = axis.plot(joints, base + slope * joints, "-", linewidth=1)
        label = f"{name}: {1e3 * slope:.0f} ns per joint"
        axis.plot(joints, times, marker, color=line.get_color(), label=label)
    axis.set_xlabel("joints")
    axis.set_ylabel("µs per iteration")
    axis.set_xlim(0, None)
    axis.set_ylim(0, None)
    axis.grid(alpha=0.3)
    axis.legend(loc="upper left")
    figure.savefig(path, dpi=110)
