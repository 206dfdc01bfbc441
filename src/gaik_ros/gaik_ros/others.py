"""Whether somebody else is at work in a node's namespace: two suites would drive one device."""

from __future__ import annotations

import time
from collections.abc import Callable

from rclpy.node import Node

DISCOVERY = 4.0  # s in which others are seen: most at once, but where a first greeting is lost, with the next
LISTENING = 1.0  # s for setpoints
LOOK = 0.05  # s between looks
DRIVING = ("joint_states", "joint_command")
"""What a device and what drives it publish: one of each is enough."""


def refuse_company(node: Node) -> None:
    """Raise ValueError where another suite than that of `node`, which does not run yet, is at work. Takes DISCOVERY."""
    end = time.monotonic() + DISCOVERY
    while time.monotonic() < end:
        if reason := other_suite(node):
            raise ValueError(reason)
        time.sleep(LOOK)


def other_suite(node: Node) -> str:
    """Which of DRIVING another suite than that of `node` publishes, as a line for the user; empty for none."""
    for topic in DRIVING:
        if node.count_publishers(topic) > 1:
            where = node.get_namespace()
            return f"another node publishes {topic} in the namespace {where}: end it, or give another --namespace"
    return ""


def other_setpoints(node: Node, heard: Callable[[], int]) -> str:
    """Who sends setpoints while `node` sends none, as a line for the user; empty where nobody does for a while.

    `heard` tells how many have come in all.
    """
    before = heard()
    time.sleep(LISTENING)
    if heard() == before:
        return ""
    infos = node.get_publishers_info_by_topic("setpoint")
    others = sorted({info.node_name for info in infos} - {node.get_name()})
    return (
        f"setpoints come from {', '.join(others) or 'somewhere else'}: stop them first "
        "(trajectory_publisher has the service ~/stop)"
    )
