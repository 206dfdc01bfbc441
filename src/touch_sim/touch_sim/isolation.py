"""The demo's run beside whatever else there is: it reaches no other node, and no other node reaches it."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator, Sequence
from dataclasses import replace

import rclpy
from rclpy.context import Context
from rclpy.signals import SignalHandlerOptions

from touch_sim.demo_progress import Silent
from touch_sim.demo_run import Progress, Results, run_demo
from touch_sim.suite import SuiteOptions


def follow_isolated(
    options: SuiteOptions, paths: Sequence[str], laps: int = 1, progress: Progress | None = None
) -> Results:
    """Run the demo in a ROS domain and a namespace of its own; raises as `run_demo` does."""
    # The namespace keeps the setpoints from a device that is switched on, whatever its domain is.
    own = replace(options, namespace=f"isolated_{os.getpid()}")
    with isolated_context() as context:
        return run_demo(own, paths, laps, progress or Silent(), context)


@contextlib.contextmanager
def isolated_context() -> Iterator[Context]:
    """A context in a domain by the process's number that hears this host only; shut down at the end."""
    context = Context()
    with _environment("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST"):
        rclpy.init(
            args=[],
            context=context,
            domain_id=1 + os.getpid() % 100,
            signal_handler_options=SignalHandlerOptions.NO,
        )
    try:
        yield context
    finally:
        rclpy.try_shutdown(context=context)


@contextlib.contextmanager
def _environment(name: str, value: str) -> Iterator[None]:
    """Set a variable of the environment for the length of a with-block."""
    before = os.environ.get(name)
    os.environ[name] = value
    try:
        yield
    finally:
        if before is None:
            del os.environ[name]
        else:
            os.environ[name] = before
