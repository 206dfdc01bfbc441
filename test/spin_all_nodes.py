#!/usr/bin/env python3
"""Spin the whole suite in this process, without a launch file, and say what a user would see.

    python test/spin_all_nodes.py [--seconds 5] [--namespace left]

Exit code 0 where every setpoint was answered and the tip followed, 1 where not. test_suite.py asserts more of it.
"""

from __future__ import annotations

import argparse
import contextlib
import sys
import time
from collections.abc import Callable, Iterator, Sequence

import numpy as np
import rclpy
from geometry_msgs.msg import Point
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions
from std_srvs.srv import Trigger

from gaik_ros.recorder import Recorder
from gaik_ros.run import running
from gaik_ros.tracking import tip_distances
from touch_sim.demo_progress import Silent
from touch_sim.demo_run import Results, run_demo
from touch_sim.suite import Suite, SuiteOptions

OFF = 0.01  # m; a tip that does not follow is several times as far off
PATIENCE = 60.0  # s for anything that takes a second or two on an idle machine


class User:
    """A user beside one suite: hears its topics and can send setpoints."""

    def __init__(self, suite: Suite, context: Context) -> None:
        self.suite = suite
        self.node = Node("user", context=context, namespace=suite.options.namespace)
        self.recorder = Recorder(self.node)
        self._setpoint = None

    def send(self, x: float, y: float, z: float) -> None:
        """Send one setpoint, as `ros2 topic pub --once` does: only once somebody hears it."""
        self._setpoint = self._setpoint or self.node.create_publisher(Point, "setpoint", 10)
        wait_until(lambda: self._setpoint.get_subscription_count() >= 2, "nobody hears setpoints")
        self._setpoint.publish(Point(x=float(x), y=float(y), z=float(z)))

    def start(self, path: str) -> None:
        """Begin a path, looping."""
        trajectory = self.suite.trajectory
        for result in trajectory.set_parameters([Parameter("path", value=path)]):
            assert result.successful, result.reason
        client = self.node.create_client(Trigger, "trajectory_publisher/start")
        wait_until(client.service_is_ready, "no service to start a path")
        future = client.call_async(Trigger.Request())
        wait_until(future.done, "starting a path is not answered")


def wait_until(condition: Callable[[], bool], otherwise: str) -> None:
    """Wait for `condition`; AssertionError with the words of `otherwise` where it does not come."""
    end = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(otherwise)
        time.sleep(0.01)


@contextlib.contextmanager
def ros_context() -> Iterator[Context]:
    """A context of its own, shut down at the end."""
    context = Context()
    rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
    try:
        yield context
    finally:
        rclpy.try_shutdown(context=context)


@contextlib.contextmanager
def suites(*options: SuiteOptions) -> Iterator[list[User]]:
    """Run one suite for each of `options`, all in this process, with a user beside each."""
    with ros_context() as context:
        users = [User(Suite(one, context), context) for one in options]
        nodes = [node for user in users for node in (*user.suite.nodes, user.node)]
        with running(nodes, context):
            for user in users:
                wait_until(lambda user=user: user.recorder.count("tip") > 0, "no tip comes")
            yield users


def follow(options: SuiteOptions, paths: Sequence[str]) -> Results:
    """Follow `paths`, one lap each, and return all that was recorded."""
    with ros_context() as context:
        return run_demo(options, paths, 1, Silent(), context)


def answered(verdicts: Sequence[dict[str, str]]) -> int:
    """How many setpoints have a verdict of their own, or were superseded by one that has."""
    return sum(1 + int(verdict["superseded"]) for verdict in verdicts)


def main() -> int:
    """Follow a circle for a while and report."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=5.0, help="time of the lap (5)")
    parser.add_argument("--namespace", default="", help="namespace of all nodes (none)")
    given = parser.parse_args()
    results = follow(SuiteOptions(period=given.seconds, namespace=given.namespace), ["circle"])
    run = results.runs[0]
    distances, sent = tip_distances(run), run.setpoint.time.size
    usual = float(np.median(distances))
    for name, loop in results.nodes.items():
        print(f"{name:<22} {loop.reached_hz:8.1f} of {loop.rate_hz:g} Hz")
    print(f"setpoints              {answered(results.verdicts)} of {sent} answered")
    print(
        f"tip                    {1e3 * usual:.2f} mm off in the median, {1e3 * distances.max():.2f} at most"
    )
    return 0 if answered(results.verdicts) >= sent and usual < OFF else 1


if __name__ == "__main__":
    sys.exit(main())
