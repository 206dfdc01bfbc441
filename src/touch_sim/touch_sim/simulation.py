"""The demo's loop without ROS: what the nodes compute, called in turn at one fixed step, with no delay between them.

It says what tracking to expect of the nodes, which add the delays of their messages.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from gaik_core import KinematicChain
from gaik_core.paths import Path
from gaik_core.update_rules import LevenbergMarquardt, UpdateRule
from gaik_ros.continuous_ik import ContinuousIk, Result
from gaik_ros.joint_control import ControlSettings, JointControl
from gaik_ros.pid import Gains
from gaik_ros.setpoint_follower import FollowerSettings, SetpointFollower
from gaik_ros.tracking import Run, Series
from touch_sim.dynamics import JointDynamics, JointModel
from touch_sim.joint_limits import JointLimits
from touch_sim.tracking import Lap

Array = NDArray[np.float64]

PERIOD = 6.3  # s a lap
FEED_FORWARD = 0.05  # N·m·s/rad: τ/K, the effort that moves the twin's viscous axis at 1 rad/s


@dataclass(frozen=True)
class Settings:
    """What a simulated run is made of; each default is that of the node or of the demo.

    Rates are in Hz, times in s, `tolerance` in m, `speed_limit` in rad/s. `rate` is a multiple of `setpoint_rate`.
    With an `extrapolation` of 0 the controller's reference is a staircase.
    """

    period: float = PERIOD
    laps: int = 1
    rate: int = 1000
    setpoint_rate: int = 100
    gains: Gains = field(default_factory=Gains)
    extrapolation: float = 0.015
    model: JointModel = field(default_factory=JointModel)
    algebra: str = "quaternion"
    rule: UpdateRule = field(default_factory=LevenbergMarquardt)
    tolerance: float = 1e-6
    max_iterations: int = 1000
    speed_limit: float = 1.5

    def __post_init__(self) -> None:
        if self.setpoint_rate < 1 or self.rate % self.setpoint_rate:
            raise ValueError(
                f"rate is {self.rate} Hz; expected a multiple of setpoint_rate, {self.setpoint_rate} Hz"
            )


def simulate(chain: KinematicChain, name: str, path: Path, settings: Settings | None = None) -> Run:
    """Follow `path` from its first point at rest.

    The tip is the state at the time it is noted with, as in the nodes, whose twin publishes what its step has led
    to: `n` steps have led to that of time `n / rate`. Raises ValueError where a point of the path is not reached.
    """
    settings = settings or Settings()
    steps = round(settings.laps * settings.period * settings.rate)
    time = np.arange(steps) / settings.rate
    sent = time[:: settings.rate // settings.setpoint_rate]
    points = path.position(2.0 * math.pi * sent / settings.period)
    references, angles = _follow(chain, settings, time, points)
    return Run(
        name,
        Lap(path, settings.period, 0.0, settings.laps * settings.period),
        chain.joint_names,
        setpoint=Series(sent, points),
        tip=Series(time, chain.forward(angles, algebra=settings.algebra)),
        joint_reference=Series(sent, references),
        joint_states=Series(time, angles),
    )


def _follow(chain: KinematicChain, settings: Settings, time: Array, points: Array) -> tuple[Array, Array]:
    """Return the references (setpoints, dof) and the twin's angles (steps, dof), both in rad."""
    dt, every = 1.0 / settings.rate, settings.rate // settings.setpoint_rate
    ik = _Ik(chain, settings, points[0])
    dynamics = JointDynamics(settings.model, JointLimits.of_chain(chain), ik.start)
    control = JointControl(chain.dof, settings.gains, ControlSettings(extrapolation=settings.extrapolation))
    for _ in range(2):  # it takes hold of the arm, and has arrived: the demo rests at the first point too
        control.step(dt, ik.start, 0.0, ik.start, 0.0, 0.0)
    references, angles = np.empty((len(points), chain.dof)), np.empty((len(time), chain.dof))
    for step, now in enumerate(time):
        angles[step] = dynamics.angles
        number, age = divmod(step, every)
        if age == 0:
            references[number], velocity = ik.answer(points[number], number, now)
        effort = control.step(dt, dynamics.angles, 0.0, references[number], velocity, 0.0, age * dt)
        dynamics.step(effort, dt)
    return references, angles


class _Ik:
    """What ik_node makes of setpoints, each at the time it is sent."""

    def __init__(self, chain: KinematicChain, settings: Settings, first: Array) -> None:
        solver = ContinuousIk(
            chain, settings.algebra, settings.rule, settings.tolerance, settings.max_iterations
        )
        self._name = chain.name
        self._follower = SetpointFollower(
            solver, FollowerSettings(settings.speed_limit), 1.0 / settings.setpoint_rate
        )
        self.start = solver.solve(first, chain.home).angles
        self._follower.start(self.start, -1.0 / settings.setpoint_rate)

    def answer(self, setpoint: Array, number: int, now: float) -> tuple[Array, Array]:
        """Return the reference's position (dof,) rad and velocity (dof,) rad/s at once, as the node does."""
        answer = self._follower.solve(setpoint)
        if answer.result is not Result.REACHED:
            raise ValueError(f"the path leaves the reach of {self._name} at {setpoint.tolist()} m")
        self._follower.accept(setpoint, now, number, answer)
        return self._follower.advance(now)
