"""A picture of a workspace: plane sections through it, with the arm at home."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from gaik_core.chain import KinematicChain
from gaik_core.experiments.drawing import new_figure
from gaik_core.workspace import Workspace

Array = NDArray[np.float64]

BEHIND, CUT, ARM, THROUGH = "#d6e4f2", "#6fa3d2", "black", "#c8321f"
PLANES = ((0, 1), (2, 1), (0, 2))
"""The axes drawn across and up in each section."""


def draw_workspace(chain: KinematicChain, workspace: Workspace, at: Array) -> Figure:
    """Draw the sections through `at` (3,) m; of a flat workspace, itself."""
    flat = [axis for axis, count in enumerate(workspace.reached.shape) if count == 1]
    planes = [plane for plane in PLANES if not set(plane) & set(flat)] or [PLANES[0]]
    figure = new_figure(4.6 * len(planes), 5.2)
    for column, plane in enumerate(planes, start=1):
        _draw_section(figure.add_subplot(1, len(planes), column), chain, workspace, plane, at)
    size = {3: f"{workspace.size:.4g} m³", 2: f"{workspace.size:.4g} m²"}.get(workspace.dimension, "a curve")
    figure.suptitle(
        f"{chain.name}: {size}, {workspace.nearest:.3g} to {workspace.farthest:.3g} m from its first axis"
    )
    figure.legend(handles=_legend(len(planes) > 1), loc="outside lower center", ncols=4, frameon=False)
    return figure


def _draw_section(
    axes: Any, chain: KinematicChain, workspace: Workspace, plane: tuple[int, int], at: Array
) -> None:
    across, up = plane
    (normal,) = {0, 1, 2} - set(plane)
    layer = int((at[normal] - workspace.corner[normal]) / workspace.cell) if workspace.cell else 0
    layer = min(max(layer, 0), workspace.reached.shape[normal] - 1)
    _fill(axes, workspace, np.asarray(workspace.reached.any(axis=normal)), plane, BEHIND)
    _fill(axes, workspace, np.take(workspace.reached, layer, axis=normal), plane, CUT)
    if not workspace.size:
        axes.plot(workspace.tips[:, across], workspace.tips[:, up], ".", color=CUT, markersize=1.0)
    arm = chain.frames(chain.home)
    axes.plot(arm[:, across], arm[:, up], color=ARM, marker="o", markersize=3.5, linewidth=2.0)
    x, y, z = (f"{'xyz'[axis]}" for axis in (across, up, normal))
    title = f"{z} = {at[normal]:.3f} m" if workspace.reached.shape[normal] > 1 else ""
    axes.set(xlabel=f"{x} (m)", ylabel=f"{y} (m)", title=title)
    axes.set_aspect("equal", adjustable="datalim")
    for axis, draw in ((across, axes.axvline), (up, axes.axhline)):
        if workspace.reached.shape[normal] > 1:
            draw(at[axis], color=THROUGH, linewidth=0.7, linestyle=":")


def _fill(
    axes: Any, workspace: Workspace, cells: NDArray[np.bool_], plane: tuple[int, int], colour: str
) -> None:
    """Colour the cells of a plane, given in the order of the axes that are left."""
    across, up = plane
    shown = np.ma.masked_equal(cells if across > up else cells.T, False)
    edges = [
        workspace.corner[axis] + workspace.cell * np.arange(workspace.reached.shape[axis] + 1)
        for axis in plane
    ]
    axes.pcolormesh(*edges, shown, cmap=ListedColormap([colour]), rasterized=True)


def _legend(sections: bool) -> list[Any]:
    entries: list[Any] = [Patch(color=CUT, label="reachable in the plane")]
    if sections:
        entries.append(Patch(color=BEHIND, label="reachable before or behind it"))
    entries.append(Line2D([], [], color=ARM, marker="o", markersize=3.5, label="the arm at home"))
    if sections:
        entries.append(Line2D([], [], color=THROUGH, linestyle=":", label="where the other planes cut"))
    return entries
