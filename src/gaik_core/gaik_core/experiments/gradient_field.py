"""Section 3.4, Figs. 5 and 7: the field of the gradient over both angles of the planar arm.

"The vector field of the error gradient concerning the vector of angles is presented. In addition to the error
function's curve level being superimposed, it can be observed that there are two minimum zones."
"""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from gaik_core.experiments import drawing
from gaik_core.experiments.both_algebras import Both, compare, degrees, joined, solve_both, trace
from gaik_core.experiments.findings import Comparison, Erratum, Experiment, Findings
from gaik_core.experiments.two_joints import (
    ARM,
    PRINTED_ANGLES,
    PRINTED_RATE,
    START_FIG4,
    START_FIG6,
    START_TEXT,
    TARGET,
    closed_form,
    descend_to_the_end,
)
from gaik_core.update_rules import GradientDescent

Array = NDArray[np.float64]

STARTS_PER_ANGLE = 12  # of the descents that look for minima
SAME = np.radians(0.01)  # two ends nearer than this are one minimum


class Field(NamedTuple):
    """The loss and its falling gradient over a grid of both angles.

    Attributes:
        first, second: (n,) the angles (rad).
        loss: (n, n) 𝓛 = ½ |p_d - p_f|² in m², rows by the second angle (eq. 29).
        fall: (n, n, 2) -∂𝓛/∂θ = 𝓛 J in m²/rad (eq. 33).
    """

    first: Array
    second: Array
    loss: Array
    fall: Array


def field(count: int, algebra: str) -> Field:
    """Sample the field at (count, count) pairs of angles of one turn."""
    angles = np.linspace(-np.pi, np.pi, count)
    loss, fall = np.empty((count, count)), np.empty((count, count, 2))
    for row, second in enumerate(angles):
        for column, first in enumerate(angles):
            error = TARGET - ARM.forward([first, second], algebra)
            loss[row, column] = 0.5 * error @ error
            fall[row, column] = error @ ARM.jacobian([first, second], algebra)
    return Field(angles, angles, loss, fall)


def find_minima() -> tuple[list[Both], Array]:
    """Descend from a grid of starts over both angles; the solves, and their ends (k, 2) in [-π, π), each once."""
    grid = -np.pi + 2.0 * np.pi * (np.arange(STARTS_PER_ANGLE) + 0.5) / STARTS_PER_ANGLE
    solves = [
        solve_both(ARM, TARGET, (first, second), GradientDescent(PRINTED_RATE), tolerance=1e-9)
        for first in grid
        for second in grid
    ]
    minima: list[Array] = []
    for solved in solves:
        end = wrapped(solved.quaternion.angles)
        if solved.quaternion.converged and all(
            np.linalg.norm(wrapped(end - known)) > SAME for known in minima
        ):
            minima.append(end)
    return solves, np.array(sorted(minima, key=lambda end: -end[1]))


def wrapped(angles: Array) -> Array:
    """Angles turned into [-π, π)."""
    result: Array = (angles + np.pi) % (2.0 * np.pi) - np.pi
    return result


def run(title: str, starts: dict[str, Array], printed: tuple[float, float] | None) -> Findings:
    """Find all minima, and descend from the starts through the field."""
    fields = [field(73, algebra) for algebra in ("quaternion", "conformal")]
    solves, minima = find_minima()
    descents = {name: descend_to_the_end(start) for name, start in starts.items()}
    exact = np.degrees(wrapped(closed_form(TARGET)))
    found = np.degrees(minima)
    first = next(iter(descents.values()))
    gap = np.abs(fields[0].fall - fields[1].fall).max()
    return Findings(
        comparisons=[
            compare(f"descent from {next(iter(starts))} ends at", "deg", printed, first, degrees),
            Comparison("minima found in one turn of both joints", "", 2, len(found), len(found), 0),
            Comparison("first minimum", "deg", PRINTED_ANGLES, found[0], found[0]),
            Comparison("second minimum", "deg", None, found[1], found[1]),
            Comparison("first minimum by the law of cosines", "deg", PRINTED_ANGLES, exact[0], exact[0]),
            Comparison("second minimum by the law of cosines", "deg", None, exact[1], exact[1]),
        ],
        iterates={"grid of starts": joined(solves)}
        | {name: solved.iterates for name, solved in descents.items()},
        draw=partial(draw, title, fields[0], minima, descents),
        numbers={"minima_deg": found, "largest_difference_of_the_field_m2_per_rad": gap},
        errata=[_nearest(descents["[-50, -50] deg"])] if "[-50, -50] deg" in descents else [],
    )


def _nearest(solved: Both) -> Erratum:
    """How far the descent went, and how far the solution it did not go to lies from the start."""
    went = float(np.linalg.norm(solved.quaternion.angles - START_FIG6))
    missed = float(np.linalg.norm(wrapped(closed_form(TARGET)[0] - START_FIG6)))
    return Erratum(
        where="3.4, Fig. 6",
        printed="the field carries the start to the closest solution",
        holds="to the minimum whose basin the start lies in, usually but not always the nearest",
        measured=f"from [-50, -50] deg it ends {np.degrees(went):.0f} deg away, "
        f"while the other solution is {np.degrees(missed):.0f} deg away",
        confirmed=missed < went,
    )


def draw(title: str, sampled: Field, minima: Array, descents: dict[str, Both]) -> Figure:
    """Arrows downhill, level curves, the descents, the minima."""
    figure = drawing.new_figure(7.0, 6.4)
    axes = figure.subplots()
    filled = _draw_field(axes, sampled)
    figure.colorbar(filled, ax=axes, label="loss ½|p_d - p_f|² (m²)", shrink=0.86)
    for (name, solved), colour in zip(descents.items(), ("#ff6f59", "#7fe3ff"), strict=False):
        track = np.degrees(trace(solved.quaternion).angles)
        axes.plot(*_cut_at_the_edge(track).T, color=colour, linewidth=2.2, label=f"descent from {name}")
        axes.plot(*track[0], "o", color=colour, markeredgecolor="black")
    star: Any = {
        "marker": "*",
        "color": "white",
        "markeredgecolor": "black",
        "markersize": 15,
        "linestyle": "",
    }
    axes.plot(*np.degrees(minima).T, label="minima", **star)
    ticks = range(-180, 181, 60)
    axes.set(xlabel=r"$\theta_1$ (deg)", ylabel=r"$\theta_2$ (deg)", title=title, xticks=ticks, yticks=ticks)
    axes.set(xlim=(-180, 180), ylim=(-180, 180))
    axes.set_aspect("equal")
    arrow = drawing.key(
        "falling gradient", color="white", marker=r"$\rightarrow$", markersize=12, linestyle=""
    )
    handles: list[Any] = [arrow, *axes.get_legend_handles_labels()[0]]
    figure.legend(handles=handles, loc="outside lower center", ncols=2, facecolor="0.35", labelcolor="white")
    return figure


def _draw_field(axes: Axes, sampled: Field) -> Any:
    """The loss as colours and level curves, its falling gradient as arrows; the colours, for a colour bar."""
    first, second = np.degrees(sampled.first), np.degrees(sampled.second)
    filled = axes.contourf(first, second, sampled.loss, levels=24, cmap="cividis")
    axes.contour(first, second, sampled.loss, levels=12, colors="white", linewidths=0.5, alpha=0.6)
    few = slice(None, None, 4)
    across, up = sampled.fall[few, few, 0], sampled.fall[few, few, 1]
    axes.quiver(first[few], second[few], across, up, color="white", width=0.0022, angles="xy")
    return filled


def _cut_at_the_edge(track: Array) -> Array:
    """A track in degrees turned into [-180, 180), broken by a NaN where it passes the edge."""
    inside = (track + 180.0) % 360.0 - 180.0
    jumps = np.flatnonzero(np.abs(np.diff(inside, axis=0)).max(axis=1) > 180.0) + 1
    return np.insert(inside, jumps, np.nan, axis=0)


FIG5 = Experiment(
    "fig5",
    "3.4",
    "Field of the gradient, from [-100, 30] deg",
    "The loss over both angles of the planar arm, its falling gradient as arrows, and the descent of Fig. 4 "
    "with both signs the paper prints for the second joint. Minima are looked for by descents from a grid of "
    "starts.",
    partial(
        run,
        "Fig. 5: field of the gradient",
        {"[-100, 30] deg": START_FIG4, "[-100, -30] deg": START_TEXT},
        PRINTED_ANGLES,
    ),
)
FIG7 = Experiment(
    "fig7",
    "3.4",
    "Field of the gradient, from [-50, -50] deg",
    "The same field with the descent of Fig. 6, which goes to the minimum whose basin the start lies in: not "
    "the nearest.",
    partial(run, "Fig. 7: field of the gradient", {"[-50, -50] deg": START_FIG6}, None),
)
