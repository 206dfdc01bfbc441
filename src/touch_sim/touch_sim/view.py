"""The whole suite with the twin, and a live page of it in the browser, in one process.

    python -m touch_sim.view        ros2 run touch_sim view        make view

Options are read with nothing but Python, and the rest is imported after that, so that a missing module can be
said in one line.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from touch_sim.command_line import (
    BAD_OPTION,
    Parser,
    check_parameters,
    complain,
    complain_of_missing,
    split_ros_arguments,
)

if TYPE_CHECKING:
    from rclpy.node import Node

    from touch_sim.suite import SuiteOptions

EPILOG = """\
On the page: drag the ball (in the plane of the screen) or an arrow (along one axis), and the arm follows; or start a
path. The sliders and lists set the nodes' real parameters.

Arguments after --ros-args go to the nodes: --ros-args -p pid_controller:gains.p:=5.0
"""


def main(args: Sequence[str] | None = None) -> int:
    """Entry point of the executable; returns the exit code."""
    own, ros_arguments = split_ros_arguments(sys.argv[1:] if args is None else args)
    options = _parser().parse_args(own)
    try:
        return _view(options, ros_arguments)
    except ModuleNotFoundError as missing:
        return complain_of_missing("view", missing)
    except KeyboardInterrupt:  # before there is anything to end
        return 0


def _view(options: argparse.Namespace, ros_arguments: list[str]) -> int:
    """Run the suite and the viewer until a signal; returns the exit code."""
    import rclpy
    from rclpy.signals import SignalHandlerOptions

    from gaik_ros.others import refuse_company
    from gaik_ros.run import (
        ROS_ARGUMENT_ERRORS,
        Runner,
        StopRequest,
        check_namespace,
        explained,
    )
    from gaik_ros.signals import stopped_by_signals

    request = StopRequest()
    with stopped_by_signals(request.make):
        try:
            suite = _suite_options(options, check_namespace(options.namespace))
            viewer = _viewer_parameters(options)
            check_parameters(ros_arguments, suite.parameters(()) | {"viewer": viewer})
            rclpy.init(args=["view", *ros_arguments], signal_handler_options=SignalHandlerOptions.NO)
            nodes, address = _nodes(suite, viewer)
            refuse_company(nodes[0])
            print(f"The page is at {address}; Ctrl-C ends it.", flush=True)
            runner = Runner(nodes)
            request.serve(runner)
            try:
                runner.spin()
            finally:
                runner.destroy()
        except (ValueError, OSError, *ROS_ARGUMENT_ERRORS) as reason:
            return complain("view", explained(reason), BAD_OPTION)
        finally:
            rclpy.try_shutdown()
    return 0


def _suite_options(options: argparse.Namespace, namespace: str) -> SuiteOptions:
    from touch_sim.suite import SuiteOptions

    return SuiteOptions(
        robot=options.robot, rate=options.rate, feed_forward=options.feed_forward, namespace=namespace
    )


def _viewer_parameters(options: argparse.Namespace) -> dict[str, bool | int | str]:
    """What is set of the viewer."""
    from touch_sim.description import ORIGIN_FRAME, touch_urdf

    touch = options.robot in ("touch", "touch_device")
    return {
        "robot": options.robot,
        "host": options.host,
        "port": options.port,
        "open_browser": options.browser and _has_screen(),
        "urdf": touch_urdf() if touch else "",
        "origin_frame": ORIGIN_FRAME if touch else "",
    }


def _nodes(
    options: SuiteOptions, viewer_parameters: Mapping[str, bool | int | str]
) -> tuple[list[Node], str]:
    """The suite's nodes and the viewer, and where the page is. ValueError: an option that a node refuses."""
    from rclpy.parameter import Parameter

    from gaik_ros.viewer.node import Viewer
    from touch_sim.suite import Suite

    suite = Suite(options)
    viewer = Viewer(
        namespace=options.namespace,
        parameter_overrides=[Parameter(name, value=value) for name, value in viewer_parameters.items()],
    )
    return [*suite.nodes, viewer], viewer.page.address


def _has_screen() -> bool:
    """Whether a browser could be shown: without a screen the one that opens would fill the terminal."""
    return sys.platform in ("darwin", "win32") or any(
        os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY")
    )


def _parser() -> Parser:
    parser = Parser(
        prog="view",
        description="Show the suite with the twin of a Touch on a live page in the browser.",
        epilog=EPILOG,
    )
    add = parser.add_argument
    add("--port", type=int, default=8080, help="of the page, or the next that is free; 0: any (8080)")
    add("--host", default="127.0.0.1", help="another opens the page to other machines (127.0.0.1)")
    add("--no-browser", dest="browser", action="store_false", help="only say where the page is")
    add("--robot", default="touch_device", help="a robot's name, or a robot file (touch_device)")
    add("--rate", type=float, default=1000.0, metavar="HZ", help="rate of controller and twin (1000)")
    add("--feed-forward", action="store_true", help="feed the reference's velocity forward")
    add("--namespace", default="", help="namespace of all nodes (none)")
    return parser


if __name__ == "__main__":
    sys.exit(main())
