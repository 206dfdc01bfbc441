"""The loop without ROS against figures found independently of this project."""

import numpy as np
import pytest

from gaik_core import RULES, KinematicChain
from gaik_core.paths import Circle, path_by_name
from gaik_ros import ik_node, pid_controller
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
NEAR = 0.025  # mm


@pytest.fixture(scope="module")
def touch():
    return KinematicChain.load("touch_device")


@pytest.mark.parametrize(("case", "rms"), EXPECTED.items())
def test_tracking_is_as_an_independent_simulation_has_it(touch, case, rms):
    """That one holds each reference, and compares the tip after a step with the path before it: 1 ms better."""
    name, setpoint_rate, feed_forward = case
    settings = Settings(
        setpoint_rate=setpoint_rate, gains=Gains(feed_forward=feed_forward), extrapolation=0.0
    )
    run = simulate(touch, name, path_by_name(name), settings)
    distance = np.linalg.norm(run.tip.values[1:] - run.course.desired(run.tip.time[:-1]), axis=1)
    assert 1e3 * np.sqrt((distance**2).mean()) == pytest.approx(rms, abs=NEAR)


def test_a_reference_that_goes_on_between_setpoints_tracks_as_one_at_the_loops_rate(touch):
    """Held, a reference is late by 4.5 ms on average."""
    for name in ("circle", "lemniscate"):
        going_on = tracking_error(simulate(touch, name, path_by_name(name)))
        assert going_on.rms_m * 1e3 == pytest.approx(EXPECTED[name, 1000, 0.0], abs=0.08)
        held = tracking_error(simulate(touch, name, path_by_name(name), Settings(extrapolation=0.0)))
        assert held.rms_m > 1.2 * going_on.rms_m


def test_the_defaults_are_the_nodes():
    settings = Settings()
    controller = {parameter.name: parameter.default for parameter in pid_controller.TABLE.parameters}
    ik = {parameter.name: parameter.default for parameter in ik_node.TABLE.parameters}
    assert settings.extrapolation == controller["reference_extrapolation"]
    assert settings.rate == controller["rate"]
    assert (settings.tolerance, settings.max_iterations) == (ik["tolerance"], ik["max_iterations"])
    assert (settings.speed_limit, settings.algebra) == (ik["max_joint_speed"], ik["algebra"])
    assert isinstance(settings.rule, RULES[ik["rule"]])


def test_the_lag_behind_a_slow_circle_is_that_of_a_ramp(touch):
    """A ramp of slope w lags by w τ/(3.1 K), so the tip lags by that time along the path."""
    settings = Settings(period=25.0, gains=Gains(i=0.0))
    run = simulate(touch, "circle", path_by_name("circle"), settings)
    late = 0.05 / 3.1
    settled = run.tip.time > 5.0
    distance = np.linalg.norm(run.tip.values - run.course.desired(run.tip.time), axis=1)[settled]
    chord = 2.0 * 0.05 * np.sin(np.pi * late / 25.0)
    np.testing.assert_allclose(distance, chord, rtol=0.02)


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


def test_a_path_out_of_reach_is_refused(touch):
    with pytest.raises(ValueError, match="leaves the reach of touch_device"):
        simulate(touch, "circle", Circle(radius=0.3))


def test_rates_that_do_not_fit_are_refused():
    with pytest.raises(ValueError, match="multiple of setpoint_rate"):
        Settings(rate=1000, setpoint_rate=300)
