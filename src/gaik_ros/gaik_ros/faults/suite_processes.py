"""The nodes as processes of one's own: started, stalled, killed and restarted one by one."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from importlib.metadata import entry_points
from types import TracebackType
from typing import IO

from gaik_ros.faults.fault import StageError

PACKAGES: Mapping[str, str] = {
    "touch_sim": "touch_sim",
    "pid_controller": "gaik_ros",
    "ik_node": "gaik_ros",
    "trajectory_publisher": "gaik_ros",
}
"""The executables and the packages that have them; found at run time, since gaik_ros imports no device."""

SUITE = ("touch_sim", "pid_controller", "ik_node")
PATIENCE = 30.0  # s for a process to end


def command_of(executable: str) -> list[str]:
    """How to start an executable, found as its package declares it. StageError: the package is not installed."""
    package = PACKAGES[executable]
    for entry in entry_points(group="console_scripts", name=executable):
        if entry.module.split(".")[0] == package:
            start = f"import sys; from {entry.module} import {entry.attr} as main; sys.exit(main())"
            return [sys.executable, "-c", start]
    raise StageError(f"there is no executable {executable}: install the package {package}")


class SuiteProcesses:
    """A suite in a namespace, one process a node. A with-block ends them all."""

    def __init__(self, namespace: str, arguments: Mapping[str, Sequence[str]] | None = None) -> None:
        """`arguments` by node follow --ros-args."""
        self._namespace = "/" + namespace.strip("/")
        self._arguments = {name: list(given) for name, given in (arguments or {}).items()}
        self._running: dict[str, subprocess.Popen[bytes]] = {}
        self._errors: dict[str, IO[bytes]] = {}

    def __enter__(self) -> SuiteProcesses:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for process in self._running.values():
            if process.poll() is None:
                process.send_signal(signal.SIGCONT)
                process.terminate()
        for name in list(self._running):
            self._gather(name)

    def start(self, name: str, *arguments: str) -> None:
        """Start a node; `arguments` follow --ros-args after those of the suite."""
        errors = tempfile.TemporaryFile()  # noqa: SIM115, closed when the process has been gathered
        given = ["--ros-args", "-r", f"__ns:={self._namespace}", *self._arguments.get(name, ()), *arguments]
        self._errors[name] = errors
        self._running[name] = subprocess.Popen(
            [*command_of(name), *given],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=errors,
            start_new_session=True,  # a Ctrl-C at the injector is the injector's alone
        )

    def start_suite(self) -> None:
        """Start device, controller and IK."""
        for name in SUITE:
            self.start(name)

    @property
    def started(self) -> list[str]:
        """The nodes that were started and not ended."""
        return list(self._running)

    @property
    def identities(self) -> dict[str, int]:
        """The process id of each node that runs."""
        return {name: process.pid for name, process in self._running.items() if process.poll() is None}

    def signal(self, name: str, number: int) -> None:
        """Send a signal."""
        self._running[name].send_signal(number)

    def stall(self, name: str, seconds: float) -> None:
        """Let a node stand still, as an overloaded machine does."""
        os.kill(self._running[name].pid, signal.SIGSTOP)
        try:
            time.sleep(seconds)
        finally:
            os.kill(self._running[name].pid, signal.SIGCONT)

    def end(self, name: str, number: int) -> tuple[int, str]:
        """End a node by a signal; its exit code and what it wrote to stderr."""
        self.signal(name, number)
        return self._gather(name)

    def _gather(self, name: str) -> tuple[int, str]:
        process = self._running.pop(name)
        try:
            code = process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            process.kill()
            code = process.wait()
        with self._errors.pop(name) as errors:
            errors.seek(0)
            return code, errors.read().decode(errors="replace")
