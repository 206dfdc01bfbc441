"""Records a suite's topics as they are on the wire, and reads them when the run is over.

Messages are kept as bytes: reading a thousand a second while the loops run would disturb what is measured.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import Point, PointStamped
from numpy.typing import NDArray
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from gaik_ros.conversions import joint_values, point_to_array
from gaik_ros.tracking import Series

TOPICS: dict[str, type] = {
    "setpoint": Point,
    "joint_reference": JointState,
    "joint_states": JointState,
    "tip": PointStamped,
    "ik_node/status": DiagnosticStatus,
}
FAST = ("joint_states", "tip")
"""A thousand a second, each with its stamp: taken at the least cost."""

Array = NDArray[np.float64]
Raw = tuple[int, bytes]


class Recorder:
    """Subscribes to a suite's topics through `node` and remembers every message since the last `take`."""

    def __init__(self, node: Node) -> None:
        self._clock = node.get_clock()
        self._raw: dict[str, list[Raw]] = {topic: [] for topic in TOPICS}
        for topic, message_type in TOPICS.items():
            reliability = ReliabilityPolicy.BEST_EFFORT if topic in FAST else ReliabilityPolicy.RELIABLE
            profile = QoSProfile(depth=1000, reliability=reliability)
            node.create_subscription(message_type, topic, self._keeper(topic), profile, raw=True)

    def _keeper(self, topic: str) -> Callable[[bytes], None]:
        def keep(raw: bytes) -> None:
            self._raw[topic].append((self._clock.now().nanoseconds, raw))

        def keep_stamped(raw: bytes) -> None:
            self._raw[topic].append((0, raw))

        return keep_stamped if topic in FAST else keep

    def take(self) -> Recording:
        """Return what was received since the last `take`, and begin anew."""
        taken, self._raw = self._raw, {topic: [] for topic in TOPICS}
        return Recording(taken)

    def count(self, topic: str) -> int:
        """Return how many messages of a topic were received."""
        return len(self._raw[topic])

    def tip_now(self) -> Array | None:
        """Return the newest tip (3,) m, None before the first."""
        kept = self._raw["tip"]
        return point_to_array(deserialize_message(kept[-1][1], PointStamped).point) if kept else None


class Recording:
    """Messages as they were received, to be read when no loop is disturbed by it."""

    def __init__(self, raw: Mapping[str, Sequence[Raw]]) -> None:
        """`raw` has for each topic the times of receipt in ns (0 for the fast ones) and the messages' bytes."""
        self._raw = raw

    def setpoints(self) -> Series:
        """Return the setpoints (n, 3) m at the times of their receipt: they have no stamp."""
        points = [point_to_array(point) for point in self.messages("setpoint")]
        times = [1e-9 * nanoseconds for nanoseconds, _ in self._raw["setpoint"]]
        return Series(np.array(times), np.array(points).reshape(-1, 3))

    def tips(self) -> Series:
        """Return the tips (n, 3) m at the times of their stamps."""
        return self._stamped("tip", lambda message: point_to_array(message.point), 3)

    def joints(self, topic: str, names: Sequence[str]) -> Series:
        """Return the positions (n, dof) rad of joint_reference or joint_states at the times of their stamps."""
        return self._stamped(topic, lambda message: joint_values(message, names), len(names))

    def verdicts(self) -> list[dict[str, str]]:
        """Return the IK node's verdicts, each as its keys and values."""
        messages = self.messages("ik_node/status")
        return [{pair.key: pair.value for pair in message.values} for message in messages]

    def _stamped(self, topic: str, values: Callable[[Any], Array], width: int) -> Series:
        messages = self.messages(topic)
        times = [m.header.stamp.sec + 1e-9 * m.header.stamp.nanosec for m in messages]
        return Series(np.array(times), np.array([values(m) for m in messages]).reshape(-1, width))

    def messages(self, topic: str) -> list[Any]:
        """Return all messages of a topic."""
        return [deserialize_message(raw, TOPICS[topic]) for _, raw in self._raw[topic]]
