"""A running suite as a fault sees it: what it can send, look at, wait for and take hold of."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np
from geometry_msgs.msg import Point
from numpy.typing import ArrayLike, NDArray

from gaik_ros import qos
from gaik_ros.conversions import JointMessageError, array_to_point, joint_values
from gaik_ros.faults.cable import Cable
from gaik_ros.faults.facts import Facts
from gaik_ros.faults.fault import StageError
from gaik_ros.faults.probe import LEAD_RATE, QUIET_PUBLISHER, Probe, Recording
from gaik_ros.faults.remote import PATIENCE, Remote, wait_until
from gaik_ros.faults.suite_processes import SuiteProcesses

Array = NDArray[np.float64]

SWAY_PERIOD = 4.0  # s of one way to and fro: slow, so that the arm is never far behind
ARRIVED = 1e-3  # m
CLOSE = 1e-3  # rad, between reference and device at rest
RESTS = 0.1  # s
RESEND = 1.0  # s: a node that was restarted may not have heard the first


class NotSeenError(Exception):
    """Something that was promised did not come about; the message says what."""


class Stage:
    """One suite. Positions are m, angles rad, times s of the monotonic clock."""

    def __init__(self, probe: Probe, remote: Remote, facts: Facts) -> None:
        self.probe, self.remote, self.facts = probe, remote, facts
        self.chain = facts.chain
        self.names = list(facts.chain.joint_names)
        self.cable: Cable | None = None
        self.processes: SuiteProcesses | None = None
        self._setpoints = probe.create_publisher(
            Point, "setpoint", qos.SETPOINT, event_callbacks=QUIET_PUBLISHER
        )
        self._time = 0.0

    # What it can take hold of

    @property
    def own_cable(self) -> Cable:
        """The cable of a fault that needs it."""
        if self.cable is None:
            raise StageError("joint_states do not come through the injector")
        return self.cable

    @property
    def own_processes(self) -> SuiteProcesses:
        """The processes of a fault that needs them."""
        if self.processes is None:
            raise StageError("the nodes are not the injector's own processes")
        return self.processes

    # What it can send

    def send(self, position: ArrayLike) -> None:
        """Send one setpoint (3,) m, finite or not."""
        self._setpoints.publish(array_to_point(position))

    def point(self, angles: Array) -> Array:
        """Where the tip is at `angles` (dof,) rad."""
        return np.asarray(self.chain.forward(angles))

    def between(self, share: float) -> Array:
        """The tip at a posture between home (0) and away (1)."""
        return self.point(self.facts.home + share * (self.facts.away - self.facts.home))

    @contextmanager
    def moving(self) -> Iterator[None]:
        """Lead the arm to and fro with setpoints at 100 Hz for the length of the block."""
        self.probe.led_by = self._sway
        try:
            time.sleep(0.3)
            yield
        finally:
            self.probe.led_by = None
            time.sleep(2.0 / LEAD_RATE)  # a tick that had begun may still send: not after what follows

    def _sway(self, dt: float) -> None:
        self._time += dt
        self.send(self.between(0.5 - 0.5 * math.cos(2.0 * math.pi * self._time / SWAY_PERIOD)))

    # What it can look at and wait for

    def angles(self) -> Array | None:
        """The joints as the device says, (dof,); None before the first, and where the newest does not hold them."""
        message = self.probe.newest("joint_states")
        try:
            return None if message is None else joint_values(message, self.names)
        except JointMessageError:
            return None

    def distance(self, position: Array) -> float:
        """How far the tip is from `position` (3,) m; infinite while that is not known."""
        angles = self.angles()
        return math.inf if angles is None else float(np.linalg.norm(self.point(angles) - position))

    def mark(self) -> dict[str, int]:
        """Where a recording begins: now."""
        return self.probe.mark()

    def since(self, mark: Mapping[str, int]) -> Recording:
        """What was heard since `mark`."""
        return self.probe.since(mark)

    def wait(self, condition: Any, what: str, patience: float = PATIENCE) -> float:
        """Wait for `condition` and return the seconds it took. NotSeenError: it did not come about."""
        began = time.monotonic()
        if not wait_until(condition, patience):
            raise NotSeenError(what)
        return time.monotonic() - began

    def wait_lasting(self, condition: Callable[[], bool], seconds: float, what: str) -> float:
        """Wait until `condition` has held for `seconds` on end; the time in s until it began to, 0 if at once."""
        began = failed = time.monotonic()

        def lasting() -> bool:
            nonlocal failed
            if not condition():
                failed = time.monotonic()
            return time.monotonic() - failed > seconds

        self.wait(lasting, what)
        return failed - began

    def sleep(self, seconds: float) -> None:
        """Let time pass."""
        time.sleep(seconds)

    def go(self, angles: Array, what: str = "the arm goes where it is sent") -> float:
        """Send the tip to where it is at `angles` and wait until it is there; how long that took."""
        target = self.point(angles)
        sent = -math.inf

        def arrived() -> bool:
            nonlocal sent
            if time.monotonic() - sent > RESEND:
                self.send(target)
                sent = time.monotonic()
            return self.probe.age("joint_states") < 0.5 and self.distance(target) < ARRIVED

        return self.wait(arrived, what)

    def settle(self) -> None:
        """Bring the arm to rest at home, where every fault begins."""
        self.go(self.facts.home)
        self.rest()

    def rest(self) -> None:
        """Wait until the arm is at rest, and not only for the moment in which it turns round."""
        self.wait_lasting(self._at_rest, RESTS, "the arm comes to rest")

    def _at_rest(self) -> bool:
        """Whether the reference stands still and the device is there."""
        reference, angles = self.probe.newest("joint_reference"), self.angles()
        if reference is None or angles is None:
            return False
        still = not np.any(reference.velocity)
        return still and bool(np.abs(joint_values(reference, self.names) - angles).max() < CLOSE)

    def present(self) -> set[str]:
        """The names of the nodes that are to be seen in the suite's namespace."""
        namespace = self.probe.get_namespace()
        return {name for name, where in self.probe.get_node_names_and_namespaces() if where == namespace}

    def command_timeout(self) -> float:
        """When the device brakes without a command, s, where it is the twin; else a guess."""
        if "touch_sim" not in self.present():
            return 0.1
        return float(self.remote.parameters("touch_sim", ["command_timeout"])["command_timeout"])

    def absent(self) -> list[str]:
        """The nodes of the suite that are not to be seen, or whose process has ended."""
        seen = self.present()
        wanted = {"ik_node", "pid_controller"}
        if self.processes is not None:
            wanted |= set(self.processes.started)
            seen &= set(self.processes.identities)
        return sorted(wanted - seen)
