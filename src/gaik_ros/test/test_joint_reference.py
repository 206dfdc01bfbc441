"""The reference that moves under a speed limit."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gaik_ros.reference import JointReference

angles = st.lists(st.floats(-3, 3), min_size=3, max_size=3).map(np.array)


@given(
    angles,
    st.lists(st.tuples(angles, st.floats(0, 0.05)), min_size=1, max_size=30),
    st.lists(st.floats(0.1, 5), min_size=3, max_size=3).map(np.array),
)
def test_no_step_and_no_velocity_is_above_the_limit(start, moves, limit):
    reference = JointReference(start, limit)
    for goal, dt in moves:
        before = reference.position
        reference.aim(goal, velocity=10.0 * goal)
        reference.advance(dt)
        assert (np.abs(reference.position - before) <= limit * dt * (1 + 1e-12) + 1e-15).all()
        assert (np.abs(reference.velocity) <= limit * (1 + 1e-12)).all()


def test_it_goes_straight_and_arrives_when_the_slowest_joint_does():
    reference = JointReference([0.0, 0.0, 0.0], [1.0, 2.0, 1.0])
    goal = np.array([0.5, -0.5, 0.1])
    reference.aim(goal)
    steps = 0
    while not reference.arrived:
        position = reference.advance(0.01)
        np.testing.assert_allclose(np.cross(position, goal), 0.0, atol=1e-12)
        steps += 1
        assert steps < 100
    assert steps == pytest.approx(50, abs=1)  # 0.5 rad at 1 rad/s
    np.testing.assert_array_equal(reference.position, goal)
    np.testing.assert_array_equal(reference.velocity, 0.0)


def test_on_the_way_the_velocity_is_that_of_the_way_and_at_the_goal_that_of_the_goal():
    reference = JointReference([0.0], 1.0)
    reference.aim([0.1])
    reference.advance(0.01)
    assert reference.velocity == pytest.approx([1.0])
    reference.aim([0.015], velocity=[0.4])
    reference.advance(0.01)
    assert reference.velocity == pytest.approx([0.4])
    reference.rest()
    reference.advance(0.01)
    assert reference.velocity == pytest.approx([0.0])


def test_jitter_of_a_moving_goal_does_not_reach_the_velocity():
    reference, now, speed = JointReference([0.0], 1.0), 0.0, 0.6
    for k, late in enumerate(np.random.default_rng(1).uniform(0.0, 0.009, 200)):
        reference.aim([speed * 0.01 * k], velocity=[speed])
        reference.advance(0.01 * k + late - now)
        now = 0.01 * k + late
        assert k == 0 or reference.velocity == pytest.approx([speed])
        assert abs(reference.position[0] - speed * 0.01 * k) < 0.01


def test_stop_stays_where_it_is():
    reference = JointReference([0.0, 1.0], 1.0)
    reference.aim([1.0, 0.0])
    stopped_at = reference.advance(0.1).copy()
    reference.stop()
    np.testing.assert_array_equal(reference.advance(1.0), stopped_at)
    assert reference.arrived


@pytest.mark.parametrize("limit", [0.0, -1.0, float("nan"), float("inf"), [1.0, 0.0]])
def test_a_limit_that_is_none_is_refused_and_the_old_one_stays(limit):
    reference = JointReference([0.0, 0.0], 1.0)
    with pytest.raises(ValueError, match="speed limit"):
        reference.set_speed_limit(limit)
    reference.aim([5.0, 5.0])
    assert reference.advance(0.1) == pytest.approx([0.1, 0.1])
