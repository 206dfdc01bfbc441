"""The demo's loop without ROS: solver, PID controller and twin at one fixed step, with no delay between them.

It says what tracking to expect of the nodes, which add the delays of their messages.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from gaik_core import KinematicChain, solve_path
from gaik_core.paths import Path
from gaik_core.update_rules import LevenbergMarquardt, UpdateRule
from gaik_ros.pid import Gains, Pid
from gaik_ros.tracking import Run, Series
from touch_sim.dynamics import JointDynamics, JointModel
from touch_sim.joint_limits import JointLimits
from touch_sim.tracking import Lap

Array = NDArray[np.float64]

PERIOD = 6.3  # s a lap
FEED_FORWARD = 0.05  # N·m·s/rad: τ/K, the effort that moves the twin's viscous axis at 1 rad/s


@dataclass(frozen=True)
class Settings:
    """What a simulated run is made of; rates in Hz, `period` in s a lap. `rate` is a multiple of `setpoint_rate`."""

    period: float = PERIOD
    laps: int = 1
    rate: int = 1000
    setpoint_rate: int = 100
    gains: Gains = field(default_factory=Gains)
    model: JointModel = field(default_factory=JointModel)
    algebra: str = "quaternion"
    rule: UpdateRule = field(default_factory=LevenbergMarquardt)

    def __post_init__(self) -> None:
        if self.setpoint_rate < 1 or self.rate % self.setpoint_rate:
            raise ValueError(
                f"rate is {self.rate} Hz; expected a multiple of setpoint_rate, {self.setpoint_rate} Hz"
            )


def simulate(chain: KinematicChain, name: str, path: Path, settings: Settings | None = None) -> Run:
    """Follow `path` from its first point at rest. The tip is measured at each step, before its effort acts."""
    settings = settings or Settings()
    steps = round(settings.laps * settings.period * settings.rate)
    time = np.arange(steps) / settings.rate
    reference, velocity, setpoint = _references(chain, path, settings, time)
    angles = _follow(chain, settings, reference, velocity)
    lap = Lap(path, settings.period, 0.0, settings.laps * settings.period)
    return Run(
        name,
        lap,
        tuple(chain.joint_names),
        setpoint=setpoint,
        tip=Series(time, chain.forward(angles, algebra=settings.algebra)),
        joint_reference=Series(time, reference),
        joint_states=Series(time, angles),
    )


def _references(
    chain: KinematicChain, path: Path, settings: Settings, time: Array
) -> tuple[Array, Array, Series]:
    """Return reference angles and velocities (n, dof) held from one setpoint to the next, and the setpoints."""
    every = settings.rate // settings.setpoint_rate
    sent = time[::every]
    turn = 2.0 * math.pi / settings.period
    points = path.position(turn * sent)
    solved = solve_path(chain, points, algebra=settings.algebra, rule=settings.rule, tolerance=1e-9)
    if not solved.converged.all():
        raise ValueError(
            f"the path leaves the reach of {chain.name} at {points[~solved.converged][0].tolist()} m"
        )
    rates = np.array(
        [
            chain.inverse_velocity(angles, speed, algebra=settings.algebra)
            for angles, speed in zip(solved.angles, turn * path.derivative(turn * sent), strict=True)
        ]
    )
    held = np.arange(time.size) // every
    return solved.angles[held], rates[held], Series(sent, points)


def _follow(chain: KinematicChain, settings: Settings, reference: Array, velocity: Array) -> Array:
    """Return the angles (n, dof) of the twin at each step, under the controller."""
    dynamics = JointDynamics(settings.model, JointLimits.of_chain(chain), reference[0])
    # No blending-in: the demo's controller has long been holding the first point when the path begins.
    pid, dt = Pid(chain.dof, settings.gains, blend_time=0.0), 1.0 / settings.rate
    angles = np.empty_like(reference)
    for step, (goal, speed) in enumerate(zip(reference, velocity, strict=True)):
        angles[step] = dynamics.angles
        dynamics.step(pid.step(goal - dynamics.angles, dt, speed), dt)
    return angles
