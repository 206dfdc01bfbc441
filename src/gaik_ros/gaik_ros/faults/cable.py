"""The cable between device and suite: joint_states pass through here, and can be altered on the way."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rclpy.node import Node
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import JointState

from gaik_ros import qos

DEVICE_TOPIC = "device/joint_states"
"""What the device publishes as where its joint_states come through the cable."""

Alteration = Callable[[JointState], JointState | None]
"""What becomes of a message; None: it does not arrive."""


class Cable:
    """Passes joint_states on from the device, as bytes while nothing is altered."""

    def __init__(self, node: Node, device_topic: str = DEVICE_TOPIC) -> None:
        self._node = node
        self._publisher = node.create_publisher(JointState, "joint_states", qos.JOINT_STATES)
        self._subscription = node.create_subscription(
            JointState, device_topic, self._pass, qos.JOINT_STATES_SUBSCRIPTION, raw=True
        )
        self._alteration: Alteration | None = None
        self.newest: bytes | None = None
        self.cut_at = 0.0  # when the alteration began, s of the monotonic clock
        self.altered = 0

    def _pass(self, raw: bytes) -> None:
        self.newest = raw
        alteration = self._alteration
        if alteration is None:
            self._publisher.publish(raw)
            return
        self.altered += 1
        message = alteration(deserialize_message(raw, JointState))
        if message is not None:
            self._publisher.publish(serialize_message(message))

    @contextmanager
    def altered_by(self, alteration: Alteration) -> Iterator[None]:
        """Alter every message within the block."""
        self.altered, self.cut_at = 0, time.monotonic()
        self._alteration = alteration
        try:
            yield
        finally:
            self._alteration = None

    def remove(self) -> None:
        """Take the cable out."""
        self._node.destroy_subscription(self._subscription)
        self._node.destroy_publisher(self._publisher)
