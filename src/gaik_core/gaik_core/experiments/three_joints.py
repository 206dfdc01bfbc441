"""Section 5.3, first test, Figs. 14 and 15: both algorithms move the arm of Fig. 13 from one home to one point.

"The gradients are used to move the end-effector to the desired position p_des = [0.2, 0.4, 0.2] using the same
home position (θ(0) = [180.0, 0.0, 90.0]), learning rate (α = 0.5) and update rule (gradient descent)", with
l1 = l2 = 0.4 m.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from matplotlib.figure import Figure

from gaik_core.chain import KinematicChain
from gaik_core.experiments import drawing
from gaik_core.experiments.arms import scaled_to_reach
from gaik_core.experiments.both_algebras import Both, compare, degrees, solve_both, trace, updates
from gaik_core.experiments.findings import Experiment, Findings
from gaik_core.solver import Solution
from gaik_core.update_rules import GradientDescent

ARM = scaled_to_reach(KinematicChain.load("arm3"), 0.8)  # two links of 0.4 m
TARGET = np.array([0.2, 0.4, 0.2])
START = np.radians([180.0, 0.0, 90.0])
RULE = GradientDescent(0.5)
NEAR = 1e-3  # m


def descend() -> tuple[Both, Both]:
    """Until the tip is 1 mm from the point, and to the very end."""
    return (
        solve_both(ARM, TARGET, START, RULE, tolerance=NEAR),
        solve_both(ARM, TARGET, START, RULE, tolerance=1e-10, max_iterations=5000),
    )


def run(title: str, picture: str) -> Findings:
    """Both algorithms."""
    near, end = descend()
    return Findings(
        comparisons=[
            compare("joints at the end", "deg", None, end, degrees),
            compare("joints at 1 mm", "deg", None, near, degrees),
            compare("updates to 1 mm", "", None, near, updates, 0),
        ],
        iterates={"to 1 mm": near.iterates, "to the end": end.iterates},
        draw=partial({"errors": draw_errors, "poses": draw_poses}[picture], title, near),
    )


def draw_errors(title: str, near: Both) -> Figure:
    """Error and joints against updates, quaternions above and conformal algebra below."""
    figure = drawing.new_figure(9.0, 6.4)
    figure.suptitle(title)
    for (left, right), (name, solution) in zip(figure.subplots(2, 2), _named(near), strict=True):
        drawing.error_against_updates(left, trace(solution).error, color=drawing.WAY)
        left.axhline(NEAR, color=drawing.DESIRED, linestyle="--", linewidth=1.0, label="1 mm")
        left.set(title=f"{name}: error", yscale="log", xlim=(0, solution.iterations))
        left.legend()
        drawing.joints_against_updates(right, trace(solution).angles)
        right.set_title(f"{name}: joints")
        right.legend(loc="center right")
    return figure


def draw_poses(title: str, near: Both) -> Figure:
    """The arm's way in space, quaternions left and conformal algebra right."""
    figure = drawing.new_figure(10.4, 5.2)
    figure.suptitle(title)
    for position, (name, solution) in zip((121, 122), _named(near), strict=True):
        axes = drawing.space(figure, position, name, elevation=22.0, azimuth=-62.0)
        drawing.arm_on_its_way(axes, ARM, trace(solution).angles, TARGET, up="y")
        drawing.finish_space(axes, up="y", zoom=0.92)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure


def _named(solved: Both) -> tuple[tuple[str, Solution], tuple[str, Solution]]:
    return ("Quaternion algebra", solved.quaternion), ("Conformal algebra", solved.conformal)


ABOUT = (
    "The arm of Fig. 13, as eq. 63 defines it, with 0.4 m links descends from [180, 0, 90] deg to [0.2, 0.4, 0.2] m "
    "with α = 0.5. "
)
FIG14 = Experiment(
    "fig14",
    "5.3",
    "Three joints by both algorithms: error and joints",
    ABOUT + "Error and joints against updates, by either algorithm.",
    partial(run, "Fig. 14: error and joints by both algorithms", "errors"),
)
FIG15 = Experiment(
    "fig15",
    "5.3",
    "Three joints by both algorithms: poses",
    ABOUT + "The same descents in space.",
    partial(run, "Fig. 15: poses by both algorithms", "poses"),
)
