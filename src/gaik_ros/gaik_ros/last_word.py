"""The last message of a node that moves a device: it must arrive, since nobody speaks after it."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable

from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.publisher import Publisher

REPEATS = 5  # a best-effort subscriber may lose one of them
PAUSE = 0.01  # s between two
PATIENCE = Duration(seconds=0.2)  # for the reliable ones to have it: one that hangs must not hold the end up


def say_last(publisher: Publisher, say: Callable[[], None], context: Context) -> None:
    """Have `say` publish the last message on `publisher`, and wait until it has arrived, 0.25 s at most.

    What a publisher has sent may be lost where it is destroyed at once. Says nothing where the context is down.
    """
    with contextlib.suppress(rclpy_implementation.RCLError):  # it may go down meanwhile
        for _ in range(REPEATS):
            if not context.ok():
                return
            say()
            time.sleep(PAUSE)
        publisher.wait_for_all_acked(PATIENCE)
