"""Hears a suite's topics as they are on the wire and remembers them.

Messages are kept as bytes: reading a thousand a second while the loops run would disturb what is measured.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message

from gaik_ros.conversions import point_to_array
from gaik_ros.message_types import message_class
from gaik_ros.recording import TOPICS, Raw, Recording

FAST = ("joint_states", "joint_command", "tip")
"""A thousand a second, each with its stamp: taken at the least cost."""

Array = NDArray[np.float64]


class Recorder:
    """Subscribes to a suite's topics through `node` and remembers every message since the last `take`."""

    def __init__(self, node: Node, topics: Mapping[str, str] = TOPICS) -> None:
        """`topics` by name, relative to the node's namespace, with their types."""
        self._clock = node.get_clock()
        self._types = dict(topics)
        self._raw = self._empty()
        for topic, type_name in topics.items():
            reliability = ReliabilityPolicy.BEST_EFFORT if topic in FAST else ReliabilityPolicy.RELIABLE
            profile = QoSProfile(depth=1000, reliability=reliability)
            node.create_subscription(message_class(type_name), topic, self._keeper(topic), profile, raw=True)

    def _empty(self) -> dict[str, list[Raw]]:
        return {topic: [] for topic in self._types}

    def _keeper(self, topic: str) -> Callable[[bytes], None]:
        def keep(raw: bytes) -> None:
            self._raw[topic].append((self._clock.now().nanoseconds, raw))

        def keep_stamped(raw: bytes) -> None:
            self._raw[topic].append((0, raw))

        return keep_stamped if topic in FAST else keep

    def take(self) -> Recording:
        """Return what was received since the last `take`, and begin anew."""
        taken, self._raw = self._raw, self._empty()
        return Recording(taken, self._types, _deserialize)

    def count(self, topic: str) -> int:
        """Return how many messages of a topic were received."""
        return len(self._raw[topic])

    def newest(self, topic: str) -> Any:
        """Return the newest message of a topic since the last `take`, None where there is none."""
        kept = self._raw[topic]
        return _deserialize(kept[-1][1], self._types[topic]) if kept else None

    def tip_now(self) -> Array | None:
        """Return the newest tip (3,) m since the last `take`, None where there is none."""
        message = self.newest("tip")
        return None if message is None else point_to_array(message.point)


def _deserialize(data: bytes, type_name: str) -> Any:
    return deserialize_message(data, message_class(type_name))
