"""The node `viewer`: a live page of a suite that runs anywhere; it looks, and acts only as a user's hand."""

from __future__ import annotations

import sys
import threading
import time
import webbrowser
from collections import deque
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Point
from numpy.typing import NDArray
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState

from gaik_core import KinematicChain
from gaik_ros.conversions import JointMessageError, joint_values, point_to_array, raw_joint_values
from gaik_ros.deadline_loop import DeadlineLoop, LoopThread
from gaik_ros.health import LOOP_PARAMETERS, OK, Health, HealthReporter
from gaik_ros.parameters import Parameter, ParameterTable
from gaik_ros.run import run
from gaik_ros.viewer.board import Board
from gaik_ros.viewer.outbox import Outbox
from gaik_ros.viewer.picture import Picture
from gaik_ros.viewer.suite_client import NodeNames, SuiteClient, SuiteError
from gaik_ros.viewer.urdf_shapes import UrdfShapes
from gaik_ros.watch import Watch

Array = NDArray[np.float64]

UPWARD = {
    "+x": (1, 0, 0),
    "+y": (0, 1, 0),
    "+z": (0, 0, 1),
    "-x": (-1, 0, 0),
    "-y": (0, -1, 0),
    "-z": (0, 0, -1),
}
PERIOD_WINDOW = 60.0  # s
UNREAD = 10_000  # messages kept for the page's thread at most

TABLE = ParameterTable(
    "viewer",
    (
        Parameter(
            "robot", "touch_device", "", "a robot of gaik_core, or the path of a robot file", read_only=True
        ),
        Parameter(
            "urdf",
            "",
            "",
            "path or text of a URDF to draw; empty: the chain is drawn as rods",
            read_only=True,
        ),
        Parameter(
            "origin_frame",
            "",
            "",
            "link of the URDF in whose frame setpoints are given; empty: its root",
            read_only=True,
        ),
        Parameter(
            "up",
            "+y",
            "",
            "the setpoints' axis that points up, without a URDF",
            choices=tuple(UPWARD),
            read_only=True,
        ),
        Parameter(
            "host",
            "127.0.0.1",
            "",
            "where the page is served; another than this opens it to others",
            read_only=True,
        ),
        Parameter(
            "port",
            8080,
            "",
            "of the page, or the next that is free; 0: any free one",
            0,
            65_535,
            read_only=True,
        ),
        Parameter("open_browser", False, "", "open the page in a browser at the start", read_only=True),
        Parameter("rate", 25.0, "Hz", "how often the page is drawn", 1.0, 60.0, read_only=True),
        Parameter(
            "nodes.trajectory",
            "trajectory_publisher",
            "",
            "name of the node that follows paths",
            read_only=True,
        ),
        Parameter("nodes.ik", "ik_node", "", "name of the node that solves setpoints", read_only=True),
        Parameter("nodes.controller", "pid_controller", "", "name of the joint controller", read_only=True),
        Parameter(
            "nodes.device", "touch_sim", "", "name of the device's node, twin or driver", read_only=True
        ),
        *LOOP_PARAMETERS,
    ),
)


def _unhurried(depth: int) -> QoSProfile:
    """For all that is only looked at: a viewer that asks for best effort can hold nobody up."""
    return QoSProfile(depth=depth, reliability=ReliabilityPolicy.BEST_EFFORT)


class ViserMissingError(ValueError):
    """The page cannot be served."""

    def __init__(self) -> None:
        super().__init__(
            f"the page needs viser; install it with: {sys.executable} -m pip install 'viser>=1.1,<2'"
        )


class Viewer(Node):
    """Hears a suite, draws it, and publishes the setpoints that are dragged."""

    def __init__(self, **node_kwargs: Any) -> None:
        super().__init__(TABLE.node, **node_kwargs)
        values = self.values = TABLE.declare(self)
        try:
            from gaik_ros.viewer.page import Page
        except ModuleNotFoundError as missing:
            if (missing.name or "").split(".")[0] == "viser":
                raise ViserMissingError from missing
            raise
        self.chain = KinematicChain.load(values.robot)
        if values.origin_frame and not values.urdf:
            raise ValueError(
                f"parameter 'origin_frame' is {values.origin_frame!r}: it names a link of a URDF, and 'urdf' is empty"
            )
        shapes = UrdfShapes(values.urdf) if values.urdf else None
        self._names = list(self.chain.joint_names)
        self._nodes = NodeNames(
            *(values[f"nodes.{role}"] for role in ("trajectory", "ik", "controller", "device"))
        )
        self._picture = Picture(self.chain)
        self._board = Board([self._full(name) for name in vars(self._nodes).values()], PERIOD_WINDOW)
        self._unread: deque[Callable[[], None]] = deque(maxlen=UNREAD)
        self._raw_state: tuple[bytes, float] | None = None
        self._drawn_state: tuple[bytes, float] | None = None
        self.page = Page(
            values.host,
            values.port,
            self.chain,
            shapes,
            values.origin_frame,
            np.array(UPWARD[values.up], float),
        )
        self._connect()
        loop = DeadlineLoop(values.rate, self._step)
        self.health = HealthReporter(
            self, values, loop, {"page": self._page_health, "topics": self._watch.health}
        )
        # A thread of its own: drawing takes milliseconds, which a controller in the same process must not wait for.
        self._thread = LoopThread([loop], self._failed)
        self._thread.start()
        if values.open_browser:
            threading.Thread(target=webbrowser.open, args=(self.page.address,), daemon=True).start()

    def _connect(self) -> None:
        self._watch = Watch(self)
        self._outbox = Outbox(self, self._watch, own_subscriptions=1)
        for message, topic, callback, depth, raw in (
            (Point, "setpoint", self._on_setpoint, 100, False),
            (JointState, "joint_reference", self._on_reference, 1, False),
            (JointState, "joint_states", self._on_state, 1, True),
            (DiagnosticStatus, f"{self._nodes.ik}/status", self._on_verdict, 100, False),
            (DiagnosticArray, "/diagnostics", self._on_diagnostics, 100, False),
        ):
            self._watch.subscription(message, topic, callback, _unhurried(depth), raw=raw)
        self._suite = SuiteClient(self, self._nodes)
        self._connect_page()

    def _connect_page(self) -> None:
        from gaik_ros.viewer.controls import SuiteParameters
        from gaik_ros.viewer.panel import Actions

        self._steered = SuiteParameters(self._suite, self._nodes)
        actions = Actions(
            self._start_path, self._stop_path, self._reset, self._send_by_hand, self.page.scene.show_workspace
        )
        where = self.get_namespace().strip("/")
        self.page.connect(
            f"gaik · {self.chain.name}" + (f" · {where}" if where else ""),
            actions,
            self._steered,
            self._full(self._nodes.controller),
            self._take_over,
            self._outbox.send,
        )

    def _full(self, name: str) -> str:
        return self.resolve_topic_name(name).lstrip("/")

    # what is heard: kept for the page's thread, so that the executor's has nothing to wait for

    def _on_setpoint(self, message: Point) -> None:
        state = self._raw_state
        position = point_to_array(message)
        self._unread.append(lambda: self._picture.hear_setpoint(position, self._angles(state)))

    def _on_reference(self, message: JointState) -> None:
        self._unread.append(lambda: self._hear_reference(message))

    def _on_state(self, raw: bytes) -> None:
        self._raw_state = (raw, time.monotonic())

    def _on_verdict(self, message: DiagnosticStatus) -> None:
        values = {pair.key: pair.value for pair in message.values}
        self._unread.append(partial(self._picture.hear_verdict, values, message.message))

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        now = time.monotonic()
        for status in message.status:
            values = {pair.key: pair.value for pair in status.values}
            self._unread.append(
                partial(self._board.hear, status.name, status.level, status.message, values, now)
            )

    # what the page's thread makes of it

    def _step(self, dt: float) -> None:
        now = time.monotonic()
        while self._unread:
            self._unread.popleft()()
        state = self._raw_state
        if state is not None and state is not self._drawn_state:
            self._drawn_state = state
            angles = self._angles(state)
            if angles is not None:
                self._picture.hear_state(angles, state[1])
        self._picture.sample(now)
        self._outbox.attend()
        self.page.step(self._picture, self._board, now)

    def _hear_reference(self, message: JointState) -> None:
        try:
            self._picture.hear_reference(joint_values(message, self._names))
        except JointMessageError as reason:
            self._watch.refuse("joint_reference", reason)

    def _angles(self, state: tuple[bytes, float] | None) -> Array | None:
        """The joints' positions (dof,) of a state as it was received; None where they cannot be had."""
        if state is None:
            return None
        try:
            return raw_joint_values(state[0], self._names)
        except JointMessageError as reason:
            self._watch.refuse("joint_states", reason)
            return None

    def _failed(self, error: BaseException) -> None:
        self.get_logger().error(f"the page is no longer drawn: {type(error).__name__}: {error}")

    # what users do; on threads of the page, which may wait

    def _start_path(self, path: str) -> str:
        self._unread.append(self._picture.clear)
        return self._suite.start_path(self._steered.trajectory, path)

    def _stop_path(self) -> str:
        return self._suite.stop_path()

    def _reset(self) -> str:
        said = self._suite.reset(self._hold)
        self._unread.append(self._picture.clear)
        return said

    def _hold(self) -> None:
        """Make the place where the device is now the setpoint."""
        asked = time.monotonic()
        while (state := self._raw_state) is None or state[1] <= asked:
            if time.monotonic() - asked > 1.0:
                raise SuiteError("no joint_states come: the device's place is not known")
            time.sleep(0.005)
        angles = self._angles(state)
        if angles is not None:
            self._outbox.send(self.chain.forward(angles))

    def _take_over(self) -> None:
        """Stop the path; what it still sent until it stopped must not be the last word."""
        self._suite.ask_to_stop(self._outbox.repeat)

    def _send_by_hand(self, position: Array) -> None:
        self._outbox.send(position)
        self._take_over()

    def _page_health(self) -> Health:
        count = self.page.visitors
        return Health(
            OK, f"shown in {count} browser{'' if count == 1 else 's'}", {"address": self.page.address}
        )

    def destroy_node(self) -> None:
        """Stop drawing and serving, then end."""
        self._thread.stop()
        self.page.stop()
        super().destroy_node()


def _announced() -> Viewer:
    viewer = Viewer()
    viewer.get_logger().info(f"the page is at {viewer.page.address}")
    return viewer


def main(args: Sequence[str] | None = None) -> int:
    """Entry point of the executable."""
    return run(_announced, args, TABLE)


if __name__ == "__main__":
    sys.exit(main())
