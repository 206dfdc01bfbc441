"""Section 6.2, Figs. 18 and 19: the Geomagic Touch descends from one pose to a point.

"The initial conditions of the angles of the haptic device are θ(0) = [57.29, 0, -57.29]; this configuration
results in the end-effector being located at [-0.0614, -0.2236, -0.1306] m, with a desired position at p_d = [0,
0, 0] m. Fig. 18 shows the change of the angles through the first 30 iterations, the Euclidean error and how it
converges to zero."
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from gaik_core.chain import KinematicChain
from gaik_core.experiments import drawing
from gaik_core.experiments.both_algebras import Both, compare, degrees, error, solve_both, trace, updates
from gaik_core.experiments.findings import Comparison, Erratum, Experiment, Findings
from gaik_core.update_rules import GradientDescent

Array = NDArray[np.float64]

ARM = KinematicChain.load("touch")
START, TARGET = np.radians([57.29, -57.29, 0.0]), np.array([0.05, 0.05, 0.0])  # corrected
PRINTED_START, PRINTED_TARGET = np.radians([57.29, 0.0, -57.29]), np.zeros(3)
PRINTED_POSITION = (-0.0614, -0.2236, -0.1306)  # m, of the start
PRINTED_ANGLES = (-16.39, 56.51, 49.54)  # deg, of the end
RULE = GradientDescent(20.0)  # the paper prints no α; with 20 the descent takes about its 30 updates
UPDATES = 30
NEAR = 1e-4  # m


def descend(start: Array, target: Array) -> Both:
    """The first 30 updates."""
    return solve_both(ARM, target, start, RULE, max_iterations=UPDATES)


def run_fig18() -> Findings:
    """The corrected start and target, the printed ones beside them."""
    corrected, printed = descend(START, TARGET), descend(PRINTED_START, PRINTED_TARGET)
    near = solve_both(ARM, TARGET, START, RULE, NEAR)
    end = solve_both(ARM, TARGET, START, RULE, 1e-10)
    origin = solve_both(ARM, PRINTED_TARGET, START, RULE, 1e-10)
    as_printed = "joints after 30 updates, printed start and target"
    return Findings(
        comparisons=[
            compare("joints after 30 updates", "deg", PRINTED_ANGLES, corrected, degrees, 2),
            compare("joints at the end", "deg", PRINTED_ANGLES, end, degrees, 2),
            compare("error after 30 updates", "m", None, corrected, error, 6),
            compare("updates to 0.1 mm", "", None, near, updates, 0),
            compare(as_printed, "deg", PRINTED_ANGLES, printed, degrees, 2),
        ],
        iterates={
            "corrected": end.iterates,
            "corrected, 30 updates": corrected.iterates,
            "printed": printed.iterates,
            "to the origin": origin.iterates,
        },
        draw=partial(draw_updates, corrected, printed),
        errata=[_start(), _target(end, origin)],
    )


def run_fig19() -> Findings:
    """The same descents in space."""
    corrected, printed = descend(START, TARGET), descend(PRINTED_START, PRINTED_TARGET)
    return Findings(
        comparisons=[
            _position("position of the corrected start", PRINTED_POSITION, START),
            _position("position of the printed start", PRINTED_POSITION, PRINTED_START),
            _position("position of the printed solution", PRINTED_TARGET, np.radians(PRINTED_ANGLES)),
        ],
        iterates={"corrected": corrected.iterates, "printed": printed.iterates},
        draw=partial(draw_space, corrected, printed),
    )


def _position(quantity: str, printed: Any, angles: Array) -> Comparison:
    return Comparison(
        quantity, "m", printed, ARM.forward(angles, "quaternion"), ARM.forward(angles, "conformal"), 4
    )


def _start() -> Erratum:
    corrected, printed = ARM.forward(START), ARM.forward(PRINTED_START)
    return Erratum(
        where="6.2, start",
        printed="θ(0) = [57.29, 0, -57.29]",
        holds="[57.29, -57.29, 0], which gives the printed position",
        measured=f"corrected: {_metres(corrected)}; printed: {_metres(printed)}",
        confirmed=bool(
            np.allclose(corrected, PRINTED_POSITION, atol=5e-5)
            and not np.allclose(printed, PRINTED_POSITION, atol=0.1)
        ),
    )


def _target(end: Both, origin: Both) -> Erratum:
    there = ARM.forward(np.radians(PRINTED_ANGLES))
    solution = ", ".join(f"{angle:.2f}" for angle in degrees(origin.quaternion) + 0.0)
    return Erratum(
        where="6.2, target",
        printed="p_d = [0, 0, 0]",
        holds="[0.05, 0.05, 0]",
        measured=f"the printed solution [-16.39, 56.51, 49.54] deg is at {_metres(there)}; for [0, 0, 0] it "
        f"is [{solution}] deg",
        confirmed=bool(
            np.allclose(there, TARGET, atol=1e-4)
            and np.allclose(degrees(end.quaternion), PRINTED_ANGLES, atol=0.02)
        ),
    )


def _metres(point: Array) -> str:
    return "[" + ", ".join(f"{value:.4f}" for value in point + 0.0) + "] m"


def draw_updates(corrected: Both, printed: Both) -> Figure:
    """Joints and error over 30 updates: corrected above, as printed below."""
    figure = drawing.new_figure(9.4, 6.6)
    figure.suptitle("Fig. 18: the Touch over the first 30 updates")
    named = (
        ("from [57.29, -57.29, 0] deg to [0.05, 0.05, 0] m (corrected)", corrected),
        ("from [57.29, 0, -57.29] deg to [0, 0, 0] m (as printed)", printed),
    )
    parts: Any = figure.subfigures(2, 1)
    for part, (title, solved) in zip(parts, named, strict=True):
        part.suptitle(title)
        left, right = part.subplots(1, 2)
        drawing.joints_against_updates(left, trace(solved.quaternion).angles, PRINTED_ANGLES)
        left.legend(ncols=2)
        drawing.error_against_updates(
            right, trace(solved.quaternion).error, color=drawing.DESIRED, label="error"
        )
        right.set_xlim(0, UPDATES)
        right.set_ylim(bottom=0.0)
        right.legend()
    return figure


def field_in_space(count: int = 5) -> tuple[Array, Array]:
    """Where the tip is (m, 3) over a grid of poses, and where one small update would move it: J Jᵀ (p_d - p_f)."""
    grid = np.meshgrid(
        np.radians(np.linspace(-60.0, 60.0, count + 2)),
        np.radians(np.linspace(-60.0, 90.0, count)),
        np.radians(np.linspace(0.0, 90.0, count)),
    )
    poses = np.stack([angles.ravel() for angles in grid], axis=1)
    tips = ARM.forward(poses)
    moves = [(j := ARM.jacobian(pose)) @ j.T @ (TARGET - tip) for pose, tip in zip(poses, tips, strict=True)]
    return tips, np.array(moves)


def field_of_joints(count: int = 6) -> tuple[Array, Array]:
    """A grid of angles (m, 3) and the falling gradient Jᵀ (p_d - p_f) at each."""
    lowest, highest = np.radians([-40.0, -75.0, -10.0]), np.radians([75.0, 75.0, 75.0])
    axes = [np.linspace(low, high, count) for low, high in zip(lowest, highest, strict=True)]
    poses = np.stack([angles.ravel() for angles in np.meshgrid(*axes)], axis=1)
    falls = [ARM.jacobian(pose).T @ (TARGET - ARM.forward(pose)) for pose in poses]
    return poses, np.array(falls)


def draw_space(corrected: Both, printed: Both) -> Figure:
    """A: the field over the joints. B: the field over the tip's positions. C: the tip's path and the links."""
    figure = drawing.new_figure(13.0, 5.4)
    grid = figure.add_gridspec(1, 3, width_ratios=(1.0, 1.1, 0.9))
    figure.suptitle("Fig. 19: the Touch from [57.29, -57.29, 0] deg to [0.05, 0.05, 0] m")
    track = trace(corrected.quaternion).angles
    _draw_joint_field(figure, grid[0], np.degrees(track))
    between = drawing.space(
        figure, grid[1], "B) where an update moves the tip", elevation=22.0, azimuth=-50.0
    )
    tips, moves = field_in_space()
    drawing.arrows(between, tips, moves, "y", length=0.03, color="0.6", linewidth=0.7)
    drawing.line(between, ARM.forward(track), "y", color=drawing.WAY, linewidth=2.2, label="way of the tip")
    drawing.points(between, TARGET[None], "y", color=drawing.DESIRED, marker="x", s=45, label="desired point")
    drawing.finish_space(between, up="y", zoom=0.88)
    last = drawing.space(figure, grid[2], "C) the arm", elevation=22.0, azimuth=-50.0)
    drawing.arm_on_its_way(last, ARM, track, TARGET, "y")
    other = ARM.forward(trace(printed.quaternion).angles)
    drawing.line(last, other, "y", color=drawing.WAY, linestyle=":", label="as printed")
    drawing.finish_space(last, up="y", zoom=0.88)
    figure.legend(*last.get_legend_handles_labels(), loc="outside lower center", ncols=5)
    return figure


def _draw_joint_field(figure: Figure, position: Any, track: Array) -> None:
    axes = figure.add_subplot(position, projection="3d")
    poses, falls = field_of_joints()
    axes.quiver(*np.degrees(poses).T, *falls.T, length=13.0, normalize=True, color="0.6", linewidth=0.7)
    axes.plot(*track.T, color=drawing.WAY, linewidth=2.2)
    axes.scatter(*track[-1], color=drawing.DESIRED, marker="x", s=45)
    axes.set_title("A) falling gradient over the joints")
    axes.set(xlabel=r"$\theta_1$ (deg)", ylabel=r"$\theta_2$ (deg)", zlabel=r"$\theta_3$ (deg)")
    axes.set_box_aspect((1, 1, 1), zoom=0.88)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_major_locator(MaxNLocator(4))
    axes.tick_params(pad=2)
    axes.view_init(22.0, -50.0)


ABOUT = (
    "The paper's model of the Touch (eq. 78) descends with α = 20 from the corrected start to the corrected "
    "target. The paper prints no α. "
)
FIG18 = Experiment(
    "fig18",
    "6.2",
    "The Touch over 30 updates",
    ABOUT
    + "Above, joints and error; below, the same from the printed start to the printed target. Dotted: the printed "
    "solution.",
    run_fig18,
)
FIG19 = Experiment(
    "fig19",
    "6.2",
    "The Touch in space",
    ABOUT
    + "A: the falling gradient over the three joints. B: where one update moves the tip, over poses of the arm. "
    "C: the tip's path and the links; dotted, the tip's path from the printed start to the printed target.",
    run_fig19,
)
