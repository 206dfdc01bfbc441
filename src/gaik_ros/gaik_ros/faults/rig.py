"""Plays faults one after the other against one suite, and has the arm recover in between."""

from __future__ import annotations

import signal
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager

import rclpy
from rclpy.context import Context
from rclpy.signals import SignalHandlerOptions

from gaik_ros.faults.cable import DEVICE_TOPIC, Cable
from gaik_ros.faults.facts import read_facts
from gaik_ros.faults.fault import Check, Fault, Need, Outcome, StageError
from gaik_ros.faults.invariants import efforts_bounded, nodes_alive, recovers, reference_bounded
from gaik_ros.faults.probe import Probe
from gaik_ros.faults.remote import Remote, wait_until
from gaik_ros.faults.stage import NotSeenError, Stage
from gaik_ros.faults.suite_processes import SUITE, SuiteProcesses
from gaik_ros.others import other_setpoints
from gaik_ros.run import running

DEVICE = "touch_sim"
DISCOVERY = 10.0  # s for nodes that are there to be seen
STARTING = 60.0  # s for nodes to come up


class Rig:
    """One suite and what the injector has to do with it."""

    def __init__(self, stage: Stage, lasting_cable: bool) -> None:
        """`lasting_cable`: the user has put the cable in, so it stays."""
        self.stage = stage
        self._lasting_cable = lasting_cable

    def lacks(self, fault: Fault) -> str:
        """Why a fault cannot be played against this suite; empty if it can."""
        own = self.stage.processes is not None
        if Need.PROCESSES in fault.needs and not own:
            return "it needs nodes that it can stop and restart: give --start-suite"
        if Need.CABLE in fault.needs and not own and self.stage.cable is None:
            return (
                f"it needs joint_states to come through it: start the device with -r joint_states:={DEVICE_TOPIC} "
                f"and give --cable {DEVICE_TOPIC}, or give --start-suite"
            )
        if Need.TWIN in fault.needs and not own and not wait_until(self._sees_twin, DISCOVERY):
            return "it needs the twin touch_sim as the device"
        return ""

    def _sees_twin(self) -> bool:
        return DEVICE in self.stage.present()

    def require(self, fault: Fault) -> None:
        """Raise StageError where a fault cannot be played against this suite."""
        lack = self.lacks(fault)
        if lack:
            raise StageError(f"{fault.name} cannot be played: {lack}")

    def play(self, fault: Fault) -> Outcome:
        """Play one fault. StageError: it cannot be played here."""
        self.require(fault)
        stage = self.stage
        self._revive()
        self._connect(Need.CABLE in fault.needs)
        stage.probe.forget()
        began, mark = time.monotonic(), stage.mark()
        checks: list[Check] = []
        try:
            stage.settle()
            began, mark = time.monotonic(), stage.mark()
            checks.extend(fault.play(stage))
        except (NotSeenError, StageError) as missing:
            checks.append(Check(str(missing), "not seen", False))
        alive, recovery = nodes_alive(stage), recovers(stage)
        recording = stage.since(mark)
        checks += [efforts_bounded(recording, stage), reference_bounded(recording, stage), alive, recovery]
        return Outcome(fault, tuple(checks), time.monotonic() - began)

    def _revive(self) -> None:
        """Start the nodes again that a fault before this one has left dead."""
        processes = self.stage.processes
        if processes is not None:
            for name in set(SUITE) - set(processes.identities):
                processes.start(name, *self._remaps(name))

    def _remaps(self, name: str) -> list[str]:
        through_cable = name == DEVICE and self.stage.cable is not None
        return ["-r", f"joint_states:={DEVICE_TOPIC}"] if through_cable else []

    def _connect(self, through_cable: bool) -> None:
        """Put the cable in or take it out, where the device is a process of ours."""
        stage = self.stage
        if stage.processes is None or self._lasting_cable or through_cable == (stage.cable is not None):
            return
        stage.processes.end(DEVICE, signal.SIGTERM)
        if stage.cable is not None:
            stage.cable.remove()
        stage.cable = Cable(stage.probe) if through_cable else None
        stage.processes.start(DEVICE, *self._remaps(DEVICE))


@contextmanager
def rig(
    namespace: str = "",
    start_suite: bool = False,
    cable: str = "",
    arguments: Mapping[str, Sequence[str]] | None = None,
) -> Iterator[Rig]:
    """Join a running suite, or start one; StageError: there is none, or it does not come up.

    `cable` is the topic of the device's joint_states where they shall come through the injector; `arguments` by node
    are for a suite that is started.
    """
    with ExitStack() as stack:
        context = stack.enter_context(_context())
        processes = stack.enter_context(SuiteProcesses(namespace, arguments)) if start_suite else None
        if processes is not None:
            processes.start_suite()
        probe = Probe(namespace, context)
        stack.enter_context(running([probe], context))
        remote = Remote(probe)
        stage = Stage(probe, remote, read_facts(remote, STARTING if start_suite else DISCOVERY))
        stage.processes = processes
        if not start_suite:
            _refuse_other_setpoints(probe)
        if cable:
            stage.cable = _connected(Cable(probe, cable), cable)
        yield Rig(stage, bool(cable))


def _refuse_other_setpoints(probe: Probe) -> None:
    """StageError: somebody else sends setpoints, so that the arm would not go where a fault has it go."""
    mark = probe.mark()
    reason = other_setpoints(probe, lambda: probe.since(mark).count("setpoint"))
    if reason:
        raise StageError(f"{reason}, so that the arm goes where a fault sends it")


def _connected(cable: Cable, topic: str) -> Cable:
    """The cable, once something comes through it. StageError: nothing does."""
    if not wait_until(lambda: cable.newest is not None, DISCOVERY):
        raise StageError(f"nothing comes on {topic}: start the device with -r joint_states:={topic}")
    return cable


@contextmanager
def _context() -> Iterator[Context]:
    context = Context()
    rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
    try:
        yield context
    finally:
        rclpy.try_shutdown(context=context)
