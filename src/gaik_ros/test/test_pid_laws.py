"""The PID against closed forms and a simulation by scipy, and what must not happen at changes and stalls."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from gaik_ros.pid import Gains, Pid

DT = 1e-3
WIDE = {"output_min": -1e9, "output_max": 1e9, "integral_min": -1e9, "integral_max": 1e9}


def respond(pid, errors, dt=DT, velocity=0.0):
    return np.array([pid.step(np.atleast_1d(error), dt, velocity) for error in errors])[:, 0]


def test_a_ramp_of_the_error_gives_the_closed_form():
    p, i, d, filter_time, slope = 3.0, 0.7, 0.3, 0.05, 0.8
    pid = Pid(1, Gains(p, i, d, filter_time=filter_time, **WIDE))
    t = DT * np.arange(2000)
    exact = p * slope * t + i * slope * t**2 / 2 + d * slope * (1 - np.exp(-t / filter_time))
    # The integral is a sum over steps, ahead of the exact one by half a step at most.
    np.testing.assert_allclose(respond(pid, slope * t), exact, atol=i * slope * t[-1] * DT)


def test_the_closed_loop_moves_as_scipy_integrates_it():
    p, i, d, filter_time, tau, speed, end = 3.1, 0.5, 0.3, 0.05, 0.05, 0.7, 1.0

    def flow(t, state):
        angle, integral, slow = state
        error = speed * t - angle
        rate = (error - slow) / filter_time
        return [(p * error + i * integral + d * rate) / tau, error, rate]

    exact = solve_ivp(flow, (0.0, end), [0.0, 0.0, 0.0], rtol=1e-10, atol=1e-12).y[0, -1]
    steps, pid, angle = 20_000, Pid(1, Gains(p, i, d, filter_time=filter_time, **WIDE)), np.zeros(1)
    for k in range(steps):
        angle = angle + (end / steps) / tau * pid.step(speed * k * end / steps - angle, end / steps)
    assert angle[0] == pytest.approx(exact, abs=1e-4)


def test_a_ramp_is_followed_with_the_lag_that_the_gain_sets_and_feed_forward_removes_it():
    tau, speed = 0.05, 0.6
    for gain, lag in ((0.0, speed * tau / 3.1), (tau, 0.0)):
        pid, angle = Pid(1, Gains(i=0.0, feed_forward=gain)), np.zeros(1)
        for k in range(3000):
            error = speed * k * DT - angle
            angle = angle + DT / tau * pid.step(error, DT, np.array([speed]))
        assert error[0] == pytest.approx(lag, abs=5e-4)


def test_the_filter_gives_a_jump_of_the_error_its_bounded_decaying_answer():
    pid = Pid(1, Gains(0.0, 0.0, 0.3, filter_time=0.05, **WIDE))
    answer = respond(pid, [0.0, *[1.0] * 200])[1:]
    exact = 0.3 / 0.05 * np.exp(-DT * np.arange(200) / 0.05)
    np.testing.assert_allclose(answer, exact, rtol=0.02)


def test_without_a_filter_the_derivative_is_the_raw_difference():
    pid = Pid(1, Gains(0.0, 0.0, 0.5, filter_time=0.0, **WIDE))
    assert respond(pid, [0.0, 0.2]) == pytest.approx([0.0, 0.5 * 0.2 / DT])


def test_joints_do_not_know_of_each_other():
    gains = Gains(p=[1.0, 2.0, 3.0], i=[0.0, 0.1, 0.2], d=[0.3, 0.2, 0.1], output_max=[1.0, 0.5, 2.0])
    errors = np.random.default_rng(3).normal(size=(300, 3))
    together = Pid(3, gains)
    all_three = np.array([together.step(error, DT) for error in errors])
    for j in range(3):
        own = Gains(gains.p[j], gains.i[j], gains.d[j], output_max=gains.output_max[j])
        np.testing.assert_allclose(respond(Pid(1, own), errors[:, j]), all_three[:, j], atol=1e-14)


def wound(seconds, anti_windup):
    """A controller that was held in saturation by an error of 1 rad for some time."""
    gains = Gains(i=0.5, anti_windup=anti_windup, integral_min=-1e9, integral_max=1e9)
    pid = Pid(1, gains, blend_time=0.0)
    respond(pid, np.ones(int(seconds / DT)))
    return pid


def test_a_minute_of_saturation_leaves_no_wound_up_integral():
    pid = wound(60.0, True)
    assert pid.integral[0] == pytest.approx(0.0, abs=1e-3)
    freed = respond(pid, [-0.01] * 500)
    assert freed[-1] == pytest.approx(-0.031, abs=5e-3)  # p times the error, nothing left over
    assert wound(60.0, False).integral[0] > 10.0  # what it would be without


def test_the_integral_still_unwinds_while_the_output_is_limited():
    pid = steady(i=0.5)
    before = pid.integral[0]
    pid.set_gains(Gains(i=0.5, feed_forward=1.0))
    for _ in range(1000):
        assert pid.step(np.array([-0.1]), DT, 50.0)[0] <= 1.0
    assert pid.output[0] == 1.0
    assert pid.integral[0] == pytest.approx(before - 0.5 * 0.1 * 1.0, abs=1e-3)


def test_the_integral_stays_in_its_clamp():
    pid = Pid(1, Gains(p=0.0, i=1.0, d=0.0, integral_max=0.2))
    assert respond(pid, [1.0] * 1000).max() == pytest.approx(0.2)


def steady(error=0.1, **gains):
    pid = Pid(1, Gains(**gains))
    respond(pid, [error] * 3000)
    return pid


def test_a_change_of_gains_does_not_move_the_output_at_once_but_comes_into_force():
    pid = steady(p=2.0, i=0.3)
    before = pid.output[0]
    pid.set_gains(Gains(p=5.0, i=0.0, d=1.0))
    after = respond(pid, [0.1] * 3000)
    assert after[0] == pytest.approx(before, abs=1e-9)
    assert np.abs(np.diff(after)).max() < 0.02 * abs(after[-1] - before)
    assert after[-1] == pytest.approx(0.5 + pid.integral[0], abs=1e-6)


def test_a_reset_does_not_move_the_output_at_once_but_forgets():
    pid = steady(p=2.0, i=0.3)
    before = pid.output[0]
    pid.reset()
    after = respond(pid, [0.1] * 1000)
    assert after[0] == pytest.approx(before, abs=1e-9)
    assert after[-1] == pytest.approx(0.2 + 0.3 * 0.1 * 1000 * DT, abs=1e-3)


def test_a_step_of_no_time_changes_nothing():
    pid, twin = steady(), steady()
    before = pid.output.copy()
    for dt in (0.0, -1.0, 1e-9, 5e-324, float("nan")):
        assert pid.step(np.array([5.0]), dt) == before
    np.testing.assert_array_equal(respond(pid, [0.1, 0.2]), respond(twin, [0.1, 0.2]))


@pytest.mark.parametrize("pause", [0.05, 0.2, 5.0])
def test_no_spike_after_a_stall(pause):
    pid = steady(error=0.1, d=0.3, i=0.0, output_max=100.0)
    after = pid.step(np.array([0.12]), pause)
    # The share of the derivative is at most that of the mean speed of the pause.
    assert after[0] <= 3.1 * 0.12 + 0.3 * 0.02 / pause + 1e-9
    assert respond(pid, [0.12] * 5)[0] <= 3.1 * 0.12 + 0.3 * 0.02 / pause + 1e-9


def test_a_long_stall_does_not_wind_the_integral():
    pid = steady(i=1.0)
    before = pid.integral[0]
    pid.step(np.array([0.1]), 60.0)
    assert pid.integral[0] == before


@pytest.mark.parametrize("name", ["p", "i", "d", "feed_forward", "filter_time"])
@pytest.mark.parametrize("value", [-1.0, math.nan, math.inf, [1.0, -2.0, 3.0]])
def test_a_bad_gain_is_refused_by_name(name, value):
    with pytest.raises(ValueError, match=f"{name} is"):
        Gains(**{name: value})


def test_crossed_limits_and_gains_of_other_joints_are_refused():
    with pytest.raises(ValueError, match="output_min"):
        Gains(output_min=0.5)
    with pytest.raises(ValueError, match="shape"):
        Pid(3, Gains(p=[1.0, 2.0]))


@given(
    st.lists(st.tuples(st.floats(-10, 10), st.floats(-0.1, 0.5)), min_size=1, max_size=50),
    st.floats(0, 50),
    st.floats(0, 5),
    st.floats(0, 1),
)
def test_the_output_is_finite_and_inside_the_limits_whatever_comes(steps, p, d, filter_time):
    pid = Pid(1, Gains(p=p, i=1.0, d=d, filter_time=filter_time, output_min=-0.7, output_max=0.4))
    for error, dt in steps:
        assert -0.7 <= pid.step(np.array([error]), dt)[0] <= 0.4
