"""The demo: the twin of a Touch follows a circle and a lemniscate through real ROS 2 nodes, and is measured.

    python -m touch_sim.demo        ros2 run touch_sim demo        make demo

Options are read with nothing but Python, and the rest is imported after that, so that a missing module can be
said in one line.
"""

from __future__ import annotations

import argparse
import signal
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from touch_sim.command_line import (
    BAD_OPTION,
    FAILED,
    INTERRUPTED,
    Parser,
    check_parameters,
    complain,
    complain_of_missing,
    split_ros_arguments,
    within,
)

EPILOG = """\
The error is the distance from the measured tip to the path's point at the same time. The tip has the stamp of its
message; the path's clock starts at the earliest time that any setpoint tells, since none can be received before it
is due. The way to the first point, and a rest there, come before the path and do not count.

Arguments after --ros-args go to the nodes: --ros-args -p pid_controller:gains.p:=5.0
"""


def main(args: Sequence[str] | None = None) -> int:
    """Entry point of the executable; returns the exit code."""
    own, ros_arguments = split_ros_arguments(sys.argv[1:] if args is None else args)
    try:
        options = _parser().parse_args(own)
        signal.signal(signal.SIGTERM, _interrupt)
        return _demonstrate(options, ros_arguments)
    except ModuleNotFoundError as missing:
        return complain_of_missing("demo", missing)
    except KeyboardInterrupt:
        return complain("demo", "interrupted", INTERRUPTED)


def _demonstrate(options: argparse.Namespace, ros_arguments: list[str]) -> int:
    """Run the demo and write what it gave; returns the exit code."""
    import rclpy
    from rclpy.signals import SignalHandlerOptions

    from gaik_ros.run import ROS_ARGUMENT_ERRORS, check_namespace, explained
    from touch_sim.demo_output import write, write_bag
    from touch_sim.demo_progress import progress_for
    from touch_sim.demo_run import DemoError, run_demo
    from touch_sim.suite import SuiteOptions

    if options.record:
        import rosbags  # noqa: F401 - said now if it is missing, and not after the run
    suite = SuiteOptions(**{name: getattr(options, name) for name in SuiteOptions.__dataclass_fields__})
    paths = ("circle", "lemniscate") if options.path == "both" else (options.path,)
    try:
        suite = replace(suite, namespace=check_namespace(suite.namespace))
        check_parameters(ros_arguments, suite.parameters(()))
        options.out.mkdir(parents=True, exist_ok=True)
        rclpy.init(args=["demo", *ros_arguments], signal_handler_options=SignalHandlerOptions.NO)
        results = run_demo(suite, paths, options.laps, progress_for(sys.stderr), look_out=True)
    except DemoError as reason:
        return complain("demo", str(reason), FAILED)
    except (ValueError, OSError, *ROS_ARGUMENT_ERRORS) as reason:
        return complain("demo", explained(reason), BAD_OPTION)
    finally:
        rclpy.try_shutdown()
    print(write(results, options.out))
    try:
        if options.record:
            print(write_bag(results, suite.namespace, options.out))
    except (ValueError, OSError) as reason:
        return complain("demo", str(reason), FAILED)
    return 0


def _parser() -> Parser:
    parser = Parser(
        prog="demo",
        description="Follow a circle and a lemniscate with the twin of a Touch, on real ROS 2 nodes.",
        epilog=EPILOG,
    )
    add = parser.add_argument
    add("--path", choices=("circle", "lemniscate", "both"), default="both", help="what to follow (both)")
    add("--laps", type=within(int, 1, 1000), default=1, help="laps of each path (1)")
    add("--period", type=within(float, 0.5, 3600), default=6.3, metavar="S", help="time of a lap in s (6.3)")
    add(
        "--setpoint-rate",
        type=within(float, 1, 1000),
        default=100.0,
        metavar="HZ",
        help="setpoints a second (100)",
    )
    add(
        "--rate",
        type=within(float, 50, 10_000),
        default=1000.0,
        metavar="HZ",
        help="rate of controller and twin (1000)",
    )
    add("--feed-forward", action="store_true", help="feed the reference's velocity forward")
    add("--algebra", default="quaternion", help="quaternion or conformal (quaternion)")
    add("--rule", default="", help="update rule of the IK node (the node's own default)")
    add(
        "--robot",
        default="touch_device",
        help="a robot that reaches the paths, or a robot file (touch_device)",
    )
    add("--namespace", default="", help="namespace of all nodes (none)")
    add("--record", action="store_true", help="also keep what was heard as an MCAP bag, DIR/run")
    add("--out", type=Path, default=Path("out"), metavar="DIR", help="where to write figures and JSON (out)")
    return parser


def _interrupt(number: int, frame: object) -> None:
    raise KeyboardInterrupt


if __name__ == "__main__":
    sys.exit(main())
