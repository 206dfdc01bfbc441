"""Setpoints along a path at a fixed rate: a circle, a lemniscate, or points from a CSV file."""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence
from typing import Any

from geometry_msgs.msg import Point
from rclpy.node import Node
from std_srvs.srv import Trigger

from gaik_core.paths import Circle, Lemniscate, Path
from gaik_ros import qos
from gaik_ros.conversions import array_to_point
from gaik_ros.deadline_loop import DeadlineLoop
from gaik_ros.health import LOOP_PARAMETERS, OK, Health, HealthReporter
from gaik_ros.parameters import Parameter, ParameterError, ParameterSet, ParameterTable
from gaik_ros.point_file import read_points
from gaik_ros.run import run
from gaik_ros.trajectory import Array, Progress, Trajectory, along_path, through_points
from gaik_ros.watch import Watch

CIRCLE, LEMNISCATE, POINTS = "circle", "lemniscate", "points"


def _three(value: Any) -> None:
    if len(value) != 3:
        raise ValueError("it must have three coordinates")


TABLE = ParameterTable(
    "trajectory_publisher",
    (
        Parameter("path", CIRCLE, "", "the path to follow", choices=(CIRCLE, LEMNISCATE, POINTS)),
        Parameter("rate", 100.0, "Hz", "setpoints a second", 0.01, 10_000.0, read_only=True),
        Parameter("lap_time", 6.3, "s", "time of one lap of a circle or lemniscate", 0.01),
        Parameter("loop", True, "", "begin again at the end of the path, instead of stopping there"),
        Parameter("autostart", True, "", "begin at once, instead of at ~/start", read_only=True),
        Parameter(
            "centre", (0.0, 0.0, 0.0), "m", "centre of a circle or lemniscate", -10.0, 10.0, check=_three
        ),
        Parameter("radius", 0.05, "m", "of the circle", 1e-6, 10.0),
        Parameter("half_width", 0.08, "m", "of the lemniscate", 1e-6, 10.0),
        Parameter(
            "circle_tilt", math.pi / 6.0, "rad", "turn of the circle's plane about x", -math.pi, math.pi
        ),
        Parameter("lemniscate_tilt", 0.0, "rad", "turn of the lemniscate's plane about x", -math.pi, math.pi),
        Parameter(
            "file", "", "", "CSV file with columns x, y, z in m, one point for each period, for path points"
        ),
        *LOOP_PARAMETERS,
    ),
)


def points_of(values: ParameterSet) -> Array | None:
    """The points (n, 3) in m of the file, None for another path. ValueError: no file, or no list of points."""
    if values.path != POINTS:
        return None
    if not values.file:
        raise ParameterError(
            "parameter 'file' is '': the path points needs a CSV file with the columns x, y, z"
        )
    return read_points(values.file)


def trajectory_of(values: ParameterSet, points: Array | None) -> Trajectory:
    """The trajectory that the parameters describe: through `points` (n, 3) in m where there are any."""
    if points is not None:
        return through_points(points, values.rate)
    path: Path
    if values.path == CIRCLE:
        path = Circle(radius=values.radius, tilt=values.circle_tilt, centre=values.centre)
    else:
        path = Lemniscate(half_width=values.half_width, tilt=values.lemniscate_tilt, centre=values.centre)
    return along_path(path, values.lap_time)


class TrajectoryPublisher(Node):
    """A path out as setpoints; `~/start` from its beginning, `~/stop`."""

    def __init__(self, **node_kwargs: Any) -> None:
        super().__init__(TABLE.node, **node_kwargs)
        self._lock = threading.Lock()  # services start and stop what the loop's thread follows
        self.values = TABLE.declare(self, self._configure)
        self._points = points_of(self.values)
        self._progress = Progress(trajectory_of(self.values, self._points))
        self._running = self.values.autostart
        self._sent = 0
        self._watch = Watch(self)
        self._publisher = self._watch.publisher(Point, "setpoint", qos.SETPOINT, sole=True)
        self.create_service(Trigger, "~/start", self._on_start)
        self.create_service(Trigger, "~/stop", self._on_stop)
        self.loop = DeadlineLoop(self.values.rate, self._tick)
        self.health = HealthReporter(
            self, self.values, self.loop, {"path": self._path_health, "topics": self._watch.health}
        )

    def _configure(self, values: ParameterSet) -> None:
        # A file is read when it is chosen, not at every change: it may be gone by then.
        chosen = any(values[name] != self.values[name] for name in ("path", "file"))
        points = points_of(values) if chosen else self._points
        trajectory = trajectory_of(values, points)
        with self._lock:
            self._points = points
            self._progress.change(trajectory)

    def _tick(self, dt: float) -> None:
        with self._lock:
            if not self._running:
                return
            position = self._progress.step(dt, self.values.loop)
            self._running = not self._progress.done
        self._publisher.publish(array_to_point(position))
        self._sent += 1
        if not self._running:
            self.get_logger().info(f"the path is done, {self._sent} setpoints sent")

    def _on_start(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        with self._lock:
            self._progress.restart()
            self._running = True
        response.success, response.message = True, f"{self.values.path} from its beginning"
        return response

    def _on_stop(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        with self._lock:
            was_running, self._running = self._running, False
        response.success, response.message = True, "stopped" if was_running else "it was not running"
        return response

    def _path_health(self) -> Health:
        message = f"{self.values.path}: {'running' if self._running else 'stopped'}"
        return Health(OK, message, {"sent": self._sent, "time_s": self._progress.time})


def main(args: Sequence[str] | None = None) -> int:
    """Entry point of the executable."""
    return run(TrajectoryPublisher, args, TABLE)
