"""Section 3.4, Figs. 4 and 6: a planar arm of two joints descends to one point from two starts.

"The update rule (42) was employed to move the system to the desired end-effector position p_d = [0.0292,
0.1267], starting from the home position θ(0) = [-100, 30] with manipulator dimensions l1 = 0.1 m and l2 = 0.1
m", and then "from a different home position θ(0) = [-50, -50]".
"""

from __future__ import annotations

from functools import partial

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from gaik_core.chain import KinematicChain
from gaik_core.experiments import drawing
from gaik_core.experiments.both_algebras import Both, compare, degrees, error, solve_both, trace
from gaik_core.experiments.findings import Comparison, Erratum, Experiment, Findings
from gaik_core.update_rules import GradientDescent

Array = NDArray[np.float64]

ARM = KinematicChain.load("planar2")
TARGET = np.array([0.0292, 0.1267, 0.0])
START_FIG4, START_FIG6 = np.radians([-100.0, 30.0]), np.radians([-50.0, -50.0])
START_TEXT = np.radians([-100.0, -30.0])  # what the text prints where it comes to the solution
PRINTED_RATE, PRINTED_UPDATES = 10.0, 30
WORKING_RATE = 50.0  # with it, 30 updates give the printed angles to 0.03 deg
PRINTED_ANGLES = (27.5416, 98.9168)  # deg


def closed_form(target: Array) -> Array:
    """Both solutions (2, 2) of the arm of two links by the law of cosines, elbow angle positive first (rad)."""
    l1, l2 = (joint.link[0] for joint in ARM.joints)
    cosine = (target[0] ** 2 + target[1] ** 2 - l1**2 - l2**2) / (2.0 * l1 * l2)
    elbow = np.array([1.0, -1.0]) * np.arccos(cosine)
    shoulder = np.arctan2(target[1], target[0]) - np.arctan2(l2 * np.sin(elbow), l1 + l2 * np.cos(elbow))
    return np.stack([shoulder, elbow], axis=1)


def descend(start: Array, rate: float) -> Both:
    """The paper's 30 updates."""
    return solve_both(ARM, TARGET, start, GradientDescent(rate), max_iterations=PRINTED_UPDATES)


def descend_to_the_end(start: Array) -> Both:
    """As many updates as it takes, by the printed rate."""
    return solve_both(ARM, TARGET, start, GradientDescent(PRINTED_RATE), tolerance=1e-10, max_iterations=5000)


def run_fig4() -> Findings:
    """From [-100, 30] deg, with the step the paper prints and with the one that gives its result."""
    printed, working = descend(START_FIG4, PRINTED_RATE), descend(START_FIG4, WORKING_RATE)
    end, other = descend_to_the_end(START_FIG4), descend_to_the_end(START_TEXT)
    exact = np.degrees(closed_form(TARGET)[0])
    return Findings(
        comparisons=[
            compare("joints after 30 updates, α = 50", "deg", PRINTED_ANGLES, working, degrees),
            compare("joints after 30 updates, α = 10 as printed", "deg", PRINTED_ANGLES, printed, degrees),
            compare("joints at the minimum", "deg", PRINTED_ANGLES, end, degrees),
            Comparison("joints at the minimum, by the law of cosines", "deg", PRINTED_ANGLES, exact, exact),
            compare("error after 30 updates, α = 50", "m", None, working, error, 6),
            compare("error after 30 updates, α = 10", "m", None, printed, error, 6),
        ],
        iterates={
            "α = 10": printed.iterates,
            "α = 50": working.iterates,
            "end": end.iterates,
            "-30": other.iterates,
        },
        draw=partial(draw, "Fig. 4: two joints from [-100, 30] deg", printed, working),
        errata=[_start(end, other), _learning_rate(printed, working)],
    )


def run_fig6() -> Findings:
    """From [-50, -50] deg: the other elbow."""
    printed, working = descend(START_FIG6, PRINTED_RATE), descend(START_FIG6, WORKING_RATE)
    end = descend_to_the_end(START_FIG6)
    exact = np.degrees(closed_form(TARGET)[1])
    return Findings(
        comparisons=[
            compare("joints at the minimum", "deg", None, end, degrees),
            Comparison("joints at the minimum, by the law of cosines", "deg", None, exact, exact),
            compare("joints after 30 updates, α = 50", "deg", None, working, degrees),
            compare("joints after 30 updates, α = 10", "deg", None, printed, degrees),
            compare("error after 30 updates, α = 50", "m", None, working, error, 6),
            compare("error after 30 updates, α = 10", "m", None, printed, error, 6),
        ],
        iterates={"α = 10": printed.iterates, "α = 50": working.iterates, "end": end.iterates},
        draw=partial(draw, "Fig. 6: two joints from [-50, -50] deg", printed, working),
    )


def _start(end: Both, other: Both) -> Erratum:
    exact = np.degrees(closed_form(TARGET)[0])
    reached, missed = degrees(end.quaternion), degrees(other.quaternion)
    return Erratum(
        where="3.4, start",
        printed="[-100, 30], later θ2 = -30",
        holds="only +30 leads to the printed solution",
        measured=f"+30 ends at [{reached[0]:.4f}, {reached[1]:.4f}] deg, -30 at [{missed[0]:.4f}, "
        f"{missed[1]:.4f}] deg; exact [{exact[0]:.4f}, {exact[1]:.4f}] deg",
        confirmed=bool(np.allclose(reached, exact, atol=1e-4) and missed[1] < 0.0),
    )


def _learning_rate(printed: Both, working: Both) -> Erratum:
    angles = degrees(printed.quaternion)
    near = degrees(working.quaternion)
    return Erratum(
        where="3.4, α",
        printed="30 iterations with α = 10",
        holds="about α = 50",
        measured=f"after 30 updates α = 10 is at [{angles[0]:.3f}, {angles[1]:.3f}] deg with "
        f"{printed.quaternion.error:.5f} m left, α = 50 at [{near[0]:.4f}, {near[1]:.4f}] deg with "
        f"{working.quaternion.error:.1e} m",
        confirmed=bool(printed.quaternion.error > 0.01 and np.abs(near - PRINTED_ANGLES).max() < 0.1),
    )


def draw(title: str, printed: Both, working: Both) -> Figure:
    """The arm's way with either step, and the squared error against updates."""
    figure = drawing.new_figure(11.0, 4.4)
    figure.suptitle(title)
    left, middle, right = figure.subplots(1, 3)
    solves = ((left, PRINTED_RATE, printed), (middle, WORKING_RATE, working))
    for axes, rate, solved in solves:
        drawing.arm_on_its_way(axes, ARM, solved.quaternion.trace.angles, TARGET)  # type: ignore[union-attr]
        drawing.plane(axes, rf"$\alpha$ = {rate:g}, {PRINTED_UPDATES} updates", (-0.16, 0.2), (-0.22, 0.2))
    for (_, rate, solved), colour in zip(solves, (drawing.START, drawing.WAY), strict=True):
        squared = trace(solved.quaternion).error ** 2
        right.semilogy(squared, color=colour, label=rf"$\alpha$ = {rate:g}: ends at {squared[-1]:.1e} m²")
    right.set(xlabel="update", ylabel="squared error (m²)", title="squared error")
    right.set_xlim(0, PRINTED_UPDATES)
    right.legend()
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure


FIG4 = Experiment(
    "fig4",
    "3.4",
    "Two joints from [-100, 30] deg",
    "A planar arm of two 0.1 m links descends to [0.0292, 0.1267] m. Left and middle: the arm's way with the "
    "step the paper prints and with the step that gives its result; right: the squared error.",
    run_fig4,
)
FIG6 = Experiment(
    "fig6",
    "3.4",
    "Two joints from [-50, -50] deg",
    "The same arm and point from another start, which leads to the other elbow. The paper prints no numbers here.",
    run_fig6,
)
