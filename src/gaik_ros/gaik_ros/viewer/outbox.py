"""Setpoints on their way out: sent at once where somebody hears them, or as soon as somebody does."""

from __future__ import annotations

import threading
import time

import numpy as np
from geometry_msgs.msg import Point
from numpy.typing import NDArray
from rclpy.publisher import Publisher

from gaik_ros import qos
from gaik_ros.conversions import array_to_point
from gaik_ros.watch import Watch

Array = NDArray[np.float64]

PATIENCE = 2.0  # s: a setpoint that nobody heard for so long is dropped; later it would come as a surprise


class Outbox:
    """Publishes `setpoint`s. There is no publisher before the first: a viewer that only looks is nobody's rival."""

    def __init__(self, watch: Watch, own_subscriptions: int) -> None:
        """`own_subscriptions`: how many the node itself has to its setpoints."""
        self._watch, self._own = watch, own_subscriptions
        self._lock = threading.Lock()
        self._publisher: Publisher | None = None
        self._waiting: tuple[Point, float] | None = None
        self._last: Array | None = None

    def send(self, position: Array) -> None:
        """Send (3,) m; only the newest waits where nobody hears it yet."""
        with self._lock:
            self._last = position
            if self._publisher is None:
                self._publisher = self._watch.publisher(Point, "setpoint", qos.SETPOINT)
            self._waiting = (array_to_point(position), time.monotonic())
        self.flush()

    def repeat(self) -> None:
        """Send the last once more."""
        if self._last is not None:
            self.send(self._last)

    def flush(self) -> None:
        """Send what waits, if somebody hears it now."""
        with self._lock:
            if self._publisher is None or self._waiting is None:
                return
            point, since = self._waiting
            if self._publisher.get_subscription_count() > self._own:
                self._publisher.publish(point)
                self._waiting = None
            elif time.monotonic() - since > PATIENCE:
                self._waiting = None
