"""The node `record`: writes what a suite says as an MCAP bag, until it is stopped."""

from __future__ import annotations

import contextlib
import sys
import time
from collections import deque
from collections.abc import Callable, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from gaik_ros.bag_writer import BagError, BagWriter
from gaik_ros.message_types import message_class
from gaik_ros.parameters import Parameter, ParameterTable
from gaik_ros.recorder import FAST
from gaik_ros.recording import TOPICS
from gaik_ros.run import run

SUITE = {
    **TOPICS,
    "joint_command": "sensor_msgs/msg/JointState",
    "robot_description": "std_msgs/msg/String",
    "path_markers/markers": "visualization_msgs/msg/MarkerArray",
    "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
}
"""What is recorded of every suite. All relative but the last."""

DESKTOP = {"tf": "tf2_msgs/msg/TFMessage", "tf_static": "tf2_msgs/msg/TFMessage"}
"""What is recorded too where its type is installed, as on a ROS desktop."""

LATCHED = ("robot_description", "tf_static")

DEPTH = 2000  # messages: two seconds of the fastest topic
WRITE = 0.1  # s between writes
LOOK = 1.0  # s between looks for further topics

TABLE = ParameterTable(
    "record",
    (
        Parameter(
            "bag",
            "",
            "",
            "folder to write, which may not exist yet; empty: run_ and the time",
            read_only=True,
        ),
        Parameter("duration", 0.0, "s", "how long; 0: until stopped", 0.0, 1e7, read_only=True),
        Parameter(
            "topics",
            ("",),
            "",
            "further topics by name, recorded from when they are there; `all`: whatever there is",
            read_only=True,
        ),
    ),
)

ALL = "all"


class Record(Node):
    """Subscribes to a suite's topics, and to further ones as they appear, and writes them as they are on the wire."""

    def __init__(self, **node_kwargs: Any) -> None:
        super().__init__(TABLE.node, **node_kwargs)
        self.values = TABLE.declare(self)
        self._kept: deque[tuple[str, str, int, bytes]] = deque()
        self._seen: set[str] = set()
        self._refused: set[str] = set()
        self._closed = False
        self._wanted = {self._resolved(name) for name in self.values.topics if name not in ("", ALL)}
        self._writer = BagWriter(Path(self.values.bag or f"run_{datetime.now():%Y-%m-%d_%H-%M-%S}"))
        for topic, type_name in SUITE.items():
            self._subscribe(self.resolve_topic_name(topic), type_name, *_usual(topic))
        for topic, type_name in DESKTOP.items():
            with contextlib.suppress(ValueError):
                self._subscribe(self.resolve_topic_name(topic), type_name, *_usual(topic))
        self._all = ALL in self.values.topics
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(WRITE, self._write, clock=steady)
        if self._wanted or self._all:
            self.create_timer(LOOK, self._look, clock=steady)
        self._end = time.monotonic() + self.values.duration if self.values.duration else float("inf")
        self.get_logger().info(f"recording to {self._writer.file}")

    @property
    def counts(self) -> dict[str, int]:
        """How many messages of each topic have been written."""
        return dict(self._writer.counts)

    def _resolved(self, topic: str) -> str:
        try:
            return str(self.resolve_topic_name(topic))
        except rclpy_implementation.RCLError:
            wanted = list(self.values.topics)
            raise ValueError(f"parameter 'topics' is {wanted}: {topic!r} is no name of a topic") from None

    def _subscribe(
        self,
        topic: str,
        type_name: str,
        reliability: ReliabilityPolicy,
        durability: DurabilityPolicy = DurabilityPolicy.VOLATILE,
    ) -> None:
        self._seen.add(topic)
        profile = QoSProfile(depth=DEPTH, reliability=reliability, durability=durability)
        self.create_subscription(
            message_class(type_name), topic, self._keeper(topic, type_name), profile, raw=True
        )

    def _keeper(self, topic: str, type_name: str) -> Callable[[bytes], None]:
        def keep(raw: bytes) -> None:
            self._kept.append((topic, type_name, time.time_ns(), raw))

        return keep

    def _write(self) -> None:
        try:
            self._empty()
        except OSError as reason:
            self.get_logger().error(f"the recording ends: {reason}")
            self.context.try_shutdown()
        if time.monotonic() > self._end:
            self.context.try_shutdown()

    def _empty(self) -> None:
        while self._kept:
            self._writer.write(*self._kept.popleft())

    def _look(self) -> None:
        """Subscribe to wanted topics that have appeared, with what their publishers offer."""
        if not self.context.ok():  # `_write` may have ended it in the same round
            return
        for topic, (type_name, *_) in self.get_topic_names_and_types():
            if topic in self._seen or not (self._all or topic in self._wanted):
                continue
            offers = [info.qos_profile for info in self.get_publishers_info_by_topic(topic)]
            if not offers:
                continue
            try:
                if not self._writer.knows(type_name):
                    raise BagError(f"its type {type_name} is not known to the writer")
                self._subscribe(topic, type_name, *_common(offers))
            except ValueError as reason:
                self._seen.add(topic)
                self._refused.add(topic)
                self.get_logger().warning(f"{topic} is not recorded: {reason}")

    def _close(self) -> None:
        if self._closed:
            return
        self._closed = True
        try:
            self._empty()
            self._writer.close()
        except OSError as reason:
            self.get_logger().error(f"{self._writer.file} is not complete: {reason}")
            return
        counts = self._writer.counts
        if unheard := sorted(self._wanted - self._refused - counts.keys()):
            self.get_logger().warning(f"nothing was heard on {', '.join(unheard)}")
        total = f"{sum(counts.values())} messages of {len(counts)} topics"
        self.get_logger().info(f"{total} in {self._writer.file}")

    def destroy_node(self) -> None:
        """Complete the bag, then end."""
        self._close()
        super().destroy_node()


def _usual(topic: str) -> tuple[ReliabilityPolicy, DurabilityPolicy]:
    """What is asked for of a suite's topic: as its nodes offer, and of the fast ones what any driver offers."""
    reliability = ReliabilityPolicy.BEST_EFFORT if topic in FAST else ReliabilityPolicy.RELIABLE
    return reliability, (DurabilityPolicy.TRANSIENT_LOCAL if topic in LATCHED else DurabilityPolicy.VOLATILE)


def _common(offers: Sequence[QoSProfile]) -> tuple[ReliabilityPolicy, DurabilityPolicy]:
    """What every publisher of a topic offers."""
    reliable = all(offer.reliability == ReliabilityPolicy.RELIABLE for offer in offers)
    late = all(offer.durability == DurabilityPolicy.TRANSIENT_LOCAL for offer in offers)
    return (
        ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        DurabilityPolicy.TRANSIENT_LOCAL if late else DurabilityPolicy.VOLATILE,
    )


def main(args: Sequence[str] | None = None) -> int:
    """Entry point of the executable."""
    return run(Record, args, TABLE)


if __name__ == "__main__":
    sys.exit(main())
