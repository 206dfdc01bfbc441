"""Feeds recorded setpoints to a suite again, in their own time, and records how they are followed."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from geometry_msgs.msg import Point
from numpy.typing import NDArray
from rclpy.node import Node

from gaik_core import KinematicChain
from gaik_core.errors import GaikError
from gaik_ros import qos
from gaik_ros.conversions import array_to_point, joint_values
from gaik_ros.joint_message import JointMessageError
from gaik_ros.others import other_setpoints
from gaik_ros.recorded_runs import ARRIVED
from gaik_ros.recorder import Recorder
from gaik_ros.recording import Recording
from gaik_ros.tracking import Series

Array = NDArray[np.float64]

PATIENCE = 10.0  # s for a suite to be there, and for the way to the first setpoint, which may be out of reach
LOOK = 0.05  # s between looks
AT_REST = 2e-4  # m: a tip that moves less in a while is at rest
WHILE = 0.3  # s; also how long the last verdicts may take
AGAIN = 0.5  # s between repeats of the setpoint that is gone to, so that it does not count as lost


class Replayer:
    """Leads a running suite through setpoints. `node` is run by the caller, in the suite's namespace."""

    def __init__(self, node: Node, chain: KinematicChain) -> None:
        """`chain` computes the tip, for a device that does not publish it."""
        self._chain, self._node = chain, node
        self._publisher = node.create_publisher(Point, "setpoint", qos.SETPOINT)
        self._recorder = Recorder(node)

    def wait_for_suite(self) -> None:
        """Wait until a suite hears setpoints and tells its joint states. GaikError: none, or others lead it."""
        end = time.monotonic() + PATIENCE
        # One of the subscriptions to setpoints is the recorder's own.
        while self._publisher.get_subscription_count() < 2 or not self._recorder.count("joint_states"):
            if time.monotonic() > end:
                what = "hears" if self._recorder.count("joint_states") else "tells its joint_states beside"
                raise GaikError(f"no suite {what} {self._publisher.topic_name} (waited {PATIENCE:g} s)")
            time.sleep(LOOK)
        if reason := other_setpoints(self._node, lambda: self._recorder.count("setpoint")):
            raise GaikError(reason)

    def go_to(self, point: Array) -> None:
        """Send one setpoint (3,) m until the tip is at rest there, or for as long as that should take."""
        end, rest, sent, before = time.monotonic() + PATIENCE, time.monotonic(), 0.0, self._tip()
        while (now := time.monotonic()) < end:
            if now - sent > AGAIN:
                self._publisher.publish(array_to_point(point))
                sent = now
            time.sleep(LOOK)
            tip = self._tip()
            if np.linalg.norm(tip - before) > AT_REST or np.linalg.norm(tip - point) > ARRIVED:
                before, rest = tip, time.monotonic()
            if time.monotonic() - rest > WHILE:
                return

    def feed(self, setpoints: Series, sent: Callable[[], object]) -> Recording:
        """Publish setpoints (n, 3) m at their times, call `sent` after each, and return what was heard meanwhile."""
        self._recorder.take()
        start = time.monotonic()
        for due, point in zip(setpoints.time - setpoints.time[0], setpoints.values, strict=True):
            if (wait := start + due - time.monotonic()) > 0.0:
                time.sleep(wait)
            self._publisher.publish(array_to_point(point))
            sent()
        time.sleep(WHILE)
        return self._recorder.take()

    def _tip(self) -> Array:
        """Where the tip is, from the joints; where it was before, until they are heard of again."""
        message = self._recorder.newest("joint_states")
        try:
            angles = joint_values(message, self._chain.joint_names)
        except JointMessageError as reason:
            raise GaikError(f"joint_states are not those of {self._chain.name}: {reason}") from None
        return self._chain.forward(angles)
