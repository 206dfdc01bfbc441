"""The executables. What a node imports takes up to a second, and a signal in that time ends it as quietly as later.

It imports nothing of ROS itself, so that this time is covered from its start.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from importlib import import_module

from gaik_ros.signals import INTERRUPTED, stopped_by_signals


def executable(module: str, interrupted: int = 0) -> Callable[[], int]:
    """What starts the `main` of a module, and returns its exit code; that of an early signal is `interrupted`."""

    def start() -> int:
        with stopped_by_signals(
            lambda: os._exit(interrupted)
        ):  # nothing is at work yet that would have to end
            main: Callable[[], int] = import_module(module).main
        return main()

    return start


ik_node = executable("gaik_ros.ik_node")
pid_controller = executable("gaik_ros.pid_controller")
trajectory_publisher = executable("gaik_ros.trajectory_publisher")
viewer = executable("gaik_ros.viewer.node")
record = executable("gaik_ros.record")
path_markers = executable("gaik_ros.path_markers")
touch_adapter = executable("gaik_ros.touch_adapter")
inject = executable("gaik_ros.faults.inject", INTERRUPTED)
