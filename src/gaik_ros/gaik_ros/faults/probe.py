"""Hears what a suite says, as bytes with the time of receipt; they are read when the fault is over."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Point
from numpy.typing import NDArray
from rclpy.context import Context
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from gaik_ros.conversions import joint_values
from gaik_ros.deadline_loop import DeadlineLoop

Array = NDArray[np.float64]
Heard = tuple[float, bytes]
"""Time of receipt, s of the monotonic clock, and the message as it was on the wire."""

TOPICS: Mapping[str, type] = {
    "setpoint": Point,
    "joint_reference": JointState,
    "joint_command": JointState,
    "joint_states": JointState,
    "ik_node/status": DiagnosticStatus,
    "/diagnostics": DiagnosticArray,
}
# A QoS that does not fit is one of the faults: the nodes shall warn of it, not the injector.
QUIET_SUBSCRIPTION = SubscriptionEventCallbacks(use_default_callbacks=False)
QUIET_PUBLISHER = PublisherEventCallbacks(use_default_callbacks=False)

LEAD_RATE = 100.0  # Hz

OWN_FRAME = "fault_injector"
"""The frame_id of what the injector itself publishes on the suite's topics; it is not counted as the suite's."""

_BEST_EFFORT = ("joint_command", "joint_states")  # a thousand a second


@dataclass(frozen=True)
class Joints:
    """The messages of one JointState topic, one row each."""

    received: Array  # (n,) s
    stamp: Array  # (n,) s
    values: Array  # (n, dof): rad or N·m; NaN in every row that does not hold the joints


@dataclass(frozen=True)
class HealthReport:
    """One status of /diagnostics."""

    received: float
    level: bytes
    message: str
    values: Mapping[str, str]


class Recording:
    """What was heard over a span of time."""

    def __init__(self, heard: Mapping[str, Sequence[Heard]], namespace: str) -> None:
        self._heard = heard
        self._prefix = namespace.strip("/") + "/" if namespace.strip("/") else ""

    def count(self, topic: str) -> int:
        """How many messages came on a topic."""
        return len(self._heard[topic])

    def received(self, topic: str) -> Array:
        """When they came, (n,) s."""
        return np.array([at for at, _ in self._heard[topic]], dtype=np.float64)

    def messages(self, topic: str) -> list[Any]:
        """The messages of a topic."""
        return [deserialize_message(raw, TOPICS[topic]) for _, raw in self._heard[topic]]

    def joints(self, topic: str, names: Sequence[str], field: str = "position") -> Joints:
        """The `field` of every message of a JointState topic."""
        heard = zip(self.received(topic), self.messages(topic), strict=True)
        kept = [(at, message) for at, message in heard if message.header.frame_id != OWN_FRAME]
        messages = [message for _, message in kept]
        stamps = np.array([m.header.stamp.sec + 1e-9 * m.header.stamp.nanosec for m in messages])
        rows = np.array([_row(m, names, field) for m in messages]).reshape(-1, len(names))
        return Joints(np.array([at for at, _ in kept]), stamps, rows)

    def verdicts(self) -> list[dict[str, str]]:
        """The IK node's verdicts, each as its keys and values."""
        return [{pair.key: pair.value for pair in m.values} for m in self.messages("ik_node/status")]

    def health(self, part: str) -> list[HealthReport]:
        """The reports of one part of a node of this suite, such as "pid_controller: control"."""
        return [
            HealthReport(at, status.level, status.message, {p.key: p.value for p in status.values})
            for at, message in zip(self.received("/diagnostics"), self.messages("/diagnostics"), strict=True)
            for status in message.status
            if status.name == self._prefix + part
        ]


def _row(message: JointState, names: Sequence[str], field: str) -> Array:
    try:
        return joint_values(message, names, field)
    except ValueError:
        return np.full(len(names), np.nan)


class Probe(Node):
    """The injector's own node: subscribed to everything the suite says."""

    def __init__(self, namespace: str, context: Context | None = None) -> None:
        super().__init__("fault_injector", namespace=namespace, context=context)
        self.led_by: Callable[[float], None] | None = None  # is called with dt
        self.loop = DeadlineLoop(LEAD_RATE, self._lead)
        self._heard: dict[str, list[Heard]] = {topic: [] for topic in TOPICS}
        for topic, message_type in TOPICS.items():
            fast = topic in _BEST_EFFORT
            profile = QoSProfile(
                depth=2000,
                reliability=ReliabilityPolicy.BEST_EFFORT if fast else ReliabilityPolicy.RELIABLE,
                durability=DurabilityPolicy.VOLATILE,
            )
            self.create_subscription(
                message_type,
                topic,
                self._keeper(topic),
                profile,
                raw=True,
                event_callbacks=QUIET_SUBSCRIPTION,
            )

    def _keeper(self, topic: str) -> Callable[[bytes], None]:
        heard = self._heard[topic]

        def keep(raw: bytes) -> None:
            heard.append((time.monotonic(), raw))

        return keep

    def _lead(self, dt: float) -> None:
        if self.led_by is not None:
            self.led_by(dt)

    def forget(self) -> None:
        """Drop all that was heard, but the newest of each topic."""
        for heard in self._heard.values():
            del heard[:-1]

    def mark(self) -> dict[str, int]:
        """Where a recording may begin: now."""
        return {topic: len(heard) for topic, heard in self._heard.items()}

    def since(self, mark: Mapping[str, int]) -> Recording:
        """All that was heard since `mark`; no `forget` may lie between."""
        return Recording(
            {topic: heard[mark[topic] :] for topic, heard in self._heard.items()}, self.get_namespace()
        )

    def newest(self, topic: str) -> Any | None:
        """The newest message of a topic, None before the first."""
        heard = self._heard[topic]
        return deserialize_message(heard[-1][1], TOPICS[topic]) if heard else None

    def age(self, topic: str) -> float:
        """How long ago the newest message of a topic came, s; infinite before the first."""
        heard = self._heard[topic]
        return time.monotonic() - heard[-1][0] if heard else float("inf")
