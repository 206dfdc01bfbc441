"""The executables. What a node imports takes up to a second, and a signal in that time ends it as quietly as later.

It imports nothing of ROS itself, so that this time is covered from its start.
"""

from __future__ import annotations

import contextlib
import os
import signal
from collections.abc import Callable, Iterator
from importlib import import_module
from types import FrameType

INTERRUPTED = 128 + signal.SIGINT


def executable(module: str, interrupted: int = 0) -> Callable[[], int]:
    """What starts the `main` of a module, and returns its exit code; that of an early signal is `interrupted`."""

    def start() -> int:
        with _ended_by_signals(interrupted):
            main: Callable[[], int] = import_module(module).main
        return main()

    return start


@contextlib.contextmanager
def _ended_by_signals(code: int) -> Iterator[None]:
    """End the process at once on SIGINT or SIGTERM: nothing is at work yet that would have to be ended."""

    def leave(number: int, frame: FrameType | None) -> None:
        os._exit(code)

    previous = {number: signal.signal(number, leave) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)


ik_node = executable("gaik_ros.ik_node")
pid_controller = executable("gaik_ros.pid_controller")
trajectory_publisher = executable("gaik_ros.trajectory_publisher")
viewer = executable("gaik_ros.viewer.node")
record = executable("gaik_ros.record")
path_markers = executable("gaik_ros.path_markers")
touch_adapter = executable("gaik_ros.touch_adapter")
inject = executable("gaik_ros.faults.inject", INTERRUPTED)
