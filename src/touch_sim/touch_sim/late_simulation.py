"""The closed loop without ROS on a machine that is late: two loops that stall, and messages that take their time.

Device and controller keep their own deadlines, as their nodes do, and hear each other's newest message that has
arrived. It shows what lateness does to the loop, with nothing left to chance but the seed.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gaik_ros.deadline_loop import BREATH, DeadlineSchedule
from gaik_ros.joint_control import JointControl
from touch_sim.command_hold import CommandHold
from touch_sim.dynamics import JointDynamics

Array = NDArray[np.float64]

RESOLUTION = 1e-4  # s of the simulated clock


@dataclass(frozen=True)
class Stalls:
    """Spans of time in which a process stands still, as times (n, 2) s in order."""

    spans: Array

    @classmethod
    def random(cls, seed: int, between: float, shortest: float, longest: float, until: float) -> Stalls:
        """Stalls `between` s apart in the mean, each from `shortest` to `longest` s."""
        rng = np.random.default_rng(seed)
        spans, now = [], rng.exponential(between)
        while now < until:
            end = now + rng.uniform(shortest, longest)
            spans.append((now, end))
            now = end + rng.exponential(between)
        return cls(np.array(spans).reshape(-1, 2))

    def at(self, now: float) -> bool:
        """Whether the process stands still at `now` s."""
        number = int(np.searchsorted(self.spans[:, 0], now, side="right")) - 1
        return number >= 0 and now < float(self.spans[number, 1])


NEVER = Stalls(np.empty((0, 2)))


class _Loop:
    """One process: its schedule, its stalls, and when it ticked last."""

    def __init__(self, rate: float, stalls: Stalls) -> None:
        self.schedule, self.stalls = DeadlineSchedule(rate), stalls
        self.schedule.start(0.0)
        self.ticked = 0.0

    def due(self, now: float) -> float | None:
        """The dt of the tick to be made now; after one that was caught up there is a breath."""
        return self.schedule.due(now) if now - self.ticked >= BREATH else None


class _Wire:
    """Messages on their way, of which only the newest that has arrived is kept."""

    def __init__(self, transit: float) -> None:
        self._transit = transit
        self._under_way: deque[tuple[float, Array]] = deque()

    def send(self, now: float, values: Array) -> None:
        self._under_way.append((now + self._transit, values))

    def newest(self, now: float) -> Array | None:
        """What has arrived since the last call, None if nothing has."""
        values = None
        while self._under_way and self._under_way[0][0] <= now:
            values = self._under_way.popleft()[1]
        return values


@dataclass(frozen=True)
class LateRun:
    """What happened: the time (n,) s, the joints (n, dof) rad, the references, and the efforts (n, dof) N·m."""

    time: Array
    angles: Array
    references: Array
    efforts: Array


def simulate_late(
    control: JointControl,
    dynamics: JointDynamics,
    reference: Callable[[float], Array],
    seconds: float,
    rate: float = 1000.0,
    device_stalls: Stalls = NEVER,
    controller_stalls: Stalls = NEVER,
    transit: float = 5e-4,
) -> LateRun:
    """Run for `seconds`; `reference` gives angles (dof,) rad by the time in s, `transit` s is what a message takes."""
    device, controller = _Loop(rate, device_stalls), _Loop(rate, controller_stalls)
    states, commands = _Wire(transit), _Wire(transit)
    hold = CommandHold(dynamics.angles.size, timeout=0.1)
    state, state_time, effort = dynamics.angles, 0.0, np.zeros_like(dynamics.angles)
    time = np.arange(0.0, seconds, RESOLUTION)
    rows: list[tuple[Array, Array, Array]] = []
    for now in time.tolist():
        goal = reference(now)
        if not device_stalls.at(now):
            if (command := commands.newest(now)) is not None:
                hold.receive(command)
            if (dt := device.due(now)) is not None:
                device.ticked = now
                dynamics.step(hold.effort(dt), dt)
                states.send(now, dynamics.angles)
        if not controller_stalls.at(now):
            if (heard := states.newest(now)) is not None:
                state, state_time = heard, now
            if (dt := controller.due(now)) is not None:
                late = max(now - controller.ticked, now - state_time) - controller.schedule.period
                controller.ticked = now
                effort = control.step(dt, state, now - state_time, goal, 0.0, 0.0, late=late)
                commands.send(now, effort)
        rows.append((dynamics.angles, goal, effort))
    angles, references, efforts = (np.array(column) for column in zip(*rows, strict=True))
    return LateRun(time, angles, references, efforts)
