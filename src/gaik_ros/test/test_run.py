"""The end of a process, wherever in rclpy the signal finds it."""

import subprocess
import sys

import pytest

PATIENCE = 60.0  # s
SCRIPT = """
import signal, sys
import rclpy
from rclpy.task import Future
from gaik_ros.run import run

caught = []

def watch(frame, event, argument):
    if frame.f_code is not Future.{function}.__code__:
        return None
    return interrupt

def interrupt(frame, event, argument):
    held = frame.f_locals["self"]._lock.locked()
    if event == "line" and held and not caught:
        caught.append(frame.f_lineno)
        signal.raise_signal(signal.{number})
    return interrupt

sys.settrace(watch)
code = run(lambda: rclpy.create_node("watched"), [])
sys.settrace(None)
sys.exit(code if caught else "the signal was never sent")
"""


@pytest.mark.parametrize("number", ["SIGINT", "SIGTERM"])
@pytest.mark.parametrize("function", ["add_done_callback", "remove_done_callback"])
def test_a_signal_while_rclpy_holds_a_lock_ends_the_node_all_the_same(function, number):
    """The handler runs in the thread that it interrupts: to wait there for that thread's lock would be for ever."""
    script = SCRIPT.format(function=function, number=number)
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, timeout=PATIENCE, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
