"""Section 3.3: joint velocities by eq. 38, the pseudo-inverse's beside them, and the claim of the nearest solution.

"If β = α/Δt is proposed, the final equation to obtain the inverse kinematics of velocity can be described as
θ' = β 𝓛 J", where 𝓛 is the error of position. Followed period by period it is a loop: each period the desired
point moves on, and the joints turn by θ' Δt. Where the point moves with velocity v, the error settles where
J Jᵀ β e = v, and then β Jᵀ e = J⁺ v: the pseudo-inverse's rates. It settles with the time constants 1/(β σ²) of
the Jacobian's singular values σ, so the two part where the arm is nearly stretched or folded (σ small) for
longer than it takes to pass.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from gaik_core.chain import KinematicChain
from gaik_core.experiments import drawing
from gaik_core.experiments.findings import Comparison, Erratum, Experiment, Findings, Iterates, Table
from gaik_core.experiments.nearest import SLACK, Nearest, measure_nearest
from gaik_core.paths import Circle
from gaik_core.solver import solve_path
from gaik_core.update_rules import LevenbergMarquardt
from gaik_core.velocity import gradient_velocity

Array = NDArray[np.float64]

ARM = KinematicChain.load("planar2")  # section 3.4's, 0.2 m of reach
LAP = 6.3  # s
PATH = Circle(radius=0.07, tilt=0.0, centre=(0.125, 0.0, 0.0))  # from 55 mm to 195 mm of reach
DESCENTS = 1000


class Loop(NamedTuple):
    """How the loop of eq. 38 runs.

    Attributes:
        alpha: learning rate α (rad²/m²).
        period: Δt (s).
    """

    alpha: float
    period: float

    @property
    def beta(self) -> float:
        """β = α/Δt in rad²/(m²·s)."""
        return self.alpha / self.period

    @property
    def label(self) -> str:
        """For legends."""
        return rf"$\beta$ = {self.beta:g}"

    def times(self) -> Array:
        """The begins (m,) of all periods of two laps; the first lap lets the loop settle."""
        periods: Array = np.arange(2.0 * round(LAP / self.period))
        return self.period * periods


LOOPS = (Loop(10.0, 0.01), Loop(40.0, 0.01), Loop(40.0, 0.001))  # α = 10 is 3.4's


class Way(NamedTuple):
    """Joints and their rates along two laps, one row a period.

    Attributes:
        angles: (m, dof) at the begin of each period (rad).
        rates: (m, dof) over it (rad/s).
    """

    angles: Array
    rates: Array


def desired(time: Array) -> tuple[Array, Array]:
    """The path's points (m, 3) and their velocities (m, 3) at times (m,)."""
    turn = 2.0 * np.pi / LAP
    return PATH.position(turn * time), turn * PATH.derivative(turn * time)


def by_pseudo_inverse(loop: Loop) -> Way:
    """The exact joints of every point and the rates J⁺ v there."""
    points, velocities = desired(loop.times())
    angles = solve_path(ARM, points, (-0.5, 1.0), rule=LevenbergMarquardt(), tolerance=1e-9).angles
    rates = [ARM.inverse_velocity(a, v, damping=0.0) for a, v in zip(angles, velocities, strict=True)]
    return Way(angles, np.array(rates))


def by_gradient(loop: Loop, start: Array, algebra: str) -> Way:
    """The rates β 𝓛 J toward where the point will be at the end of each period, and the joints they lead to."""
    points, _ = desired(loop.times() + loop.period)
    way = Way(np.empty((len(points), ARM.dof)), np.empty((len(points), ARM.dof)))
    angles = start
    for period, point in enumerate(points):
        way.angles[period] = angles
        way.rates[period] = gradient_velocity(ARM, angles, point, loop.beta, algebra)
        angles = angles + loop.period * way.rates[period]
    return way


class Followed(NamedTuple):
    """One loop's ways: by the pseudo-inverse, and by the gradient with each algebra."""

    exact: Way
    quaternion: Way
    conformal: Way


def follow(loop: Loop) -> Followed:
    """Two laps, from the first point's exact joints."""
    exact = by_pseudo_inverse(loop)
    start = exact.angles[0]
    return Followed(exact, by_gradient(loop, start, "quaternion"), by_gradient(loop, start, "conformal"))


class Parting(NamedTuple):
    """How far the two parted over the second lap.

    Attributes:
        difference: (m,) |θ'_gradient - θ'_pseudo-inverse| (rad/s).
        relative: root mean square of it over that of the pseudo-inverse's rates.
        worst: the largest (rad/s), and the reach of the arm there (m).
        lag: (m,) distance of the tip from the desired point (m).
    """

    difference: Array
    relative: float
    worst: tuple[float, float]
    lag: Array


def parting(loop: Loop, way: Way, exact: Way) -> Parting:
    """Compare two ways over the second lap."""
    second = slice(len(way.rates) // 2, None)
    difference = np.linalg.norm(way.rates[second] - exact.rates[second], axis=1)
    points, _ = desired(loop.times()[second])
    at = int(difference.argmax())
    return Parting(
        difference,
        float(np.sqrt((difference**2).mean() / (exact.rates[second] ** 2).sum(axis=1).mean())),
        (float(difference[at]), float(np.linalg.norm(points[at]))),
        np.linalg.norm(points - ARM.forward(way.angles[second]), axis=1),
    )


def slowest_time_constant(loop: Loop, exact: Way) -> Array:
    """1/(β σ²) in s along the second lap, with the smallest singular value σ of the Jacobian's rows in the plane."""
    second = exact.angles[len(exact.angles) // 2 :]
    sigma = np.array([np.linalg.svd(ARM.jacobian(angles)[:2], compute_uv=False)[-1] for angles in second])
    result: Array = 1.0 / (loop.beta * sigma**2)
    return result


def run() -> Findings:
    """The path by each loop and algebra, then the nearest solutions."""
    followed = {loop: follow(loop) for loop in LOOPS}
    nearest = {n: measure_nearest(KinematicChain.load(f"planar{n}"), DESCENTS) for n in (2, 3)}
    comparisons = [
        Comparison(
            f"rates differ from the pseudo-inverse's by, β = {loop.beta:g} (RMS)",
            "%",
            None,
            100 * parting(loop, ways.quaternion, ways.exact).relative,
            100 * parting(loop, ways.conformal, ways.exact).relative,
            2,
        )
        for loop, ways in followed.items()
    ] + [
        Comparison(
            f"descents that end at the nearest solution, {n} joints",
            "%",
            100,
            100 * found.share,
            100 * found.share,
            1,
            "the paper claims all; both algebras make the same descents",
        )
        for n, found in nearest.items()
    ]
    return Findings(
        comparisons=comparisons,
        iterates={
            f"β = {loop.beta:g}": Iterates(w.quaternion.angles, w.conformal.angles)
            for loop, w in followed.items()
        }
        | {f"nearest, {n} joints": found.iterates for n, found in nearest.items()},
        draw=partial(draw, followed, nearest[2]),
        tables=[_table(followed)],
        errata=[_claim(nearest)],
    )


def _table(followed: dict[Loop, Followed]) -> Table:
    rows = []
    for loop, ways in followed.items():
        parted = parting(loop, ways.quaternion, ways.exact)
        slowest = 1e3 * slowest_time_constant(loop, ways.exact)
        rows.append(
            (
                f"{loop.alpha:g}",
                f"{1e3 * loop.period:g}",
                f"{loop.beta:g}",
                f"{slowest.min():.1f} to {slowest.max():.0f}",
                f"{100 * parted.relative:.2f}",
                f"{parted.worst[0]:.3f}",
                f"{1e3 * parted.worst[1]:.0f}",
                f"{1e3 * np.sqrt((parted.lag**2).mean()):.2f}",
            )
        )
    return Table(
        "Where β 𝓛 J and the pseudo-inverse part, over one lap",
        (
            "α (rad²/m²)",
            "Δt (ms)",
            "β = α/Δt",
            "slowest time constant 1/(β σ²) along the path (ms)",
            "rates differ by (% RMS)",
            "most (rad/s)",
            "there the reach is (mm)",
            "tip lags by (mm RMS)",
        ),
        rows,
    )


def _claim(nearest: dict[int, Nearest]) -> Erratum:
    parts = [
        f"{n} joints: {100 * found.share:.1f} % of {len(found.went)} descents; the others went "
        f"{found.detour:.2f} times as far (median)"
        for n, found in nearest.items()
    ]
    return Erratum(
        where="3.3, 3.4, abstract",
        printed="descent finds the solution closest to the initial configuration",
        holds="the one whose basin the start lies in: usually, not always, the closest",
        measured="; ".join(parts),
        confirmed=all(0.0 < found.share < 1.0 for found in nearest.values()),
    )


def draw(followed: dict[Loop, Followed], nearest: Nearest) -> Figure:
    """The path, both joints' rates, where they part and why, and the nearest solutions."""
    figure = drawing.new_figure(12.0, 7.2)
    figure.suptitle(r"Section 3.3: joint velocities by $\beta\,\mathcal{L}\,J$ and by the pseudo-inverse")
    panels = figure.subplots(2, 3)
    _draw_path(panels[0, 0], followed)
    for joint in range(ARM.dof):
        _draw_rates(panels[0, 1 + joint], joint, followed)
    _draw_parting(panels[1, 0], followed)
    _draw_time_constant(panels[1, 1], followed)
    _draw_nearest(panels[1, 2], nearest)
    return figure


def _second_lap(loop: Loop) -> Array:
    time = loop.times()
    return time[len(time) // 2 :] - LAP


def _coloured(followed: dict[Loop, Followed]) -> Iterator[tuple[Loop, Followed, str]]:
    for (loop, ways), colour in zip(followed.items(), drawing.JOINTS, strict=False):
        yield loop, ways, colour


def _draw_path(axes: Axes, followed: dict[Loop, Followed]) -> None:
    exact = followed[LOOPS[0]].exact
    half = len(exact.angles) // 2
    for step in np.linspace(0, half, 8, endpoint=False, dtype=int):
        drawing.arm(axes, ARM, exact.angles[step], color=drawing.BETWEEN, linewidth=1.0)
    turn = np.linspace(0.0, 2.0 * np.pi, 200)
    axes.plot(
        ARM.reach * np.cos(turn),
        ARM.reach * np.sin(turn),
        "--",
        color="0.6",
        linewidth=0.9,
        label="limit of the reach",
    )
    drawing.line(
        axes, ARM.forward(exact.angles[:half]), color=drawing.END, linewidth=2.2, label="desired path"
    )
    for loop, ways, colour in _coloured(followed):
        second = ways.quaternion.angles[len(ways.quaternion.angles) // 2 :]
        drawing.line(axes, ARM.forward(second), color=colour, linewidth=1.0, label=loop.label)
    drawing.plane(axes, "path of the tip", (-0.03, 0.23), (-0.11, 0.13))
    axes.legend(loc="upper left", fontsize=7)


def _draw_rates(axes: Axes, joint: int, followed: dict[Loop, Followed]) -> None:
    for loop, ways, colour in _coloured(followed):
        rates = ways.quaternion.rates[len(ways.quaternion.rates) // 2 :, joint]
        axes.plot(_second_lap(loop), rates, color=colour, linewidth=1.0, label=loop.label, zorder=3)
    exact = followed[LOOPS[-1]].exact.rates
    axes.plot(
        _second_lap(LOOPS[-1]),
        exact[len(exact) // 2 :, joint],
        color=drawing.END,
        linewidth=2.4,
        label="pseudo-inverse",
    )
    axes.set(
        xlabel="time (s)",
        ylabel=f"rate of {drawing.joint_label(joint)} (rad/s)",
        title=f"joint {joint + 1}",
        xlim=(0, LAP),
    )
    axes.legend()


def _draw_parting(axes: Axes, followed: dict[Loop, Followed]) -> None:
    for loop, ways, colour in _coloured(followed):
        difference = parting(loop, ways.quaternion, ways.exact).difference
        axes.plot(_second_lap(loop), difference, color=colour, label=loop.label)
    axes.set(
        xlabel="time (s)",
        ylabel="difference of the rates (rad/s)",
        title="where they part",
        xlim=(0, LAP),
        yscale="log",
    )
    axes.legend()


def _draw_time_constant(axes: Axes, followed: dict[Loop, Followed]) -> None:
    for loop, ways, colour in _coloured(followed):
        axes.plot(_second_lap(loop), slowest_time_constant(loop, ways.exact), color=colour, label=loop.label)
    axes.set(
        xlabel="time (s)", ylabel=r"$1/(\beta\,\sigma_{\min}^2)$ (s)", title="why: the slowest time constant"
    )
    axes.set(xlim=(0, LAP), yscale="log")
    axes.legend()


def _draw_nearest(axes: Axes, nearest: Nearest) -> None:
    found, went = np.degrees(nearest.nearest), np.degrees(nearest.went)
    missed = went > SLACK * found
    axes.scatter(
        found[~missed],
        went[~missed],
        s=6,
        color=drawing.WAY,
        label=f"at the nearest ({100 * nearest.share:.0f} %)",
    )
    axes.scatter(
        found[missed],
        went[missed],
        s=6,
        color=drawing.DESIRED,
        label=f"elsewhere ({100 - 100 * nearest.share:.0f} %)",
    )
    axes.set(xlabel="distance to the nearest solution (deg)", ylabel="distance the descent went (deg)")
    axes.set_title("two joints, random starts and targets")
    axes.legend()


VELOCITY = Experiment(
    "velocity",
    "3.3",
    "Joint velocities along a path; the nearest solution",
    "The planar arm of section 3.4 follows a circle that comes within 5 mm of its reach, one lap in 6.3 s. "
    "The rates β 𝓛 J settle to the pseudo-inverse's with the time constants 1/(β σ²), so they part where a "
    "singular value σ of the Jacobian is small, here where the arm is nearly stretched, and less with a "
    "larger β. Apart from it: 1000 descents from random starts to random targets, each end compared with all "
    "solutions of its target.",
    run,
)
