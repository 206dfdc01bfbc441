"""The whole chain from setpoints to joints without ROS: tracking with the paper's gains, with and without jitter."""

import numpy as np
import pytest

from gaik_core import KinematicChain, LevenbergMarquardt
from gaik_core.paths import Circle, Lemniscate
from gaik_ros.continuous_ik import ContinuousIk
from gaik_ros.joint_control import ControlSettings, JointControl
from gaik_ros.pid import Gains
from gaik_ros.setpoint_follower import FollowerSettings, SetpointFollower

CHAIN = KinematicChain.load("touch_device")
DT, PERIOD, LAP, TAU, LAPS = 1e-3, 0.01, 6.3, 0.05, 1.5


def tracking_error(path, feed_forward, extrapolation, jitter):
    """RMS distance (m) from the tip to the path's point at the same time, over the second half of the run.

    Every setpoint reaches the IK late by up to `jitter` s; its reference reaches the controller at once.
    """
    ik = ContinuousIk(CHAIN, "quaternion", LevenbergMarquardt(), 1e-6, 1000)
    follower = SetpointFollower(ik, FollowerSettings(1.5), PERIOD)
    angles = ik.solve(path.position(0.0), CHAIN.home).angles
    follower.start(angles, 0.0)
    control = JointControl(3, Gains(feed_forward=feed_forward), ControlSettings(extrapolation=extrapolation))
    steps = round(LAPS * LAP / DT)
    late = np.random.default_rng(0).uniform(0.0, jitter, steps) if jitter else np.zeros(steps)
    arrivals = np.maximum.accumulate(PERIOD * np.arange(steps) + late)
    number, reference, velocity, changed, errors = 0, None, 0.0, 0.0, []
    for k in range(steps):
        now = k * DT
        while arrivals[number] <= now:
            setpoint = path.position(2.0 * np.pi * PERIOD * number / LAP)
            follower.accept(setpoint, arrivals[number], number, follower.solve(setpoint))
            reference, velocity = follower.advance(arrivals[number])
            changed, number = arrivals[number], number + 1
        if k % 10 == 0 and follower.due(now):
            held, (reference, velocity) = reference, follower.advance(now)
            changed = changed if (held == reference).all() else now
        effort = control.step(DT, angles, 0.0, reference, velocity, 0.0, now - changed)
        if k > steps // 2:
            exact = path.position(2.0 * np.pi * now / LAP)
            errors.append(np.linalg.norm(CHAIN.forward(angles) - exact))
        angles = angles + DT / TAU * effort
    return np.sqrt(np.mean(np.square(errors)))


@pytest.mark.parametrize("jitter", [0.0, 0.006])
@pytest.mark.parametrize(("path", "bare"), [(Circle(), 0.98e-3), (Lemniscate(), 1.28e-3)])
def test_it_tracks_as_a_plain_simulation_says(path, bare, jitter):
    """`bare` is what a plain simulation, independent of this project, gives for a staircase of references."""
    speed = 0.08  # m/s, about the greatest on both paths
    delay = speed * jitter / 2.0
    assert tracking_error(path, 0.0, 0.0, jitter) == pytest.approx(bare, abs=speed * DT + delay)
    assert tracking_error(path, 0.0, 0.015, jitter) < 0.85 * bare + delay
    assert tracking_error(path, TAU, 0.0, jitter) < 0.35e-3 + delay
    assert tracking_error(path, TAU, 0.015, jitter) < 0.1e-3 + delay
