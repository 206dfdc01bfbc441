"""Section 4.3, first experiment, Fig. 9: planar chains of two to six joints reach a set of positions.

"Different 2D kinematic chains were employed to reach a set of end-effector positions, by considering different
joint numbers": each position from the same home, by the update rule (53), until 𝓛 < 0.01 m² (eq. 48: 0.1 m).
"""

from __future__ import annotations

from functools import partial

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from gaik_core.chain import KinematicChain
from gaik_core.experiments import drawing
from gaik_core.experiments.arms import scaled_to_reach
from gaik_core.experiments.both_algebras import Both, joined, solve_both, trace
from gaik_core.experiments.findings import Comparison, Erratum, Experiment, Findings
from gaik_core.update_rules import GradientDescent

Array = NDArray[np.float64]

SQUARED_DISTANCE = 0.01  # m², what 𝓛 of eq. 48 must fall below
TOLERANCE = float(np.sqrt(SQUARED_DISTANCE))

# The paper prints none of these.
REACH = 3.0  # m
BEND = np.radians(60.0)  # of the whole arm at home, spread evenly over its joints
RATE = 0.02  # rad²/m², below 2/σ² for every arm here
_BEARINGS = np.radians([150.0, 110.0, 70.0, 30.0, -10.0])
TARGETS = 1.8 * np.stack([np.cos(_BEARINGS), np.sin(_BEARINGS), np.zeros(5)], axis=1)


def chains() -> list[KinematicChain]:
    """Arms of two to six equal links, all of one reach."""
    return [scaled_to_reach(KinematicChain.load(f"planar{joints}"), REACH) for joints in range(2, 7)]


def home(chain: KinematicChain) -> Array:
    """A slightly bent arm: a stretched one could not shorten."""
    return np.full(chain.dof, BEND / chain.dof)


def reach_all(chain: KinematicChain) -> list[Both]:
    """Every position from home."""
    return [
        solve_both(chain, target, home(chain), GradientDescent(RATE), TOLERANCE, 2000) for target in TARGETS
    ]


def run() -> Findings:
    """Two to six joints."""
    solved = {chain.dof: (chain, reach_all(chain)) for chain in chains()}
    comparisons = [
        Comparison(
            "positions reached, of all",
            "",
            5 * len(TARGETS),
            sum(both.quaternion.converged for _, solves in solved.values() for both in solves),
            sum(both.conformal.converged for _, solves in solved.values() for both in solves),
            0,
            'the paper: "capable of solving the position inverse kinematics for all cases"',
        )
    ]
    for joints, (_, solves) in solved.items():
        by_quaternions = [both.quaternion.iterations for both in solves]
        by_conformal = [both.conformal.iterations for both in solves]
        comparisons.append(Comparison(f"updates, {joints} joints", "", None, by_quaternions, by_conformal, 0))
    left = [both.quaternion.error for _, solves in solved.values() for both in solves]
    return Findings(
        comparisons=comparisons,
        iterates={f"{joints} joints": joined(solves) for joints, (_, solves) in solved.items()},
        draw=partial(draw, solved),
        errata=[
            Erratum(
                where="4.3, stop",
                printed='"the distance (47) fell below 𝓛 < 0.01 m²"',
                holds="m² is the unit of eq. 48, the square of eq. 47: the tip stops 0.1 m away, not 0.01 m",
                measured=f"the tip stops {min(left):.4f} to {max(left):.4f} m away",
                confirmed=0.01 < max(left) < TOLERANCE,
            )
        ],
    )


def draw(solved: dict[int, tuple[KinematicChain, list[Both]]]) -> Figure:
    """One panel for each arm, and the errors of all against updates."""
    figure = drawing.new_figure(11.0, 7.4)
    figure.suptitle("Fig. 9: planar chains of two to six joints")
    panels = figure.subplots(2, 3).ravel()
    for axes, (joints, (chain, solves)) in zip(panels, solved.items(), strict=False):
        for both in solves:
            drawing.line(axes, chain.forward(trace(both.quaternion).angles), color=drawing.WAY, zorder=4)
            drawing.arm(axes, chain, both.quaternion.angles, color=drawing.END, linewidth=1.2, alpha=0.75)
        drawing.arm(axes, chain, home(chain), color=drawing.START, linewidth=2.4)
        drawing.points(axes, TARGETS, color=drawing.DESIRED, marker="x", s=40, zorder=6)
        drawing.plane(axes, f"{joints} joints", (-2.1, 3.3), (-1.6, 3.0))
    last = panels[-1]
    for colour, (joints, (_, solves)) in zip(drawing.JOINTS, solved.items(), strict=False):
        slowest = max((both.quaternion for both in solves), key=lambda solution: solution.iterations)
        drawing.error_against_updates(last, trace(slowest).error, color=colour, label=f"{joints} joints")
    last.axhline(TOLERANCE, color=drawing.DESIRED, linestyle="--", linewidth=1.0, label="stop: 0.1 m")
    last.set(yscale="log", title="distance to the slowest position")
    last.legend()
    figure.legend(
        handles=[
            drawing.key("home", color=drawing.START, linewidth=2.4),
            drawing.key("way of the tip", color=drawing.WAY),
            drawing.key("arm at each position", color=drawing.END),
            drawing.key("desired positions", color=drawing.DESIRED, marker="x", linestyle=""),
        ],
        loc="outside lower center",
        ncols=4,
    )
    return figure


FIG9 = Experiment(
    "fig9",
    "4.3",
    "Planar chains of two to six joints",
    "Five positions on an arc of 1.8 m, each from the same home. The paper prints neither lengths nor "
    "positions nor the learning rate; assumed are equal links that together measure 3 m, a home bent by 60 "
    "deg in all, and α = 0.02.",
    run,
)
