"""The velocity of a stream of setpoints, from jittering times of receipt."""

import numpy as np
import pytest

from gaik_ros.setpoint_motion import SetpointMotion

VELOCITY = np.array([0.05, -0.02, 0.01])


def stream(motion, times, sampled):
    return [motion.add(VELOCITY * t, now) for t, now in zip(sampled, times, strict=True)]


def test_jitter_of_the_receipt_does_not_reach_the_velocity():
    sampled = 0.01 * np.arange(300)
    times = sampled + np.random.default_rng(0).uniform(0, 0.003, 300)
    late = np.array(stream(SetpointMotion(), times, sampled)[50:])
    assert np.abs(late / VELOCITY - 1.0).max() < 0.1  # a raw difference is off by 30 %


def test_lost_setpoints_do_not_double_the_velocity():
    sampled = np.delete(0.01 * np.arange(200), [90, 120, 121, 150])
    found = np.array(stream(SetpointMotion(), sampled, sampled)[1:])
    np.testing.assert_allclose(found, np.broadcast_to(VELOCITY, found.shape), rtol=1e-6)


def test_single_setpoints_have_no_velocity():
    motion = SetpointMotion(longest_period=0.25)
    for now in (0.0, 3.0, 6.0):
        np.testing.assert_array_equal(motion.add(np.array([now, 0, 0]), now), 0.0)
        assert motion.standing(now)


def test_a_dead_stream_stands_after_a_period_and_a_half():
    motion, sampled = SetpointMotion(), 0.01 * np.arange(50)
    stream(motion, sampled, sampled)
    assert motion.period == pytest.approx(0.01)
    assert not motion.standing(sampled[-1] + 0.014)
    assert motion.standing(sampled[-1] + 0.016)


def test_two_at_the_same_time_give_a_finite_velocity():
    motion = SetpointMotion()
    for now in (0.0, 0.01, 0.01, 0.02, 0.02):
        assert np.isfinite(motion.add(np.array([now, 1.0, 2.0]), now)).all()
