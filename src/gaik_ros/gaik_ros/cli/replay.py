"""`gaik replay`: feed a bag's setpoints to a suite again, and compare how they were followed."""

from __future__ import annotations

import os
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gaik_core.cli.command import Command
from gaik_core.errors import UnknownNameError
from gaik_ros.cli.plot import add_reading, chosen, read_runs

if TYPE_CHECKING:
    from rclpy.context import Context
    from rclpy.node import Node

    from gaik_ros.replayer import Replayer
    from gaik_ros.tracking import Run

SUITES = "gaik.suites"
"""Another package adds a suite to replay to with an entry point in this group: a function of robot, namespace, context
and parameters (by node, by name) that returns its nodes, not yet running."""

TWIN = "twin"


def configure(parser: ArgumentParser) -> None:
    """Its arguments."""
    parser.add_argument("bag", type=Path, help="a bag: its folder, or its .mcap or .db3 file")
    parser.add_argument(
        "--live",
        nargs="?",
        const="",
        metavar="NS",
        help="feed the suite that is running, in this namespace; what it moves will move "
        "(default: a twin, started for it)",
    )
    parser.add_argument(
        "-p",
        "--param",
        action="append",
        default=[],
        metavar="NODE:NAME:=VALUE",
        help="a parameter of the twin's nodes",
    )
    parser.add_argument("--run", type=int, nargs="+", metavar="N", help="feed these runs (default: all)")
    parser.add_argument("--out", type=Path, metavar="DIR", help="draw the replayed runs into DIR")
    add_reading(parser)
    parser.add_argument("--json", action="store_true", help="print the numbers as JSON")


def run(arguments: Namespace) -> int:
    """Replay and compare; 1 where nothing was followed."""
    from gaik_core.cli.terminal import print_json
    from gaik_ros.cli.tracking_output import as_data, draw

    runs = read_runs(arguments)
    recorded = [runs[n - 1] for n in arguments.run] if chosen(runs, arguments.run) and arguments.run else runs
    replayed = replay(recorded, arguments)
    pairs = [
        {"name": before.name, "recorded": as_data(before), "replayed": as_data(after)}
        for before, after in zip(recorded, replayed, strict=True)
    ]
    files = draw(replayed, arguments.out) if arguments.out else []
    if arguments.json:
        print_json({"runs": pairs, "files": [str(file) for file in files]})
    else:
        print_comparison(pairs)
        if files:
            print(f"written: {', '.join(map(str, files))}")
    return 0


def replay(runs: Sequence[Run], arguments: Namespace) -> list[Run]:
    """Feed each run's setpoints and return how they were followed now."""
    from dataclasses import replace

    from gaik_core import KinematicChain
    from gaik_core.cli.terminal import progress
    from gaik_ros.recorded_runs import runs_of

    chain = KinematicChain.load(arguments.robot)
    replayed = []
    total = sum(run.setpoint.time.size for run in runs)
    with suite(arguments, chain) as replayer, progress(total, "setpoint") as bar:
        replayer.wait_for_suite()
        for before in runs:
            replayer.go_to(before.setpoint.values[0])
            heard = replayer.feed(before.setpoint, bar.update)
            replayed.append(replace(runs_of(heard, chain, arguments.gap)[0], name=before.name))
    return replayed


@contextmanager
def suite(arguments: Namespace, chain: Any) -> Iterator[Replayer]:
    """A replayer to the twin's suite, started here, or to the one that is running."""
    try:
        import rclpy
        from rclpy.node import Node
    except ImportError as missing:
        raise _cannot(f"it needs ROS 2: {missing}") from None
    from gaik_ros.replayer import Replayer
    from gaik_ros.run import ROS_ARGUMENT_ERRORS, check_namespace, explained, running

    namespace = arguments.live if arguments.live is not None else f"gaik_replay_{os.getpid()}"
    context = rclpy.Context()
    parameters = node_parameters(arguments.param)
    if parameters and arguments.live is not None:
        raise _cannot("--param is for the twin; a running suite has `ros2 param set`")
    try:
        namespace = check_namespace(namespace)
        rclpy.init(context=context, args=["gaik"])
        nodes = [] if arguments.live is not None else twin(arguments.robot, namespace, context, parameters)
        node = Node("gaik_replay", context=context, namespace=namespace)
        replayer = Replayer(node, chain)
        with running([*nodes, node], context):
            yield replayer
    except ROS_ARGUMENT_ERRORS as reason:
        raise _cannot(explained(reason)) from None
    finally:
        rclpy.try_shutdown(context=context)


def node_parameters(settings: Sequence[str]) -> dict[str, dict[str, Any]]:
    """Settings such as `pid_controller:gains.p:=5.0` by node and name. GaikError: one is of another form."""
    import yaml

    parameters: dict[str, dict[str, Any]] = {}
    for setting in settings:
        name, assigned, text = setting.partition(":=")
        node, _, parameter = name.partition(":")
        if not (assigned and node and parameter):
            raise _cannot(f"--param is {setting!r}; it may be NODE:NAME:=VALUE")
        try:
            parameters.setdefault(node, {})[parameter] = yaml.safe_load(text)
        except yaml.YAMLError:
            raise _cannot(f"--param is {setting!r}: {text!r} is no value") from None
    return parameters


def twin(robot: str, namespace: str, context: Context, parameters: dict[str, dict[str, Any]]) -> list[Node]:
    """The nodes of the twin's suite. GaikError: the package that has it is not installed, or refuses an option."""
    from importlib.metadata import entry_points

    from gaik_ros.run import explained

    points = entry_points(group=SUITES, name=TWIN)
    if not points:
        raise _cannot("the twin is in touch_sim, which is not installed; feed a running suite with --live")
    try:
        nodes: list[Node] = list(next(iter(points)).load()(robot, namespace, context, parameters))
    except ValueError as reason:
        raise _cannot(explained(reason)) from None
    names = [node.get_name() for node in nodes]
    for name in parameters:
        if name not in names:
            raise UnknownNameError("node", name, names)
    return nodes


def _cannot(reason: str) -> Exception:
    from gaik_core.errors import GaikError

    return GaikError(f"replay: {reason}")


def print_comparison(pairs: Sequence[dict[str, Any]]) -> None:
    """Both errors of each run, side by side."""
    from gaik_core.cli.terminal import print_table

    print_table(
        ("run", "setpoints", "recorded RMS", "replayed RMS", "recorded max", "replayed max"),
        [
            (
                pair["name"],
                str(pair["recorded"]["setpoints"]),
                *(
                    f"{1e3 * pair[when][what]:.3f} mm"
                    for what in ("rms_m", "max_m")
                    for when in ("recorded", "replayed")
                ),
            )
            for pair in pairs
        ],
    )


COMMAND = Command(
    "feed a bag's setpoints to a suite again, and compare the tracking",
    (
        "gaik replay out/run/run.mcap",
        "gaik replay out/run --run 1 -p pid_controller:gains.feedforward_gain:=0.05",
        "gaik replay out/run --live left --json",
    ),
    configure,
    run,
)
