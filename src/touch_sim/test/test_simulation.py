"""The loop without ROS against figures found independently of this project."""

import numpy as np
import pytest

from gaik_core import KinematicChain
from gaik_core.paths import path_by_name
from gaik_ros.pid import Gains
from gaik_ros.tracking import tracking_error
from touch_sim.simulation import FEED_FORWARD, Settings, simulate

# RMS in mm: (path, setpoint rate in Hz, feed-forward) -> the independent simulation's.
EXPECTED = {
    ("circle", 100, 0.0): 0.98,
    ("lemniscate", 100, 0.0): 1.28,
    ("circle", 1000, 0.0): 0.75,
    ("lemniscate", 1000, 0.0): 0.98,
    ("circle", 100, FEED_FORWARD): 0.19,
    ("lemniscate", 100, FEED_FORWARD): 0.25,
    ("circle", 1000, FEED_FORWARD): 0.04,
    ("lemniscate", 1000, FEED_FORWARD): 0.06,
}
# Which end of a 1 ms step the tip is taken at is not said there: the path's fastest way in one step, in mm,
# is 0.05 on the circle and 0.08 on the lemniscate.
ONE_STEP = {"circle": 0.05, "lemniscate": 0.08}


@pytest.fixture(scope="module")
def touch():
    return KinematicChain.load("touch_device")


@pytest.mark.parametrize(("case", "rms"), EXPECTED.items())
def test_tracking_is_as_an_independent_simulation_has_it(touch, case, rms):
    name, setpoint_rate, feed_forward = case
    settings = Settings(setpoint_rate=setpoint_rate, gains=Gains(feed_forward=feed_forward))
    error = tracking_error(simulate(touch, name, path_by_name(name), settings))
    assert error.rms_m * 1e3 == pytest.approx(rms, abs=ONE_STEP[name])


def test_the_lag_behind_a_slow_circle_is_that_of_a_ramp(touch):
    """A ramp of slope w lags by w τ/(3.1 K), so the tip lags by that time along the path."""
    settings = Settings(period=50.0, laps=1, setpoint_rate=1000, gains=Gains(i=0.0))
    run = simulate(touch, "circle", path_by_name("circle"), settings)
    late = 0.05 / 3.1 + 0.5e-3  # and half a step of hold
    settled = run.tip.time > 5.0
    distance = np.linalg.norm(run.tip.values - run.course.desired(run.tip.time), axis=1)[settled]
    chord = 2.0 * 0.05 * np.sin(np.pi * late / 50.0)
    np.testing.assert_allclose(distance, chord, rtol=0.05)


@pytest.mark.parametrize("algebra", ["quaternion", "conformal"])
def test_either_algebra_follows_alike(touch, algebra):
    run = simulate(touch, "circle", path_by_name("circle"), Settings(algebra=algebra))
    other = simulate(touch, "circle", path_by_name("circle"), Settings())
    np.testing.assert_allclose(run.tip.values, other.tip.values, rtol=0, atol=1e-8)


def test_the_followed_joints_reach_the_followed_tip(touch):
    run = simulate(touch, "lemniscate", path_by_name("lemniscate"), Settings())
    np.testing.assert_allclose(touch.forward(run.joint_states.values), run.tip.values, rtol=0, atol=1e-12)
    assert run.setpoint.time.size == 630
    assert run.tip.time.size == 6300


def test_rates_that_do_not_fit_are_refused():
    with pytest.raises(ValueError, match="multiple of setpoint_rate"):
        Settings(rate=1000, setpoint_rate=300)
