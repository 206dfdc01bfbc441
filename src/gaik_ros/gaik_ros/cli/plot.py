"""`gaik plot`: the paper's Figs. 21 and 22, and the tracking error, from a bag."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from gaik_core.cli.command import Command, robot_names

MOST_RUNS = 6  # columns of a figure


def configure(parser: ArgumentParser) -> None:
    """Its arguments."""
    parser.add_argument("bag", type=Path, help="a bag: its folder, or its .mcap or .db3 file")
    parser.add_argument(
        "--out", type=Path, default=Path("out/plot"), metavar="DIR", help="for the PNG (default: %(default)s)"
    )
    parser.add_argument(
        "--run", type=int, nargs="+", metavar="N", help=f"draw these runs (default: the first {MOST_RUNS})"
    )
    add_reading(parser)
    parser.add_argument("--json", action="store_true", help="print the numbers as JSON")


def add_reading(parser: ArgumentParser) -> None:
    """The arguments that say how a bag is read."""
    parser.add_argument("--namespace", metavar="NS", help="of the suite, where the bag has several")
    parser.add_argument(
        "--gap",
        type=float,
        default=0.5,
        metavar="S",
        help="setpoints further apart begin another run (default: %(default)g s)",
    )
    robot: Any = parser.add_argument(
        "--robot",
        default="touch_device",
        help="computes the tip where none was recorded (default: %(default)s)",
    )
    robot.completer = robot_names


def run(arguments: Namespace) -> int:
    """Draw, and print the numbers."""
    from gaik_core.cli.terminal import print_json
    from gaik_ros.cli.tracking_output import as_data, draw, print_runs

    runs = read_runs(arguments)
    shown = chosen(runs, arguments.run)
    data = [as_data(run) for run in runs]
    files = draw(shown, arguments.out)
    if arguments.json:
        print_json({"runs": data, "files": [str(file) for file in files]})
    else:
        print_runs(data, runs[0].setpoint.time[0])
        print(f"written: {', '.join(map(str, files))}")
    return 0


def read_runs(arguments: Namespace) -> list[Any]:
    """The runs of the bag. GaikError: it cannot be read, or holds none."""
    from gaik_core import KinematicChain
    from gaik_core.errors import GaikError
    from gaik_ros.bag_reader import read_bag
    from gaik_ros.joint_message import JointMessageError
    from gaik_ros.recorded_runs import runs_of

    if not arguments.gap > 0.0:
        raise GaikError(f"--gap is {arguments.gap:g} s; it may be above 0")
    chain = KinematicChain.load(arguments.robot)
    try:
        return runs_of(read_bag(arguments.bag, arguments.namespace), chain, arguments.gap)
    except JointMessageError as reason:
        raise GaikError(f"{arguments.bag}: {reason}") from None


def chosen(runs: list[Any], numbers: list[int] | None) -> list[Any]:
    """The runs of these numbers, from 1. GaikError: there is no such run."""
    from gaik_core.errors import GaikError

    if numbers is None:
        return runs[:MOST_RUNS]
    for number in numbers:
        if not 1 <= number <= len(runs):
            raise GaikError(f"--run is {number}; the bag has the runs 1 to {len(runs)}")
    return [runs[number - 1] for number in numbers]


COMMAND = Command(
    "draw the paper's Figs. 21 and 22 from a bag, and measure the tracking",
    (
        "gaik plot out/run/run.mcap",
        "gaik plot out/run --run 2 --out out/lemniscate",
        "gaik plot out/run --json",
    ),
    configure,
    run,
)
