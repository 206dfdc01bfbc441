"""What a node notices about its surroundings: messages it must refuse, rival publishers, QoS that does not fit.

Each is said once or throttled, and counted for /diagnostics.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile, qos_policy_name_from_kind
from rclpy.subscription import Subscription

from gaik_ros.health import OK, WARN, Health, worst

WARN_EVERY = 5.0  # s


class Watch:
    """Creates a node's publishers and subscriptions and watches over them; `health` is its report."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._command_topics: list[str] = []
        self._rivals: set[str] = set()
        self._mismatched: dict[str, str] = {}
        self._last_warning: dict[str, float] = {}
        self._unsaid: dict[str, int] = {}
        self.refused: dict[str, int] = {}

    def publisher(
        self, message_type: type, topic: str, profile: QoSProfile, command: bool = False
    ) -> Publisher:
        """A publisher; where it is on a `command` topic, a second publisher there is warned about."""
        resolved = self._node.resolve_topic_name(topic)
        if command:
            self._command_topics.append(resolved)
        events = PublisherEventCallbacks(
            incompatible_qos=lambda event: self._mismatch(resolved, "subscription", event),
            use_default_callbacks=False,
        )
        return self._node.create_publisher(message_type, topic, profile, event_callbacks=events)

    def subscription(
        self,
        message_type: type,
        topic: str,
        callback: Callable[[Any], None],
        profile: QoSProfile,
        command: bool = False,
        raw: bool = False,
    ) -> Subscription:
        """A subscription; where it is to a `command` topic, a second publisher there is warned about."""
        resolved = self._node.resolve_topic_name(topic)
        if command:
            self._command_topics.append(resolved)
        events = SubscriptionEventCallbacks(
            incompatible_qos=lambda event: self._mismatch(resolved, "publisher", event),
            use_default_callbacks=False,
        )
        return self._node.create_subscription(
            message_type, topic, callback, profile, event_callbacks=events, raw=raw
        )

    def refuse(self, what: str, reason: object) -> None:
        """Count a refused message, and warn of it at most every few seconds."""
        self.refused[what] = self.refused.get(what, 0) + 1
        now = time.monotonic()
        if now - self._last_warning.get(what, -WARN_EVERY) < WARN_EVERY:
            self._unsaid[what] = self._unsaid.get(what, 0) + 1
            return
        unsaid = self._unsaid.pop(what, 0)
        more = f" ({unsaid} more since the last warning)" if unsaid else ""
        self._last_warning[what] = now
        self._node.get_logger().warning(f"{what} refused: {reason}{more}")

    def _mismatch(self, topic: str, other: str, event: Any) -> None:
        policy = qos_policy_name_from_kind(event.last_policy_kind)
        if topic not in self._mismatched:
            self._node.get_logger().warning(
                f"a {other} on {topic} has another {policy} than ours: no message will pass"
            )
        self._mismatched[topic] = str(policy)

    def health(self) -> Health:
        """Rival publishers and mismatched QoS; to be called once a second."""
        findings = [
            (WARN, f"a {policy} on {topic} does not fit") for topic, policy in self._mismatched.items()
        ]
        for topic in self._command_topics:
            count = self._node.count_publishers(topic)
            if count > 1:
                findings.append((WARN, f"{count} publishers on {topic}"))
                if topic not in self._rivals:
                    self._node.get_logger().warning(
                        f"{count} publishers on {topic}: if both speak at once, the device is pulled to and fro"
                    )
                self._rivals.add(topic)
        level, message = worst(findings)
        figures = {f"refused_{what}": count for what, count in self.refused.items()}
        return Health(level if findings else OK, message, figures)
