"""What was heard of a suite, kept as bytes, and read when no loop is disturbed by it. Needs no ROS."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gaik_ros.joint_message import JointMessageError, joint_values
from gaik_ros.tracking import Series

Array = NDArray[np.float64]
Raw = tuple[int, bytes]
"""The time of receipt in ns, 0 where it was not noted, and the message as it was on the wire."""

TOPICS: dict[str, str] = {
    "setpoint": "geometry_msgs/msg/Point",
    "joint_reference": "sensor_msgs/msg/JointState",
    "joint_states": "sensor_msgs/msg/JointState",
    "tip": "geometry_msgs/msg/PointStamped",
    "ik_node/status": "diagnostic_msgs/msg/DiagnosticStatus",
}
"""The topics of a suite that its tracking is measured by, relative to its namespace, each with its type."""

ONE_CLOCK = (
    0.1  # s: a stamp is as good as the time of receipt where they differ by less, and it is more exact
)


@dataclass(frozen=True)
class Recording:
    """Messages of a suite by topic, relative to its namespace.

    Attributes:
        raw: what was received, in order.
        types: the type of each topic.
        deserialize: makes a message of its bytes and its type.
    """

    raw: Mapping[str, Sequence[Raw]]
    types: Mapping[str, str]
    deserialize: Callable[[bytes, str], Any]

    def messages(self, topic: str) -> list[Any]:
        """Return all messages of a topic."""
        return [self.deserialize(data, self.types[topic]) for _, data in self.raw.get(topic, ())]

    def setpoints(self) -> Series:
        """Return the finite setpoints (n, 3) m at the times of their receipt: they have no stamp."""
        points = np.array([(p.x, p.y, p.z) for p in self.messages("setpoint")]).reshape(-1, 3)
        times = self._received("setpoint")
        finite = np.isfinite(points).all(axis=1)
        return Series(times[finite], points[finite])

    def tips(self) -> Series:
        """Return the tips (n, 3) m."""
        messages = self.messages("tip")
        points = [(m.point.x, m.point.y, m.point.z) for m in messages]
        return Series(self._times("tip", messages), np.array(points).reshape(-1, 3))

    def joints(self, topic: str, names: Sequence[str]) -> Series:
        """Return the positions (n, dof) rad of joint_reference or joint_states.

        Messages that do not have them are passed over; JointMessageError where none has.
        """
        messages = self.messages(topic)
        values, good, reason = [], [], None
        for number, message in enumerate(messages):
            try:
                values.append(joint_values(message, names))
                good.append(number)
            except JointMessageError as error:
                reason = error
        if reason is not None and not good:
            raise JointMessageError(f"no message on {topic} can be read: {reason}")
        return Series(self._times(topic, messages)[good], np.array(values).reshape(-1, len(names)))

    def joint_names(self, topic: str) -> tuple[str, ...]:
        """Return the joints in the first message of joint_reference or joint_states; none where there is none."""
        kept = self.raw.get(topic, ())
        return tuple(self.deserialize(kept[0][1], self.types[topic]).name) if kept else ()

    def verdicts(self) -> list[dict[str, str]]:
        """Return the IK node's verdicts, each as its keys and values."""
        return [{p.key: p.value for p in m.values} for m in self.messages("ik_node/status")]

    def _received(self, topic: str) -> Array:
        return 1e-9 * np.array([nanoseconds for nanoseconds, _ in self.raw.get(topic, ())], dtype=np.float64)

    def _times(self, topic: str, messages: Sequence[Any]) -> Array:
        """Return the times of the stamps, or of receipt where the stamps are of another clock or of none."""
        stamps = np.array([m.header.stamp.sec + 1e-9 * m.header.stamp.nanosec for m in messages])
        received = self._received(topic)
        if not stamps.size or not received.any() or np.median(np.abs(stamps - received)) < ONE_CLOCK:
            return stamps
        return received
