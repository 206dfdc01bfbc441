"""The node `path_markers`: the desired and the followed path as markers for RViz and Foxglove."""

from __future__ import annotations

import sys
from collections import deque
from collections.abc import Sequence
from typing import Any

import numpy as np
from geometry_msgs.msg import Point
from numpy.typing import NDArray
from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from gaik_core import KinematicChain
from gaik_ros import qos
from gaik_ros.conversions import JointMessageError, array_to_point, point_to_array, raw_joint_values
from gaik_ros.parameters import Parameter, ParameterTable
from gaik_ros.run import run
from gaik_ros.watch import Watch

Array = NDArray[np.float64]

MARKERS = QoSProfile(depth=10)  # reliable, as RViz asks for

TABLE = ParameterTable(
    "path_markers",
    (
        Parameter(
            "robot", "touch_device", "", "a robot of gaik_core, or the path of a robot file", read_only=True
        ),
        Parameter("frame_id", "touch_origin", "", "frame of setpoints and tip", read_only=True),
        Parameter("rate", 10.0, "Hz", "how often the markers are published", 0.1, 100.0, read_only=True),
        Parameter(
            "samples", 10, "", "points of the followed path for each publication", 1, 100, read_only=True
        ),
        Parameter("length", 7.0, "s", "how long a part of the paths is shown", 0.1, 3600.0, read_only=True),
        Parameter("line_width", 0.0015, "m", "of the followed path; the desired one is wider", 1e-5, 1.0),
    ),
)

DESIRED = ColorRGBA(r=0.15, g=0.15, b=0.15, a=1.0)
FOLLOWED = ColorRGBA(r=0.9, g=0.1, b=0.1, a=1.0)
WIDER = 2.0
BALL = 6.0
"""Widths of the desired path and of the balls at the newest points, in widths of the followed path."""


class Trail:
    """The newest points of a path: at most `capacity`, the newest last; one that has not moved is not repeated."""

    def __init__(self, capacity: int) -> None:
        self.points: deque[Point] = deque(maxlen=capacity)
        self._newest: Array | None = None

    def add(self, position: Array) -> None:
        """Go on to a position (3,) m; one that is not finite is passed over."""
        if not np.isfinite(position).all() or (self._newest is not None and (position == self._newest).all()):
            return
        self._newest = position.copy()
        self.points.append(array_to_point(position))


class PathMarkers(Node):
    """`setpoint` and `joint_states` in, `~/markers` out."""

    def __init__(self, **node_kwargs: Any) -> None:
        super().__init__(TABLE.node, **node_kwargs)
        self.values = TABLE.declare(self)
        values = self.values
        self._chain = KinematicChain.load(values.robot)
        samples = values.rate * values.samples
        self._desired, self._followed = (Trail(max(2, round(values.length * samples))) for _ in range(2))
        self._newest_state: bytes | None = None
        self._sampled = 0
        self._watch = Watch(self)
        self._publisher = self.create_publisher(MarkerArray, "~/markers", MARKERS)
        self._watch.subscription(Point, "setpoint", self._on_setpoint, qos.SETPOINT)
        # Read only when it is looked at: a thousand a second need not be.
        self._watch.subscription(
            JointState, "joint_states", self._on_state, qos.JOINT_STATES_SUBSCRIPTION, raw=True
        )
        self.create_timer(1.0 / samples, self._sample)

    def _on_setpoint(self, message: Point) -> None:
        self._desired.add(point_to_array(message))

    def _on_state(self, raw: bytes) -> None:
        self._newest_state = raw

    def _sample(self) -> None:
        raw, self._newest_state = self._newest_state, None
        if raw is not None:
            try:
                angles = raw_joint_values(raw, self._chain.joint_names)
                self._followed.add(self._chain.forward(angles))
            except JointMessageError as reason:
                self._watch.refuse("joint_states", reason)
        self._sampled += 1
        if self._sampled % self.values.samples == 0:
            self._publisher.publish(self._markers())

    def _markers(self) -> MarkerArray:
        width = self.values.line_width
        return MarkerArray(
            markers=[
                marker
                for name, trail, wide, colour in (
                    ("desired", self._desired, WIDER * width, DESIRED),
                    ("followed", self._followed, width, FOLLOWED),
                )
                for marker in (
                    self._marker(name, Marker.LINE_STRIP, list(trail.points), wide, colour),
                    self._marker(
                        f"{name}_now", Marker.SPHERE_LIST, list(trail.points)[-1:], BALL * width, colour
                    ),
                )
            ]
        )

    def _marker(self, name: str, kind: int, points: list[Point], size: float, colour: ColorRGBA) -> Marker:
        """A marker of points; one that has too few to be drawn takes the place of an earlier one away."""
        drawn = len(points) >= (2 if kind == Marker.LINE_STRIP else 1)
        marker = Marker(ns=name, id=0, type=kind, action=Marker.ADD if drawn else Marker.DELETE, color=colour)
        marker.header.frame_id = self.values.frame_id
        marker.header.stamp = self.get_clock().now().to_msg()
        marker.pose.orientation.w = 1.0
        marker.scale.x = marker.scale.y = marker.scale.z = float(size)
        marker.points = points if drawn else []
        return marker


def main(args: Sequence[str] | None = None) -> int:
    """Entry point of the executable."""
    return run(PathMarkers, args, TABLE)


if __name__ == "__main__":
    sys.exit(main())
