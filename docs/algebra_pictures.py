"""The pictures of docs/algebra.md, each computed by the algebra that it shows. Run by `make pictures`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D
from numpy.typing import NDArray

from gaik_core import KinematicChain, cga
from gaik_core.versors import Motor

Array = NDArray[np.float64]

FOLDER = Path(__file__).resolve().parent / "images"
BLUE, ORANGE, GREEN, GREY = "tab:blue", "tab:orange", "tab:green", "0.6"


def space(figure: Figure, reach: float, azimuth: float) -> Axes3D:
    """Axes with one scale for all three directions, from -reach to reach."""
    axes = figure.add_axes((0.0, 0.0, 1.0, 0.94), projection="3d")
    assert isinstance(axes, Axes3D)
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), zlim=(-reach, reach))
    axes.set(xlabel="x", ylabel="y", zlabel="z")
    axes.set_box_aspect((1, 1, 1))
    axes.view_init(elev=22.0, azim=azimuth)
    return axes


def curve(axes: Axes3D, points: Array, **style: object) -> None:
    """A line through points (n, 3)."""
    axes.plot(*np.asarray(points).T, **style)


def meeting(figure: Figure) -> None:
    """A sphere meets a plane in a circle, and a line in a point pair."""
    sphere, plane = cga.sphere([0, 0, 0], 1.0), cga.plane([0, 0.3, 1], 0.4)
    line = cga.line([1.4, 0.2, -0.9], [-1.4, -0.3, 0.5])
    circle, pair = cga.meet(sphere, plane), cga.meet(sphere, line)
    axes = space(figure, 1.3, -50.0)

    turn, height = np.meshgrid(np.linspace(0, 2 * np.pi, 25), np.linspace(0, np.pi, 13))
    ball = np.stack([np.sin(height) * np.cos(turn), np.sin(height) * np.sin(turn), np.cos(height)])
    axes.plot_wireframe(*ball, color=GREY, linewidth=0.6, label="sphere")
    x, y = np.meshgrid(np.linspace(-1.2, 1.2, 2), np.linspace(-1.2, 1.2, 2))
    normal = np.asarray(cga.plane_normal(plane))
    z = (float(cga.plane_distance(plane)) - normal[0] * x - normal[1] * y) / normal[2]
    axes.plot_surface(x, y, z, color=BLUE, alpha=0.25)

    centre, across = np.asarray(cga.centre(circle)), np.asarray(cga.circle_normal(circle))
    start = np.cross(across, [1.0, 0.0, 0.0])
    start *= float(cga.radius(circle)) / np.linalg.norm(start)
    about = cga.axis_line(centre, across)
    round_ = np.array(
        [Motor.from_line(about, t).apply(centre + start) for t in np.linspace(0, 2 * np.pi, 121)]
    )
    curve(axes, round_, color=BLUE, linewidth=2.5, label="meet(sphere, plane): a circle")
    ends = np.asarray(cga.line_point(line)) + np.outer([-1.6, 1.6], np.asarray(cga.line_direction(line)))
    curve(axes, ends, color=GREEN, linewidth=1.5)
    axes.scatter(
        *np.asarray(cga.pair_points(pair)).T, color=GREEN, s=45, label="meet(sphere, line): a point pair"
    )
    axes.legend(loc="upper left", fontsize=9)


def screwing(figure: Figure) -> None:
    """A motor is a screw: it turns a frame about a line and moves it along."""
    line = cga.axis_line([0.2, -0.1, 0.0], [0.25, 0.15, 1.0])
    turn, advance = 1.5 * np.pi, 1.6
    axes = space(figure, 1.3, -60.0)
    ends = np.asarray(cga.line_point(line)) + np.outer([-1.5, 1.5], np.asarray(cga.line_direction(line)))
    curve(axes, ends, color=GREY, linestyle="--", label="the screw's line")
    home = np.array([0.9, 0.0, -0.9])
    shares = np.linspace(0, 1, 121)
    way = np.asarray(Motor.from_line(line, shares * turn, shares * advance).apply(home))
    curve(axes, way, color="k", linewidth=1.2, label="the way of the origin")
    for share in np.linspace(0, 1, 7):
        step = Motor.from_line(line, share * turn, share * advance)
        for axis, colour in zip(0.28 * np.eye(3), ("tab:red", GREEN, BLUE), strict=True):
            curve(axes, np.stack([step.apply(home), step.apply(home + axis)]), color=colour, linewidth=2)
    axes.legend(loc="upper left", fontsize=9)


def jacobian(figure: Figure) -> None:
    """The joints of an arm are lines; the inner product of the tip with each is how it moves the tip."""
    chain = KinematicChain.load("arm5")
    angles = np.array([0.6, -1.3, 1.5, 1.2, 0.8])
    places, directions = chain.frames(angles), chain.geometric_jacobian(angles)[3:].T
    lines, tip = cga.axis_line(places[:-1], directions), places[-1]
    columns = (cga.up(tip) | lines).components[:, [1, 2, 4]]  # e1, e2, e3: eq. 50
    assert np.allclose(columns.T, chain.jacobian(angles))
    reach = 0.8 * np.abs(places).max()
    axes = space(figure, reach, -100.0)
    curve(axes, places, color="k", linewidth=3, marker="o", markersize=5, label="the arm")
    scale = 0.8 * reach / np.linalg.norm(columns, axis=1).max()
    for number, (place, line, column) in enumerate(zip(places, lines, columns, strict=False), start=1):
        colour = f"C{number - 1}"
        ends = place + np.outer([-0.3 * reach, 0.3 * reach], np.asarray(cga.line_direction(line)))
        curve(
            axes, ends, color=colour, linewidth=2.5, label=f"axis L{number}, and tip · L{number} at the tip"
        )
        axes.quiver(*tip, *(scale * column), color=colour, arrow_length_ratio=0.12, linewidth=2)
    axes.legend(loc="upper left", fontsize=9)


PICTURES: dict[str, tuple[str, Callable[[Figure], None]]] = {
    "algebra_meet": ("Objects meet", meeting),
    "algebra_screw": ("A motor is a screw", screwing),
    "algebra_jacobian": ("The Jacobian is made of inner products", jacobian),
}


def main() -> None:
    """Draw all into docs/images."""
    mpl.use("Agg")
    for name, (title, draw) in PICTURES.items():
        figure = Figure(figsize=(6.0, 5.4))
        draw(figure)
        figure.suptitle(title, y=0.98)
        figure.savefig(FOLDER / f"{name}.png", dpi=110)
        print(f"written: docs/images/{name}.png")


if __name__ == "__main__":
    main()
