"""One run of the demo: the suite follows paths on real topics, and everything is recorded."""

from __future__ import annotations

import csv
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.context import Context
from rclpy.logging import LoggingSeverity
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_srvs.srv import Trigger

from gaik_core import KinematicChain, LevenbergMarquardt, solve_path
from gaik_core.paths import path_by_name
from gaik_ros.others import other_suite, refuse_company
from gaik_ros.recorder import Recorder
from gaik_ros.recording import Recording
from gaik_ros.run import running
from gaik_ros.tracking import Run
from touch_sim.loop_meter import LoopMeter, LoopRate
from touch_sim.suite import Suite, SuiteOptions
from touch_sim.tracking import lap_of

ARRIVED = 1e-4  # m: so near the first point the approach is over
SETTLE = 0.3  # s at rest there, several times the controller's slowest time
PATIENCE = 30.0  # s for anything that takes a second
LAST_VERDICT = 0.3  # s, for the last verdicts to come
LOOK = 0.02  # s between looks at what has come


class DemoError(RuntimeError):
    """The run did not come about; the message is one line for the user."""


class Progress(Protocol):
    """Is told how far a path is."""

    def begin(self, name: str, setpoints: int) -> None:
        """A path of so many setpoints begins."""

    def advance(self, setpoints: int) -> None:
        """So many of them have been sent in all."""

    def end(self) -> None:
        """The path is over."""


@dataclass(frozen=True)
class Results:
    """What came of a demo: runs, each loop's rate by its node, the IK node's verdicts, and all that was heard."""

    runs: tuple[Run, ...]
    nodes: dict[str, LoopRate]
    verdicts: tuple[dict[str, str], ...]
    cpu_cores: float
    recordings: tuple[Recording, ...] = ()


def run_demo(
    options: SuiteOptions,
    paths: Sequence[str],
    laps: int,
    progress: Progress,
    context: Context | None = None,
    look_out: bool = False,
) -> Results:
    """Follow each of `paths` for `laps` laps. Raises ValueError for a bad option, DemoError where a run fails.

    With `look_out`, a ValueError too where another suite is at work in the namespace; to see that takes four seconds.
    """
    _check_reach(options.robot, paths)
    suite = Suite(options, context)
    if look_out:
        refuse_company(suite.trajectory)
    for node in suite.nodes:
        node.get_logger().set_level(LoggingSeverity.WARN)  # what is going well, the progress says
    demo = Node("demo", context=context, namespace=options.namespace)
    conductor = Conductor(suite, demo, progress)
    with running([*suite.nodes, demo], context):
        conductor.wait_for_suite()
        recordings = [conductor.follow(name, laps) for name in paths]
    return conductor.results(paths, laps, recordings)


def _check_reach(robot: str, paths: Sequence[str]) -> None:
    """Raise ValueError where a robot does not reach a path everywhere."""
    chain = KinematicChain.load(robot)
    for name in paths:
        points = path_by_name(name).points()
        reached = solve_path(chain, points, rule=LevenbergMarquardt(), tolerance=1e-5).converged
        if not reached.all():
            where = np.round(points[~reached][0], 4).tolist()
            raise ValueError(f"robot {robot} does not reach the {name} everywhere: not at {where} m")


class Conductor:
    """Leads a running suite from path to path by its services, as a user would, and records it."""

    def __init__(self, suite: Suite, node: Node, progress: Progress) -> None:
        """`node` is run together with the suite's nodes, in the same namespace."""
        self._suite, self._progress = suite, progress
        self.recorder = Recorder(node)
        loops = {n.get_name(): getattr(n, "loop", None) for n in suite.nodes}
        self._meters = {name: LoopMeter(loop) for name, loop in loops.items() if loop is not None}
        self._periods: dict[str, list[np.ndarray]] = {name: [] for name in self._meters}
        self._cpu, self._wall = 0.0, 0.0
        self._start = node.create_client(Trigger, "trajectory_publisher/start")
        self._stop = node.create_client(Trigger, "trajectory_publisher/stop")
        self._set = node.create_client(
            SetParametersAtomically, "trajectory_publisher/set_parameters_atomically"
        )

    def wait_for_suite(self) -> None:
        """Wait until every topic and service that the demo needs is there."""
        for client in (self._start, self._stop, self._set):
            _wait(client.service_is_ready, f"service {client.srv_name} is not there")
        _wait(lambda: self.recorder.count("tip") > 0, "no tip comes from touch_sim")
        publisher = self._suite.trajectory
        topic = publisher.resolve_topic_name("setpoint")
        _wait(lambda: publisher.count_subscribers(topic) >= 2, "ik_node does not hear setpoints")

    def follow(self, name: str, laps: int) -> Recording:
        """Go to the first point of a path, rest there, follow the path and return what was recorded of it."""
        options, path = self._suite.options, path_by_name(name)
        count = round(laps * options.period * options.setpoint_rate)
        self._approach(name, path.position(0.0))
        self._progress.begin(name, count)
        self._begin_span()
        self._configure(path=name, loop=True)
        _call(self._start, Trigger.Request())
        end = time.monotonic() + laps * options.period + PATIENCE
        while (sent := self.recorder.count("setpoint")) <= count:
            self._make_sure_of_being_alone()
            if time.monotonic() > end:
                raise DemoError(f"{sent} of {count} setpoints came while the {name} was followed")
            self._progress.advance(sent)
            time.sleep(LOOK)
        _call(self._stop, Trigger.Request())
        self._progress.advance(count)
        self._progress.end()
        self._end_span()
        time.sleep(LAST_VERDICT)
        return self.recorder.take()

    def _approach(self, name: str, first: np.ndarray) -> None:
        """Bring the tip to the first point by a path of that point alone."""
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "first_point.csv"
            with file.open("w", newline="", encoding="utf-8") as stream:
                csv.writer(stream).writerows([("x", "y", "z"), first.tolist()])
            self._configure(path="points", file=str(file), loop=False)
        _call(self._start, Trigger.Request())
        where = f"the first point of the {name}, {np.round(first, 4).tolist()} m"
        _wait(lambda: self._arrived(first), f"the tip does not come to {where}")
        time.sleep(SETTLE)

    def _make_sure_of_being_alone(self) -> None:
        """DemoError: another suite, which began when this one did, drives the same device."""
        if reason := other_suite(self._suite.trajectory):
            raise DemoError(reason)

    def _arrived(self, point: np.ndarray) -> bool:
        self._make_sure_of_being_alone()
        tip = self.recorder.tip_now()
        return tip is not None and bool(np.linalg.norm(tip - point) < ARRIVED)

    def _configure(self, **parameters: bool | str) -> None:
        request = SetParametersAtomically.Request(
            parameters=[Parameter(name, value=value).to_parameter_msg() for name, value in parameters.items()]
        )
        result = _call(self._set, request).result
        if not result.successful:
            raise DemoError(f"trajectory_publisher refused: {result.reason}")

    def _begin_span(self) -> None:
        self.recorder.take()
        for meter in self._meters.values():
            meter.clear()
        self._cpu -= time.process_time()
        self._wall -= time.monotonic()

    def _end_span(self) -> None:
        self._cpu += time.process_time()
        self._wall += time.monotonic()
        for name, meter in self._meters.items():
            self._periods[name].append(meter.periods())

    def results(self, paths: Sequence[str], laps: int, recordings: Sequence[Recording]) -> Results:
        """Read the recordings, once the suite has stopped, and return all results."""
        runs = tuple(
            self._run_of(name, laps, recording) for name, recording in zip(paths, recordings, strict=True)
        )
        nodes = {
            name: meter.rate(np.concatenate(self._periods[name])) for name, meter in self._meters.items()
        }
        verdicts = tuple(verdict for recording in recordings for verdict in recording.verdicts())
        return Results(runs, nodes, verdicts, self._cpu / self._wall, tuple(recordings))

    def _run_of(self, name: str, laps: int, recording: Recording) -> Run:
        options, names, setpoints = self._suite.options, self._suite.joint_names, recording.setpoints()
        return Run(
            name,
            lap_of(setpoints, path_by_name(name), options.setpoint_rate, options.period, laps),
            names,
            setpoints,
            recording.tips(),
            recording.joints("joint_reference", names),
            recording.joints("joint_states", names),
        )


def _wait(condition: Callable[[], bool], otherwise: str) -> None:
    """Wait until `condition` holds; raise DemoError with the words of `otherwise` where it never does."""
    end = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > end:
            raise DemoError(f"{otherwise} (waited {PATIENCE:g} s)")
        time.sleep(LOOK)


def _call(client: Any, request: Any) -> Any:
    """Call a service and return its response."""
    future = client.call_async(request)
    _wait(future.done, f"service {client.srv_name} does not answer")
    return future.result()
