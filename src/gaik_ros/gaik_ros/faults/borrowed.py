"""Changes to a suite that is the user's: whatever ends a fault, even Ctrl-C, each is taken back."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from std_srvs.srv import SetBool

from gaik_ros.faults.fault import StageError
from gaik_ros.faults.remote import Remote


@contextmanager
def changed(remote: Remote, node: str, values: Mapping[str, Any]) -> Iterator[tuple[bool, str]]:
    """Change parameters of a node for the length of the block; whether it took them, and if not, why."""
    before = remote.parameters(node, values)
    try:
        yield remote.change(node, values)
    finally:
        _restore(remote, node, before)


@contextmanager
def disabled(remote: Remote) -> Iterator[None]:
    """Disable the controller for the length of the block."""
    try:
        remote.call(SetBool, "pid_controller/enable", SetBool.Request(data=False))
        yield
    finally:
        remote.call(SetBool, "pid_controller/enable", SetBool.Request(data=True))


def _restore(remote: Remote, node: str, values: Mapping[str, Any]) -> None:
    """Set what was. A node that does not take it is told of, and hides nothing else that went wrong."""
    try:
        successful, reason = remote.change(node, values)
    except StageError as error:
        successful, reason = False, str(error)
    if not successful:
        was = ", ".join(f"{name}: {value}" for name, value in values.items())
        print(f"inject: {node} does not take back what it had ({was}): {reason}", file=sys.stderr)
