"""The velocity of a stream of setpoints, from jittering times of receipt."""

import numpy as np
import pytest

from gaik_ros.setpoint_motion import SetpointMotion

VELOCITY = np.array([0.05, -0.02, 0.01])
PERIOD = 0.01


def stream(motion, numbers, lateness=0.0):
    """The velocities found for the setpoints of these numbers, which are received late by so much."""
    late = np.broadcast_to(lateness, len(numbers))
    return np.array(
        [motion.add(VELOCITY * PERIOD * n, PERIOD * n + d, n) for n, d in zip(numbers, late, strict=True)]
    )


def test_jitter_of_the_receipt_does_not_reach_the_velocity():
    lateness = np.random.default_rng(0).uniform(0, 0.9 * PERIOD, 300)
    found = stream(SetpointMotion(), range(300), lateness)[50:]
    assert (
        np.abs(found / VELOCITY - 1.0).max() < 0.05
    )  # a raw difference is off by up to nine tenths and more


def test_pairs_that_come_together_have_the_velocity_of_the_stream():
    lateness = np.where(np.arange(300) % 2 == 0, PERIOD - 1e-5, 0.0)  # every second one waits for the next
    found = stream(SetpointMotion(), range(300), lateness)[50:]
    assert np.abs(found / VELOCITY - 1.0).max() < 0.05


def test_superseded_setpoints_do_not_change_the_velocity():
    numbers = np.delete(np.arange(200), [90, 120, 121, 150, 151, 152])
    found = stream(SetpointMotion(), numbers.tolist())[5:]
    np.testing.assert_allclose(found, np.broadcast_to(VELOCITY, found.shape), rtol=1e-6)


def test_single_setpoints_have_no_velocity():
    motion = SetpointMotion(longest_period=0.25)
    for number, now in enumerate((0.0, 3.0, 6.0)):
        np.testing.assert_array_equal(motion.add(np.array([now, 0, 0]), now, number), 0.0)
        assert motion.standing(now)


def test_after_a_pause_the_stream_begins_anew():
    motion = SetpointMotion()
    stream(motion, range(50))
    again = stream(motion, range(60, 70), lateness=1.0)
    np.testing.assert_array_equal(again[0], 0.0)
    np.testing.assert_allclose(again[-1], VELOCITY)


def test_a_burst_at_the_start_gives_no_huge_velocity():
    motion = SetpointMotion()
    found = [motion.add(VELOCITY * PERIOD * n, 1e-5 * n, n) for n in range(20)]
    assert np.linalg.norm(found, axis=1).max() <= PERIOD / 5e-4 * np.linalg.norm(VELOCITY) * (1 + 1e-9)


def test_a_dead_stream_stands_after_two_periods_and_a_half():
    motion = SetpointMotion()
    stream(motion, range(50))
    assert motion.period == pytest.approx(PERIOD)
    assert not motion.standing(PERIOD * (49 + 2.4))
    assert motion.standing(PERIOD * (49 + 2.6))


def test_whatever_comes_the_velocity_is_finite():
    motion = SetpointMotion()
    for number, now in enumerate((0.0, 0.01, 0.01, 0.005, 0.02, 0.02, 1e9, 1e9)):
        assert np.isfinite(motion.add(np.array([now, 1.0, 2.0]), now, number)).all()
    assert np.isfinite(motion.add(np.zeros(3), 1e9 + 0.01, 3)).all()
