"""Section 6.3, Figs. 21 and 22: the Touch follows a path under the PID controller.

"The PID controller gains are as follows: 3.1 for the proportional, 0.01 for the integral, and 0.3 for the derivative
gain, respectively [...] As can be seen, the proposed inverse kinematics algorithm works correctly, finding the
required joint positions."

The paper shows curves and prints no error. Here the real nodes follow with the twin of the device, and beside them
the same loop without ROS.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gaik_core import KinematicChain, LevenbergMarquardt, solve_path
from gaik_core.errors import GaikError
from gaik_core.experiments import Comparison, Erratum, Experiment, Findings, Iterates, Table
from gaik_core.paths import path_by_name
from gaik_ros.pid import Gains
from gaik_ros.tracking import Run, tip_distances, tracking_error
from touch_sim.loop_margins import TIME_CONSTANT, largest_gain, longest_delay, remaining_share
from touch_sim.simulation import FEED_FORWARD, PERIOD, Settings, simulate

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from touch_sim.demo_run import Results

Array = NDArray[np.float64]
Runs = Sequence[Run]

ARM = KinematicChain.load("touch_device")
PATHS = ("circle", "lemniscate")
ALGEBRAS = ("quaternion", "conformal")

AGREE = 20.0  # %: by no more may the nodes' error differ from that of the loop without ROS
STALL = 0.01  # s: for so long a loop stands still only where something else has the processor
DISTURBED = 0.03  # s: runs whose loops stood still for longer are of the machine, and played again
TRIES = 3
FILTERS = (0.0, 0.01, 0.05)  # s, of the derivative
DELAYS = (0, 1, 2, 3)  # steps of 1 ms
TWIN = 1.0 / TIME_CONSTANT  # 1/s, K/τ of the twin, whose K is 1 rad/(N·m)


# --- the runs --------------------------------------------------------------------------------------------------------


@cache
def follow_with_nodes(algebra: str, feed_forward: bool = False, period: float = PERIOD) -> Results:
    """A lap of each path with the real nodes, the least disturbed of a few tries. GaikError: there is no ROS here."""
    try:
        from touch_sim.isolation import follow_isolated
        from touch_sim.suite import SuiteOptions
    except ModuleNotFoundError as missing:
        from touch_sim.command_line import INSTALL

        name = (missing.name or "").split(".")[0]
        command = f"pip install {INSTALL.get(name, name)}"
        raise GaikError(f"its nodes need the Python module {name}; install it with: {command}") from None
    options = SuiteOptions(algebra=algebra, feed_forward=feed_forward, period=period)
    tries = [follow_isolated(options, PATHS)]
    while longest_gap(tries[-1].runs) > DISTURBED and len(tries) < TRIES:
        tries.append(follow_isolated(options, PATHS))
    return min(tries, key=lambda results: longest_gap(results.runs))


@cache
def follow_without_ros(
    algebra: str = "quaternion",
    feed_forward: bool = False,
    period: float = PERIOD,
    extrapolation: float = Settings.extrapolation,
    filter_time: float = 0.05,
) -> tuple[Run, ...]:
    """A lap of each path, simulated."""
    gains = Gains(feed_forward=FEED_FORWARD if feed_forward else 0.0, filter_time=filter_time)
    settings = Settings(algebra=algebra, period=period, gains=gains, extrapolation=extrapolation)
    return tuple(simulate(ARM, name, path_by_name(name), settings) for name in PATHS)


# --- what is measured ------------------------------------------------------------------------------------------------


def rms(run: Run) -> float:
    """The tip's error over the lap, root mean square, in mm."""
    return 1e3 * tracking_error(run).rms_m


def largest(run: Run) -> float:
    """Its largest, in mm."""
    return 1e3 * tracking_error(run).max_m


def median(run: Run) -> float:
    """Its median in mm, which single stalls of the machine do not touch."""
    return 1e3 * float(np.median(tip_distances(run)))


def joint_errors(run: Run, algebra: str) -> Array:
    """The joints' errors (dof,) over the lap, root mean square, in mrad: off the solution for the path's point."""
    joints = run.joint_states.between(run.course.start, run.course.end)
    desired = solve_path(
        ARM, run.course.desired(joints.time), joints.values[0], algebra, LevenbergMarquardt(), tolerance=1e-9
    )
    return np.asarray(1e3 * np.sqrt(((joints.values - desired.angles) ** 2).mean(axis=0)))


def longest_gap(runs: Runs) -> float:
    """The longest time in s without a joint state."""
    gaps = [np.diff(run.joint_states.between(run.course.start, run.course.end).time) for run in runs]
    return float(np.concatenate(gaps).max())


def compare(
    quantity: str, runs: dict[str, Runs], measure: Callable[[Run], float], remark: str = ""
) -> Comparison:
    """A row in mm with a value for each path; the paper prints none."""
    values = {algebra: [measure(run) for run in followed] for algebra, followed in runs.items()}
    return Comparison(
        f"{quantity} [{', '.join(PATHS)}]", "mm", None, values["quaternion"], values["conformal"], 3, remark
    )


def agreement(nodes: dict[str, Runs], without: dict[str, Runs]) -> Comparison:
    """By how much the nodes' RMS error differs from that of the loop without ROS, and why where it is much."""
    away = {
        algebra: [
            100.0 * (rms(a) / rms(b) - 1.0) for a, b in zip(nodes[algebra], without[algebra], strict=True)
        ]
        for algebra in ALGEBRAS
    }
    remark = f"they agree within {AGREE:.0f} %"
    if max(map(abs, (*away["quaternion"], *away["conformal"]))) > AGREE:
        gap = max(longest_gap(nodes[algebra]) for algebra in ALGEBRAS)
        remark = f"more than {AGREE:.0f} % apart in this run"
        if gap > STALL:
            remark += f", whose loops stood still for up to {1e3 * gap:.0f} ms: the machine had other work"
    return Comparison(
        "RMS error, nodes against the loop without ROS",
        "%",
        None,
        away["quaternion"],
        away["conformal"],
        1,
        remark,
    )


# --- Fig. 21 ---------------------------------------------------------------------------------------------------------


def run_fig21(period: float = PERIOD) -> Findings:
    """The tip's error by the nodes and without ROS."""
    results = {algebra: follow_with_nodes(algebra, period=period) for algebra in ALGEBRAS}
    nodes: dict[str, Runs] = {algebra: result.runs for algebra, result in results.items()}
    without: dict[str, Runs] = {algebra: follow_without_ros(algebra, period=period) for algebra in ALGEBRAS}
    return Findings(
        comparisons=[
            compare("RMS error of the tip, real nodes", nodes, rms),
            compare("RMS error, the same loop without ROS", without, rms),
            agreement(nodes, without),
            compare(
                "median error, real nodes", nodes, median, "hardly touched by what else the machine does"
            ),
            compare("median error, without ROS", without, median),
            compare("largest error, real nodes", nodes, largest),
            compare("largest error, without ROS", without, largest),
        ],
        iterates={
            name: Iterates(quaternion.joint_states.values, conformal.joint_states.values)
            for name, quaternion, conformal in zip(PATHS, *without.values(), strict=True)
        },
        draw=partial(draw_tip, nodes["quaternion"], without["quaternion"]),
        tables=[_rates(results), _variants(period)],
    )


def _rates(results: dict[str, Results]) -> Table:
    """How regularly the nodes ran, and how long the solves took."""
    rows: list[list[object]] = [
        [
            algebra,
            name,
            f"{loop.rate_hz:.0f} Hz",
            f"{loop.reached_hz:.1f} Hz",
            f"{1e3 * loop.period_p99_s:.2f} ms",
        ]
        for algebra, result in results.items()
        for name, loop in result.nodes.items()
    ]
    return Table(
        "The nodes' loops", ["algebra", "node", "rate set", "reached", "99 % of periods under"], rows
    )


def _variants(period: float) -> Table:
    """What the choices that the paper leaves open cost or gain."""
    loops = {
        "the nodes, with velocity feed-forward": follow_with_nodes("quaternion", True, period).runs,
        "without ROS, with velocity feed-forward": follow_without_ros(feed_forward=True, period=period),
        "without ROS, each reference held until the next": follow_without_ros(
            period=period, extrapolation=0.0
        ),
        "without ROS, held, with velocity feed-forward": follow_without_ros(
            feed_forward=True, period=period, extrapolation=0.0
        ),
    }
    columns = ["loop", *(f"{path}, {what} (mm)" for path in PATHS for what in ("RMS", "median"))]
    rows = [
        [loop, *(f"{of(run):.3f}" for run in runs for of in (rms, median))] for loop, runs in loops.items()
    ]
    return Table("Other loops, the tip's error, by quaternions", columns, rows)


def draw_tip(nodes: Runs, without: Runs) -> Figure:
    """The paths in space as the paper draws them, and under each the error against time, with and without ROS."""
    from gaik_core.experiments import drawing
    from gaik_ros.tracking import Series
    from gaik_ros.tracking_figures import in_lap, paths_on

    figure = drawing.new_figure(9.4, 7.4)
    parts: Any = figure.subfigures(2, 1, height_ratios=(1.7, 1.0))
    above, below = parts
    above.suptitle("Fig. 21: the Touch follows with the paper's gains, real nodes")
    paths_on(above, nodes)
    panels = below.subplots(1, len(nodes), sharey=True)
    for panel, *runs in zip(panels, nodes, without, strict=True):
        for run, name, colour in zip(runs, ("real nodes", "without ROS"), ("red", drawing.WAY), strict=True):
            tip = run.tip.between(run.course.start, run.course.end)
            error = in_lap(run, Series(tip.time, 1e3 * tip_distances(run)))
            panel.plot(error.time, error.values, color=colour, linewidth=1.0, label=name)
        panel.set(xlabel="time [s]", title=f"{runs[0].name}: error over the lap")
        panel.legend()
    panels[0].set_ylim(bottom=0.0)  # of both, when both are drawn
    panels[0].set_ylabel("error [mm]")
    return figure


# --- Fig. 22 ---------------------------------------------------------------------------------------------------------


def run_fig22(period: float = PERIOD) -> Findings:
    """The joints' errors of the same runs, and what the printed gains need to work at all."""
    nodes: dict[str, Runs] = {algebra: follow_with_nodes(algebra, period=period).runs for algebra in ALGEBRAS}
    without: dict[str, Runs] = {algebra: follow_without_ros(algebra, period=period) for algebra in ALGEBRAS}
    margins = {time: [largest_gain(time, delay) for delay in DELAYS] for time in FILTERS}
    delays = {time: longest_delay(time) for time in FILTERS}
    return Findings(
        comparisons=[
            _compare_joints(f"{path}, {where}", number, runs)
            for number, path in enumerate(PATHS)
            for where, runs in (("real nodes", nodes), ("without ROS", without))
        ],
        draw=partial(_draw_joints, nodes["quaternion"]),
        tables=[_margins(margins, delays)],
        errata=[_derivative(margins, delays, period), _stiffness()],
        numbers={
            "largest_gain_per_s": {f"{time} s": gains for time, gains in margins.items()},
            "longest_delay_s": {f"{time} s": delay for time, delay in delays.items()},
        },
    )


def _compare_joints(quantity: str, number: int, runs: dict[str, Runs]) -> Comparison:
    errors = {algebra: joint_errors(followed[number], algebra) for algebra, followed in runs.items()}
    joints = ", ".join(ARM.joint_names)
    return Comparison(
        f"{quantity}: RMS error of [{joints}]", "mrad", None, errors["quaternion"], errors["conformal"], 2
    )


def _draw_joints(runs: Runs) -> Figure:
    from gaik_ros.tracking_figures import joints_figure

    figure = joints_figure(runs)
    figure.suptitle("Fig. 22: each joint, as solved and as measured, real nodes")
    return figure


def _margins(margins: dict[float, list[float]], delays: dict[float, float]) -> Table:
    rows: list[list[object]] = [
        [
            f"{1e3 * time:.0f} ms" if time else "none",
            *(f"{gain:.2f}" for gain in gains),
            f"{1e3 * delays[time]:.0f} ms" if delays[time] >= 0.0 else "diverges",
        ]
        for time, gains in margins.items()
    ]
    columns = [
        "derivative filter",
        *(f"largest K/τ, {delay} ms late" if delay else "largest K/τ (1/s)" for delay in DELAYS),
        f"longest delay, K/τ = {TWIN:.0f} 1/s",
    ]
    return Table("What a joint's loop bears with the printed gains at 1 kHz, simulated", columns, rows)


def _derivative(margins: dict[float, list[float]], delays: dict[float, float], period: float) -> Erratum:
    raw, filtered = (follow_without_ros(filter_time=time, period=period) for time in (0.0, 0.05))
    none, short, chosen = FILTERS
    return Erratum(
        where="6.3, derivative gain",
        printed="0.3, and no filter",
        holds="a first-order filter, here of 50 ms: on a first-order axis the raw difference of the error is an "
        "algebraic loop, which diverges where 0.3 K/τ > 1",
        measured=f"the raw difference bears K/τ up to {margins[none][0]:.2f} 1/s, the twin's is {TWIN:.0f}: the tip is "
        f"{rms(raw[0]):.1f} mm off the circle (RMS), with the filter {rms(filtered[0]):.2f} mm; 10 ms bear "
        f"{margins[short][0]:.0f} 1/s, but {margins[short][2]:.0f} with 2 ms of delay; 50 ms bear a delay of "
        f"{1e3 * delays[chosen]:.0f} ms at K/τ = {TWIN:.0f} 1/s",
        confirmed=margins[none][0] <= 1.0 / 0.3 < margins[short][0] and rms(raw[0]) > rms(filtered[0]),
    )


def _stiffness() -> Erratum:
    left, viscous = remaining_share(1.0), remaining_share(0.0)
    return Erratum(
        where="6.3, integral gain",
        printed="0.01, and nothing of the joints' dynamics τ θ' + κ θ = K u",
        holds="follows on a viscous axis (κ = 0) only: with κ = 1, K = 1 a step keeps 1/(1 + 3.1) of its error, which "
        "this integral takes minutes to close",
        measured=f"5 s after a step {100.0 * left:.1f} % of it are left with κ = 1, and "
        f"{100.0 * abs(viscous):.2f} % with κ = 0",
        confirmed=abs(left - 1.0 / 4.1) < 0.01 and abs(viscous) < 0.001,
    )


FIG21 = Experiment(
    "fig21",
    "6.3",
    "The Touch follows a circle and a lemniscate under the PID controller: the tip",
    "Circle of radius 50 mm tilted by 30 degrees and lemniscate of half width 80 mm, 6.3 s a lap, setpoints at 100 Hz, "
    "controller and twin at 1000 Hz, gains 3.1, 0.01, 0.3. The paper names neither paths nor errors. The nodes are the "
    "demo's, on real ROS 2 topics; the same loop without ROS calls what the nodes call, with no delay between. Of "
    "runs in which a loop stood still for over 30 ms, as the machine did other work, the calmest of three counts. The "
    "error is the distance from the measured tip to the path's point at the same time; nearly all of it is the lag "
    "τ/(3.1 K) = 16 ms of a proportional loop behind what moves. *Iterates* are the joints of the loop without ROS at "
    "each of its steps.",
    run_fig21,
)

FIG22 = Experiment(
    "fig22",
    "6.3",
    "The Touch follows a circle and a lemniscate under the PID controller: the joints",
    "The same runs. A joint's error is its distance from the solution for the path's point at the same time. The "
    "paper tuned its gains on its device and says nothing of filter and dynamics; the table shows what they ask for.",
    run_fig22,
)
