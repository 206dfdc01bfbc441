"""Section 4.3, second experiment, Figs. 11 and 12: five joints along an inclined circle and a lemniscate.

"The kinematic arm presented in Fig. 10 was employed to solve two end-effector trajectories: an inclined circle
and a lemniscate of Bernoulli with a length of m = 126 points. The joint position was updated iteratively
[until] the distance fell below the threshold 𝓛 < 0.01 m². Once a point on the trajectory is reached, the
current joint positions are taken as a starting point for the next calculation. For visual purposes an
additional quadratic interpolation was carried out from the home position to the first point solved on the
trajectories."
"""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from gaik_core.chain import KinematicChain
from gaik_core.experiments import drawing
from gaik_core.experiments.both_algebras import Both, joined, solve_path_both
from gaik_core.experiments.findings import Comparison, Experiment, Findings
from gaik_core.experiments.planar_chains import TOLERANCE
from gaik_core.paths import PAPER_STEP, Circle, Lemniscate, Path
from gaik_core.update_rules import GradientDescent

Array = NDArray[np.float64]

ARM = KinematicChain.load("arm5")
POINTS = 126

# The paper prints none of these.
CENTRE, TILT = (4.5, 0.0, 2.0), np.radians(30.0)
CIRCLE = Circle(radius=2.0, tilt=TILT, centre=CENTRE)
LEMNISCATE = Lemniscate(half_width=2.5, tilt=TILT, centre=CENTRE)
RATE = 0.01  # rad²/m²
FINE = 1e-3  # m, a tolerance for comparison
APPROACH_STEPS = 25


class Followed(NamedTuple):
    """A path as the arm follows it.

    Attributes:
        desired: (m, 3) the path's points (m).
        solves: (m,) each from where the one before ended.
        fine: the same with a tolerance of 1 mm.
    """

    desired: Array
    solves: list[Both]
    fine: list[Both]

    def angles(self, algebra: str = "quaternion") -> Array:
        """Joints at each point (m, dof)."""
        return ends(self.solves, algebra)


def follow(path: Path) -> Followed:
    """Solve the 126 points in order, from home."""
    desired = path.points(POINTS)
    rule = GradientDescent(RATE)
    return Followed(
        desired,
        solve_path_both(ARM, desired, ARM.home, rule, TOLERANCE, 5000),
        solve_path_both(ARM, desired, ARM.home, rule, FINE, 5000),
    )


def ends(solves: list[Both], algebra: str = "quaternion") -> Array:
    """The angles (m, dof) each solve ended at."""
    return np.array([getattr(both, algebra).angles for both in solves])


def approach(first: Array) -> Array:
    """From home to the first point, (steps, dof): θ = θ_home + (θ_first - θ_home) s², which leaves home at rest."""
    share = np.linspace(0.0, 1.0, APPROACH_STEPS, endpoint=False)[:, None]
    result: Array = ARM.home + (first - ARM.home) * share**2
    return result


def run(title: str, path: Path) -> Findings:
    """Follow one path."""
    followed = follow(path)
    rows = []
    for algebra in ("quaternion", "conformal"):
        solutions = [getattr(both, algebra) for both in followed.solves]
        fine = [getattr(both, algebra) for both in followed.fine]
        rows.append(
            {
                "reached": sum(solution.converged for solution in solutions),
                "updates": sum(solution.iterations for solution in solutions),
                "first": solutions[0].iterations,
                "error": max(solution.error for solution in solutions),
                "fine_updates": sum(solution.iterations for solution in fine),
                "fine_error": max(solution.error for solution in fine),
            }
        )
    q, c = rows
    return Findings(
        comparisons=[
            Comparison("points reached", "", POINTS, q["reached"], c["reached"], 0),
            Comparison("updates over all points", "", None, q["updates"], c["updates"], 0),
            Comparison("updates to the first point, from home", "", None, q["first"], c["first"], 0),
            Comparison("largest distance left", "m", None, q["error"], c["error"], 5),
            Comparison("updates over all points, to 1 mm", "", None, q["fine_updates"], c["fine_updates"], 0),
            Comparison("largest distance left, to 1 mm", "m", None, q["fine_error"], c["fine_error"], 6),
        ],
        iterates={"0.1 m": joined(followed.solves), "1 mm": joined(followed.fine)},
        draw=partial(draw, title, followed),
        numbers={"angles": followed.angles(), "desired": followed.desired},
    )


def draw(title: str, followed: Followed) -> Figure:
    """Joints against time above, the arm in space below."""
    figure = drawing.new_figure(9.0, 8.8)
    figure.suptitle(title)
    parts: Any = figure.subfigures(2, 1, height_ratios=(1.0, 1.6))
    above, below = parts
    joints = above.subplots()
    angles = followed.angles()
    coming = approach(angles[0])
    time = PAPER_STEP * np.arange(-len(coming), len(angles))
    fine = np.degrees(ends(followed.fine))
    for joint, track in enumerate(np.degrees(np.concatenate([coming, angles])).T):
        joints.plot(
            time,
            track,
            color=drawing.JOINTS[joint],
            label=f"{drawing.joint_label(joint)} {ARM.joint_names[joint]}",
        )
        joints.plot(
            time[len(coming) :], fine[:, joint], color=drawing.JOINTS[joint], linewidth=0.8, linestyle="--"
        )
    joints.axvspan(time[0], 0.0, color="0.93", label="from home")
    joints.plot([], [], "k--", linewidth=0.8, label="to 1 mm")
    joints.set(
        xlabel="path parameter t (rad), taken as time (s)",
        ylabel="joint angle (deg)",
        xlim=(time[0], time[-1]),
    )
    joints.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    _draw_in_space(below, followed, coming)
    return figure


def _draw_in_space(figure: Figure, followed: Followed, coming: Array) -> None:
    axes = drawing.space(figure, 111, elevation=24.0, azimuth=-55.0)
    angles = followed.angles()
    for step in range(0, len(angles), 14):
        drawing.arm(axes, ARM, angles[step], color="0.7", linewidth=1.0, markersize=2.5)
    drawing.arm(axes, ARM, ARM.home, color=drawing.START, linewidth=2.4, label="home")
    drawing.arm(axes, ARM, angles[-1], color=drawing.END, linewidth=2.4, label="arm at the last point")
    tips = ARM.forward(np.concatenate([coming, angles]))
    drawing.line(axes, tips[: len(coming) + 1], color=drawing.WAY, linestyle=":", label="tip, from home")
    drawing.line(
        axes, followed.desired, color=drawing.DESIRED, linewidth=2.6, alpha=0.5, label="desired path"
    )
    drawing.line(axes, tips[len(coming) :], color=drawing.WAY, label="tip")
    drawing.finish_space(axes, zoom=1.2)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=5)


ASSUMED = (
    "The paper prints neither the path's size and place nor the learning rate; assumed are the joint order of "
    "the robot file, {path}, tilted by 30 deg about x and centred at [4.5, 0, 2] m, α = 0.01, and an approach "
    "that goes by the square of time. Updates stop within 0.1 m of each point, so the tip runs beside the "
    "path; the dashed lines are the same to 1 mm."
)

FIG11 = Experiment(
    "fig11",
    "4.3",
    "Five joints along an inclined circle",
    ASSUMED.format(path="a circle of 2 m radius"),
    partial(run, "Fig. 11: five joints along an inclined circle", CIRCLE),
)
FIG12 = Experiment(
    "fig12",
    "4.3",
    "Five joints along Bernoulli's lemniscate",
    ASSUMED.format(path="a lemniscate of 2.5 m half width"),
    partial(run, "Fig. 12: five joints along Bernoulli's lemniscate", LEMNISCATE),
)
