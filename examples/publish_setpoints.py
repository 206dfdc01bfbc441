"""Setpoints from Python: a small node that draws a square with the tip, while a suite runs elsewhere.

Start a suite first, for example `make view`, or the nodes by hand without the trajectory publisher.
"""

import sys

import rclpy
from geometry_msgs.msg import Point
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

SIDE, SECONDS = 0.06, 8.0  # m, for one lap


class Square(Node):
    """Publishes the corners' connecting lines at 50 Hz, once around."""

    def __init__(self) -> None:
        super().__init__("square")
        self.publisher = self.create_publisher(Point, "setpoint", 10)
        self.sent = 0
        self.timer = self.create_timer(0.02, self.send)

    def send(self) -> None:
        """One setpoint: side and way along it follow from how many were sent."""
        side, along = divmod(4.0 * 0.02 * self.sent / SECONDS, 1.0)
        if side >= 4:
            raise SystemExit
        corners = [(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)]
        (x0, y0), (x1, y1) = corners[int(side)], corners[int(side) + 1]
        x, y = x0 + along * (x1 - x0), y0 + along * (y1 - y0)
        self.publisher.publish(Point(x=float(0.5 * SIDE * x), y=float(0.5 * SIDE * y), z=0.0))
        self.sent += 1


rclpy.init(args=sys.argv)
square = Square()
try:
    rclpy.spin(square)
except (KeyboardInterrupt, SystemExit, ExternalShutdownException):
    print(f"{square.sent} setpoints sent")
finally:
    rclpy.try_shutdown()
