"""What the figures share: style, arms in the plane and in space, curves against updates, files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from io import BytesIO
from pathlib import Path
from typing import Any, Literal

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from gaik_core.chain import KinematicChain

Array = NDArray[np.float64]
Up = Literal["y", "z"]

STYLE: Any = {
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "0.88",
    "grid.linewidth": 0.6,
    "legend.fontsize": 8.0,
    "legend.framealpha": 0.9,
    "lines.linewidth": 1.4,
    "figure.facecolor": "white",
    "svg.fonttype": "none",
}

# The paper's colours: the start grey, the way of the tip blue, the end black, what is desired red.
START, WAY, END, DESIRED, BETWEEN = "0.55", "#1f5fbf", "black", "#c8321f", "0.85"
JOINTS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8c6d1f", "#555555")
"""A colour for each joint, told apart by colour-blind readers too."""

# Where a point (x, y, z) is drawn on matplotlib's axes, of which the third points up.
_DRAWN = {"z": (0, 1, 2), "y": (0, 2, 1)}


def new_figure(width: float, height: float) -> Figure:
    """An empty figure of a size in inches, whose parts make room for each other."""
    figure = Figure(figsize=(width, height), layout="constrained")
    figure.get_layout_engine().set(w_pad=0.08, h_pad=0.08, wspace=0.03, hspace=0.03)  # type: ignore[union-attr, call-arg]
    return figure


def save(draw: Callable[[], Figure], file: Path, dpi: int = 150) -> None:
    """Draw in the common style and write a PNG."""
    picture = BytesIO()  # so that an interrupted run leaves no half of a file
    with mpl.rc_context(STYLE):
        draw().savefig(picture, dpi=dpi, format="png")
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(picture.getvalue())


def joint_label(joint: int) -> str:
    """θ with the joint's number, counted from one."""
    return rf"$\theta_{{{joint + 1}}}$"


# --- in the plane ----------------------------------------------------------------------------------------------------


def plane(axes: Axes, title: str, across: tuple[float, float], up: tuple[float, float]) -> None:
    """Make axes show a part of the x-y plane in metres, both directions to one scale."""
    axes.set(xlabel="x (m)", ylabel="y (m)", title=title, xlim=across, ylim=up)
    axes.set_aspect("equal", adjustable="box")


def arm(axes: Any, chain: KinematicChain, angles: Array, up: Up = "z", **style: Any) -> None:
    """Draw the links of an arm from joint to joint, on plane axes or in space."""
    line(
        axes,
        chain.frames(angles),
        up,
        **{"marker": "o", "markersize": 3.5, "solid_capstyle": "round"} | style,
    )


def arm_on_its_way(
    axes: Any, chain: KinematicChain, angles: Array, target: Array, up: Up = "z", between: int = 6
) -> None:
    """Draw a descent (steps, dof) as the paper does: start grey, some poses between, end black, the tip's way blue."""
    tips = chain.forward(angles)
    for step in evenly_along(tips, between):
        arm(axes, chain, angles[step], up, color=BETWEEN, linewidth=1.0, markersize=2.0)
    arm(axes, chain, angles[0], up, color=START, linewidth=2.2, label="start")
    line(axes, tips, up, color=WAY, label="way of the tip", zorder=4)
    arm(axes, chain, angles[-1], up, color=END, linewidth=2.2, label="end", zorder=5)
    points(axes, target[None], up, color=DESIRED, marker="x", s=45, label="desired point", zorder=6)


def evenly_along(tips: Array, count: int) -> list[int]:
    """Steps between the first and the last at which the tip has gone about equal shares of its way."""
    gone = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(tips, axis=0), axis=1))])
    shares = np.linspace(0.0, gone[-1], count + 2)[1:-1]
    return sorted({int(step) for step in np.searchsorted(gone, shares)} - {0, len(tips) - 1})


# --- in space --------------------------------------------------------------------------------------------------------


def space(
    figure: Figure, position: Any, title: str = "", elevation: float = 22.0, azimuth: float = -60.0
) -> Any:
    """Axes in space; call `finish_space` when all is drawn."""
    axes = figure.add_subplot(position, projection="3d")
    axes.set_title(title)
    axes.view_init(elevation, azimuth)
    return axes


def finish_space(axes: Any, up: Up = "z", zoom: float = 1.0) -> None:
    """Label the axes and give all three one scale, in a right-handed frame whatever axis points up."""
    low, high = np.array([axes.get_xlim(), axes.get_ylim(), axes.get_zlim()]).T
    longest = (high - low).max()
    half = 0.5 * np.maximum(high - low, 0.45 * longest)  # a flat box would crowd its ticks
    low, high = 0.5 * (low + high) - half, 0.5 * (low + high) + half
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(high - low, zoom=zoom)
    for name, component, extent in zip("xyz", _DRAWN[up], high - low, strict=True):
        axis = getattr(axes, f"{name}axis")
        axis.set_label_text(f"{'xyz'[component]} (m)")
        axis.set_major_locator(mpl.ticker.MaxNLocator(max(2, round(5 * extent / longest))))
    axes.tick_params(pad=2)
    axes.tick_params(axis="z", pad=6)
    axes.zaxis.labelpad = 10
    if up == "y":
        axes.invert_yaxis()


def line(axes: Any, track: Array, up: Up = "z", **style: Any) -> None:
    """Draw a line through points (m, 3), on plane axes or in space."""
    axes.plot(*_on(axes, track, up), **style)


def points(axes: Any, where: Array, up: Up = "z", **style: Any) -> Any:
    """Draw points (m, 3), on plane axes or in space."""
    return axes.scatter(*_on(axes, where, up), **style)


def arrows(axes: Any, where: Array, directions: Array, up: Up = "z", **style: Any) -> None:
    """Draw arrows at points (m, 3) in space along directions (m, 3), of one `length`."""
    axes.quiver(*_on(axes, where, up), *_on(axes, directions, up), normalize=True, **style)


def _on(axes: Any, where: Array, up: Up) -> list[Array]:
    if axes.name == "3d":
        return [where[:, component] for component in _DRAWN[up]]
    return [where[:, 0], where[:, 1]]


# --- against updates -------------------------------------------------------------------------------------------------


def joints_against_updates(axes: Axes, angles: Array, printed: Sequence[float] | None = None) -> None:
    """Draw each joint (steps, dof) in degrees, and what the paper prints for its end as a dotted line."""
    for joint, track in enumerate(np.degrees(angles).T):
        axes.plot(track, color=JOINTS[joint], label=joint_label(joint))
        if printed is not None:
            axes.axhline(
                printed[joint],
                color=JOINTS[joint],
                linestyle=":",
                linewidth=1.1,
                label=f"{joint_label(joint)} printed",
            )
    axes.set(xlabel="update", ylabel="joint angle (deg)")
    axes.set_xlim(0, len(angles) - 1)


def error_against_updates(axes: Axes, distance: Array, **style: Any) -> None:
    """Draw the distance from the desired point (steps,) in m."""
    axes.plot(distance, **style)
    axes.set(xlabel="update", ylabel="distance to the desired point (m)")


def key(label: str, **style: Any) -> mpl.lines.Line2D:
    """An entry of a legend that stands for many lines."""
    return mpl.lines.Line2D([], [], label=label, **style)
