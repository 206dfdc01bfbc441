"""Laws of the joint dynamics: the closed form, an independent integrator, and limits that hold."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from touch_sim.dynamics import JointDynamics, JointModel, hold_factor
from touch_sim.joint_limits import JointLimits

FREE = JointLimits.of_joints(np.full(3, -np.inf), np.full(3, np.inf))
# The Touch's: a stop at each joint, and one between the arms that limits elbow - shoulder.
TOUCH = JointLimits(
    lower=np.array([-0.98, 0.0, -np.inf]),
    upper=np.array([0.98, 1.75, np.inf]),
    coupling=np.array([[0.0, -1.0, 1.0]]),
    offset=np.zeros(1),
    axis_lower=np.array([-0.81]),
    axis_upper=np.array([1.25]),
    joint_names=("waist", "shoulder", "elbow"),
    axis_names=("elbow",),
)

efforts = st.lists(st.floats(-1.5, 1.5), min_size=3, max_size=3).map(np.array)
durations = st.floats(1e-5, 0.2)
stiffnesses = st.sampled_from([0.0, 1e-9, 1e-3, 0.4, 1.0, 30.0])


@given(efforts, durations, stiffnesses)
def test_closed_form(effort, dt, stiffness):
    start = np.array([0.3, -0.2, 0.1])
    dynamics = JointDynamics(JointModel(2.0, 0.08, stiffness, effort_limit=2.0), FREE, start)
    dynamics.step(effort, dt)
    if stiffness == 0.0:
        expected = start + 2.0 / 0.08 * effort * dt
    else:
        settled = 2.0 * effort / stiffness
        expected = settled + (start - settled) * np.exp(-stiffness / 0.08 * dt)
    # The closed form itself cancels where the stiffness is tiny: 1e-16 of 2/stiffness.
    lost = 1e-15 * 3.0 / stiffness if stiffness else 0.0
    np.testing.assert_allclose(dynamics.angles, expected, rtol=0, atol=1e-12 + lost)
    slope = (2.0 * effort - stiffness * dynamics.angles) / 0.08
    np.testing.assert_allclose(dynamics.velocity, slope, rtol=0, atol=1e-12)


@pytest.mark.parametrize("stiffness", [0.0, 0.7, [0.0, 0.5, 4.0]])
def test_an_independent_integrator_agrees_over_random_commands(stiffness):
    random = np.random.default_rng(7)
    gain, tau = np.array([1.0, 2.0, 0.5]), np.array([0.05, 0.02, 0.1])
    dynamics = JointDynamics(JointModel(gain, tau, stiffness), FREE, np.zeros(3))
    angles = np.zeros(3)
    for _ in range(20):
        effort, dt = random.uniform(-1.0, 1.0, 3), random.uniform(1e-3, 0.05)
        run = solve_ivp(
            lambda _, y, u=effort: (gain * u - np.asarray(stiffness) * y) / tau, (0.0, dt), angles,
            rtol=1e-11, atol=1e-12,
        )  # fmt: skip
        angles = run.y[:, -1]
        dynamics.step(effort, dt)
        np.testing.assert_allclose(dynamics.angles, angles, rtol=0, atol=1e-8)


@given(efforts, durations, stiffnesses)
def test_two_half_steps_are_one_step(effort, dt, stiffness):
    whole, halves = (JointDynamics(JointModel(stiffness=stiffness), FREE, [0.1, 0.2, -0.3]) for _ in range(2))
    whole.step(effort, dt)
    halves.step(effort, dt / 2)
    halves.step(effort, dt / 2)
    np.testing.assert_allclose(halves.angles, whole.angles, rtol=0, atol=1e-12)
    np.testing.assert_allclose(halves.velocity, whole.velocity, rtol=0, atol=1e-10)


@given(efforts, durations)
def test_two_half_steps_are_one_step_along_a_stop_between_the_arms(effort, dt):
    whole, halves = (JointDynamics(JointModel(), TOUCH, [0.0, 0.9, 2.14]) for _ in range(2))
    whole.step(effort, min(dt, 0.02))
    for _ in range(2):
        halves.step(effort, min(dt, 0.02) / 2)
    np.testing.assert_allclose(halves.angles, whole.angles, rtol=0, atol=1e-12)


def test_the_step_tends_to_that_of_a_viscous_axis_as_its_stiffness_vanishes():
    stiffness = 10.0 ** -np.arange(1.0, 320.0, 3.0)
    factor = hold_factor(stiffness, np.full_like(stiffness, 0.05), 1e-3)
    # (1 - exp(-x))/x = 1 - x/2 + ..., and never above one.
    assert (factor <= 1e-3).all()
    np.testing.assert_allclose(factor, 1e-3, rtol=0.51 * 1e-3 * 0.1 / 0.05)
    assert hold_factor(np.zeros(1), np.full(1, 0.05), 1e-3)[0] == 1e-3
    np.testing.assert_array_equal(factor[stiffness < 1e-20], 1e-3)


@settings(max_examples=200)
@given(st.lists(st.tuples(efforts, durations), min_size=1, max_size=30), st.sampled_from([0.0, 0.5, 5.0]))
def test_no_limit_is_crossed(commands, stiffness):
    dynamics = JointDynamics(JointModel(1.0, 0.05, stiffness), TOUCH, [0.0, 0.8, 0.9])
    for effort, dt in commands:
        dynamics.step(effort, dt)
        waist, shoulder, elbow = dynamics.angles
        assert -0.98 <= waist <= 0.98
        assert 0.0 <= shoulder <= 1.75
        assert -0.81 - 1e-9 <= elbow - shoulder <= 1.25 + 1e-9
        if abs(waist) == 0.98:
            assert waist * dynamics.velocity[0] <= 1e-12


def test_a_joint_rests_on_its_stop_and_leaves_it_again():
    dynamics = JointDynamics(JointModel(), TOUCH, [0.9, 0.8, 0.9])
    for _ in range(200):
        dynamics.step([1.0, 0.0, 0.0], 1e-3)
    assert dynamics.angles[0] == 0.98
    assert dynamics.velocity[0] == 0.0
    dynamics.step([-0.1, 0.0, 0.0], 1e-3)
    assert dynamics.angles[0] == pytest.approx(0.98 - 0.1 / 0.05 * 1e-3)
    assert dynamics.velocity[0] == pytest.approx(-2.0)


def test_a_push_of_the_elbow_on_the_stop_between_the_arms_takes_the_shoulder_along():
    dynamics = JointDynamics(JointModel(), TOUCH, [0.0, 0.5, 1.75])
    dynamics.step([0.0, 0.0, 1.0], 1e-3)
    # Equal axes share the 20 rad/s of one of them: half each.
    np.testing.assert_allclose(dynamics.velocity, [0.0, 10.0, 10.0], atol=1e-9)
    assert dynamics.angles[2] - dynamics.angles[1] == pytest.approx(1.25, abs=1e-12)


def test_a_corner_of_two_stops_holds():
    dynamics = JointDynamics(JointModel(), TOUCH, [0.0, 1.75, 3.0])
    for _ in range(50):
        dynamics.step([0.0, 1.0, 1.0], 1e-3)
    np.testing.assert_allclose(dynamics.angles, [0.0, 1.75, 3.0], atol=1e-12)
    np.testing.assert_allclose(dynamics.velocity, 0.0, atol=1e-9)


@given(efforts)
def test_effort_beyond_the_limit_moves_no_faster(effort):
    cut, plain = (JointDynamics(JointModel(effort_limit=0.6), FREE, np.zeros(3)) for _ in range(2))
    cut.step(effort, 1e-2)
    plain.step(np.clip(effort, -0.6, 0.6), 1e-2)
    np.testing.assert_array_equal(cut.angles, plain.angles)
    np.testing.assert_array_equal(cut.effort, np.clip(effort, -0.6, 0.6))


@pytest.mark.parametrize("effort", [[np.nan, 0.0, 0.0], [np.inf, 0.0, 0.0], [0.0, 0.0], 0.0])
def test_a_bad_effort_is_refused_and_changes_nothing(effort):
    dynamics = JointDynamics(JointModel(), FREE, [0.1, 0.2, 0.3])
    dynamics.step([0.1, 0.1, 0.1], 1e-3)
    before = dynamics.angles.copy(), dynamics.velocity.copy()
    with pytest.raises(ValueError, match="effort must be 3 finite numbers"):
        dynamics.step(effort, 1e-3)
    np.testing.assert_array_equal((dynamics.angles, dynamics.velocity), before)


@pytest.mark.parametrize("dt", [-1e-3, np.nan, np.inf])
def test_a_bad_duration_is_refused(dt):
    with pytest.raises(ValueError, match="dt must be"):
        JointDynamics(JointModel(), FREE, np.zeros(3)).step(np.zeros(3), dt)


def test_a_step_of_no_duration_moves_nothing():
    dynamics = JointDynamics(JointModel(stiffness=0.5), TOUCH, [0.98, 0.5, 1.0])
    dynamics.step([1.0, 1.0, 1.0], 0.0)
    np.testing.assert_array_equal(dynamics.angles, [0.98, 0.5, 1.0])


@pytest.mark.parametrize(
    ("angles", "message"),
    [([1.2, 0.5, 0.5], "joint waist is at 1.2 rad"), ([0.0, 0.0, 1.5], "axis elbow is at 1.5 rad")],
)
def test_a_start_outside_is_refused_by_name(angles, message):
    with pytest.raises(ValueError, match=message):
        JointDynamics(JointModel(), TOUCH, angles)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("gain", 0.0),
        ("time_constant", -1.0),
        ("stiffness", -0.1),
        ("effort_limit", np.nan),
        ("gain", [1, 0, 1]),
    ],
)
def test_a_bad_constant_is_refused_by_name(name, value):
    with pytest.raises(ValueError, match=name):
        JointModel(**{name: value})
