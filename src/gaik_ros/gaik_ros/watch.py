"""What a node notices about its surroundings: messages it must refuse, rival publishers, QoS that does not fit.

Each is said once or throttled, and counted for /diagnostics.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSCompatibility, QoSProfile, qos_check_compatible, qos_policy_name_from_kind
from rclpy.subscription import Subscription
from rclpy.topic_endpoint_info import TopicEndpointInfo

from gaik_ros.health import OK, WARN, Health, worst

WARN_EVERY = 5.0  # s


@dataclass
class _Misfit:
    """Publishers or subscriptions of others on a topic whose QoS does not fit ours."""

    policy: str
    unseen: int = 0  # how many times in a row the graph has not shown it


def _misfit(offered: QoSProfile, asked: QoSProfile) -> bool:
    return bool(qos_check_compatible(offered, asked)[0] == QoSCompatibility.ERROR)


class Watch:
    """Creates a node's publishers and subscriptions and watches over them; `health` is its report."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._sole_topics: list[str] = []
        self._rivals: set[str] = set()
        self._misfits: dict[tuple[str, str], _Misfit] = {}
        self._last_warning: dict[str, float] = {}
        self._unsaid: dict[str, int] = {}
        self.refused: dict[str, int] = {}

    def publisher(self, message_type: type, topic: str, profile: QoSProfile, sole: bool = False) -> Publisher:
        """A publisher; where it should be the `sole` one on its topic, another there is warned about."""
        resolved = self._node.resolve_topic_name(topic)
        if sole:
            self._sole_topics.append(resolved)
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
        sole: bool = False,
        raw: bool = False,
    ) -> Subscription:
        """A subscription; where its topic should have a `sole` publisher, a second one is warned about."""
        resolved = self._node.resolve_topic_name(topic)
        if sole:
            self._sole_topics.append(resolved)
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
        if (topic, other) not in self._misfits:
            self._node.get_logger().warning(
                f"a {other} on {topic} has another {policy} than ours: no message will pass"
            )
        self._misfits[topic, other] = _Misfit(str(policy))

    def _forget_gone(self) -> None:
        """Drop the misfits that are not to be seen any more; the graph is asked only where there is one."""
        for (topic, other), misfit in list(self._misfits.items()):
            misfit.unseen = 0 if self._seen(topic, other) else misfit.unseen + 1
            if misfit.unseen > 1:  # the first time the graph may not yet show what was just told of
                del self._misfits[topic, other]

    def _seen(self, topic: str, other: str) -> bool:
        """Whether some `other` on `topic` does not fit ours, as the graph has both."""
        offers = self._node.get_publishers_info_by_topic(topic)
        requests = self._node.get_subscriptions_info_by_topic(topic)
        if other == "publisher":
            requests = [info for info in requests if self._is_ours(info)]
        else:
            offers = [info for info in offers if self._is_ours(info)]
        return any(
            _misfit(offer.qos_profile, request.qos_profile) for offer in offers for request in requests
        )

    def _is_ours(self, info: TopicEndpointInfo) -> bool:
        node = self._node
        return bool(info.node_name == node.get_name() and info.node_namespace == node.get_namespace())

    def health(self) -> Health:
        """Rival publishers and mismatched QoS; to be called once a second."""
        self._forget_gone()
        findings = [
            (WARN, f"a {misfit.policy} on {topic} does not fit")
            for (topic, _), misfit in self._misfits.items()
        ]
        counts = {topic: self._node.count_publishers(topic) for topic in self._sole_topics}
        rivals = {topic: count for topic, count in counts.items() if count > 1}
        for topic, count in rivals.items():
            findings.append((WARN, f"{count} publishers on {topic}"))
            if topic not in self._rivals:
                self._node.get_logger().warning(
                    f"{count} publishers on {topic}: if both speak at once, the device is pulled to and fro"
                )
        self._rivals = set(rivals)
        level, message = worst(findings)
        figures = {f"refused_{what}": count for what, count in self.refused.items()}
        return Health(level if findings else OK, message, figures)
