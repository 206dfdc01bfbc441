"""Setpoints on their way out: sent at once where somebody hears them, or as soon as somebody does."""

from __future__ import annotations

import threading
import time

import numpy as np
from geometry_msgs.msg import Point
from numpy.typing import NDArray
from rclpy.node import Node
from rclpy.publisher import Publisher

from gaik_ros import qos
from gaik_ros.conversions import array_to_point
from gaik_ros.watch import Watch

Array = NDArray[np.float64]

PATIENCE = 2.0  # s: a setpoint that nobody heard for so long is dropped; later it would come as a surprise
IDLE = 3.0  # s after the last setpoint: the hand is off


class Outbox:
    """Publishes `setpoint`s; it has a publisher only while they come, for who merely looks is nobody's rival."""

    def __init__(self, node: Node, watch: Watch, own_subscriptions: int) -> None:
        """`own_subscriptions`: how many the node itself has to its setpoints."""
        self._node, self._watch, self._own = node, watch, own_subscriptions
        self._lock = threading.Lock()
        self._publisher: Publisher | None = None
        self._last: Array | None = None
        self._asked = 0.0  # when the last was to be sent
        self._waiting: Point | None = None

    def send(self, position: Array) -> None:
        """Send (3,) m; only the newest waits where nobody hears it yet."""
        with self._lock:
            if self._publisher is None:
                self._publisher = self._watch.publisher(Point, "setpoint", qos.SETPOINT)
            self._last, self._asked, self._waiting = position, time.monotonic(), array_to_point(position)
        self.attend()

    def repeat(self) -> None:
        """Send the last once more."""
        if self._last is not None:
            self.send(self._last)

    def attend(self) -> None:
        """Send what waits, if somebody hears it now; to be called regularly."""
        with self._lock:
            if self._publisher is None:
                return
            age = time.monotonic() - self._asked
            if self._waiting is not None and self._publisher.get_subscription_count() > self._own:
                self._publisher.publish(self._waiting)
                self._waiting = None
            elif age > PATIENCE:
                self._waiting = None
            if age > IDLE:
                self._node.destroy_publisher(self._publisher)
                self._publisher = None
