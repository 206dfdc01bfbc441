"""Between messages and arrays. A JointState is read by name, never by position in the array.

With rclpy's field checks off (its default) a numpy scalar or an int in a message field is sent as garbage
without a word; so every value is made a Python float here.
"""

from __future__ import annotations

from array import array
from collections.abc import Sequence

import numpy as np
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point
from numpy.typing import ArrayLike, NDArray
from rclpy.clock import Clock, ROSClock
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from gaik_ros.joint_message import JointMessageError, joint_values

Array = NDArray[np.float64]

__all__ = [
    "JointMessageError",
    "array_to_point",
    "fill",
    "joint_state",
    "joint_values",
    "point_to_array",
    "raw_joint_values",
    "ros_time",
    "stamp_now",
]


def point_to_array(point: Point) -> Array:
    """The point as (3,), m."""
    return np.array((point.x, point.y, point.z), dtype=np.float64)


def array_to_point(values: ArrayLike) -> Point:
    """A Point from (3,), m."""
    x, y, z = np.asarray(values, dtype=np.float64).tolist()
    return Point(x=x, y=y, z=z)


def joint_state(
    names: Sequence[str],
    position: ArrayLike | None = None,
    velocity: ArrayLike | None = None,
    effort: ArrayLike | None = None,
    stamp: Time | None = None,
) -> JointState:
    """A JointState; each field given has one value for each of `names` (rad, rad/s, N·m)."""
    message = JointState(name=list(names))
    for field, values in (("position", position), ("velocity", velocity), ("effort", effort)):
        if values is not None:
            fill(message, field, values)
    if stamp is not None:
        message.header.stamp = stamp
    return message


def fill(message: JointState, field: str, values: ArrayLike) -> None:
    """Put `values` into `field` of a message that is used again and again; cheaper than a new message."""
    setattr(message, field, array("d", np.asarray(values, dtype=np.float64).tolist()))


def raw_joint_values(raw: bytes, names: Sequence[str], field: str = "position") -> Array:
    """As `joint_values`, of a message as it is on the wire. Raises JointMessageError where the bytes are none, too."""
    try:
        message = deserialize_message(raw, JointState)
    except rclpy_implementation.RMWError as reason:
        raise JointMessageError(f"its {len(raw)} bytes are no JointState") from reason
    return joint_values(message, names, field)


def stamp_now(stamp: Time, clock: Clock) -> None:
    """Set `stamp` to the clock's time, without making a new one."""
    stamp.sec, stamp.nanosec = clock.now().seconds_nanoseconds()


def ros_time(clock: Clock) -> int | None:
    """The time in ns of a clock that /clock leads, None where it is the system's."""
    return clock.now().nanoseconds if isinstance(clock, ROSClock) and clock.ros_time_is_active else None
