"""Setpoints to references over a synthetic clock."""

import numpy as np
import pytest

from gaik_core import KinematicChain, LevenbergMarquardt
from gaik_core.paths import Circle
from gaik_ros.continuous_ik import ContinuousIk, Result
from gaik_ros.setpoint_follower import LATCH, LONGEST_WAIT, STREAM, FollowerSettings, SetpointFollower

CHAIN = KinematicChain.load("touch_device")
PERIOD, BEGIN = 0.01, 1000.0
FAR = np.array([0.05, 0.05, 0.0])


def follower(**settings):
    ik = ContinuousIk(CHAIN, "quaternion", LevenbergMarquardt(), 1e-6, 1000)
    made = SetpointFollower(ik, FollowerSettings(**{"speed_limit": 1.0, **settings}), PERIOD)
    made.start(CHAIN.home.copy(), BEGIN)
    return made


def answer(made, setpoint, now):
    found = made.solve(np.asarray(setpoint, dtype=float))
    made.accept(np.asarray(setpoint, dtype=float), now, round(now / PERIOD), found)
    made.advance(now)
    return found


def ticks(made, since, seconds):
    """Times and positions published at the ticks of some seconds."""
    published = []
    for now in since + PERIOD * np.arange(1, round(seconds / PERIOD) + 1):
        if made.due(now):
            published.append((now, *made.advance(now)))
    return published


@pytest.mark.parametrize("mode", [LATCH, STREAM])
def test_before_the_first_setpoint_nothing_is_published(mode):
    assert ticks(follower(mode=mode), BEGIN, 1.0) == []


def test_latched_a_single_setpoint_is_carried_out_and_then_repeated_at_every_tick():
    made = follower()
    assert answer(made, FAR, BEGIN).result is Result.REACHED
    published = ticks(made, BEGIN, 3.0)
    assert len(published) == 300
    assert np.linalg.norm(CHAIN.forward(published[-1][1]) - FAR) < 1e-6
    steps = np.abs(np.diff([p for _, p, _ in published], axis=0)).max(axis=1)
    assert steps.max() <= 1.0 * PERIOD * (1 + 1e-9)
    np.testing.assert_array_equal(published[-1][2], 0.0)


def test_a_dead_stream_stops_within_the_timeout_and_a_period():
    made = follower(mode=STREAM, setpoint_timeout=0.1)
    answer(made, FAR, BEGIN)
    published = ticks(made, BEGIN, 1.0)
    moving = [now for now, _, velocity in published if velocity.any()]
    assert 0.05 < moving[-1] - BEGIN <= 0.1 + PERIOD + 1e-9
    assert made.stream_dead
    answer(made, FAR, BEGIN + 1.0)
    assert not made.stream_dead
    assert np.abs(ticks(made, BEGIN + 1.0, 0.05)[-1][2]).max() == pytest.approx(1.0)


def test_a_living_stream_is_published_with_its_setpoints_and_not_twice():
    made, circle = follower(speed_limit=50.0), Circle()
    made.start(answer(made, circle.position(0.0), BEGIN).angles, BEGIN)
    extra = 0
    for k in range(1, 200):
        now = BEGIN + PERIOD * k
        answer(made, circle.position(2 * np.pi * PERIOD * k / 6.3), now)
        extra += made.due(now + 0.4 * PERIOD)
    assert extra == 0
    exact = 2 * np.pi / 6.3 * circle.derivative(2 * np.pi * PERIOD * 199 / 6.3)
    felt = CHAIN.jacobian(made.reference.position) @ made.reference.velocity
    np.testing.assert_allclose(felt, exact, atol=0.01 * np.linalg.norm(exact))


def test_after_a_stall_the_reference_does_not_leap():
    made = follower()
    answer(made, FAR, BEGIN)
    before = made.reference.position
    made.due(BEGIN + 5.0)
    after, _ = made.advance(BEGIN + 5.0)
    assert np.abs(after - before).max() <= 1.0 * 2 * PERIOD + 1e-12


def test_an_unreachable_setpoint_leads_to_the_nearest_point_and_stands():
    made = follower(speed_limit=50.0)
    for k in range(5):
        found = answer(made, [0.0, 0.0, 3.0 + k], BEGIN + PERIOD * k)
        assert found.result is Result.UNREACHABLE
    published = ticks(made, BEGIN + 5 * PERIOD, 1.0)
    np.testing.assert_allclose(CHAIN.forward(published[-1][1]), found.nearest, atol=1e-9)
    np.testing.assert_array_equal(published[-1][2], 0.0)


def test_a_setpoint_waits_for_the_start_only_so_long():
    ik = ContinuousIk(CHAIN, "quaternion", LevenbergMarquardt(), 1e-6, 1000)
    made = SetpointFollower(ik, FollowerSettings(1.0), PERIOD)
    assert not made.overdue(BEGIN, BEGIN + 0.9 * LONGEST_WAIT)
    assert made.overdue(BEGIN, BEGIN + 1.1 * LONGEST_WAIT)
    made.start(CHAIN.home.copy(), BEGIN)
    assert not made.overdue(BEGIN, BEGIN + 100.0)  # it waits for nothing any more


def test_a_bad_change_leaves_everything_as_it_was():
    made = follower()
    with pytest.raises(ValueError, match="speed limit"):
        made.configure(None, FollowerSettings(speed_limit=-1.0))
    assert answer(made, FAR, BEGIN).result is Result.REACHED
    assert ticks(made, BEGIN, 0.5)
