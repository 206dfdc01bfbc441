"""A command is held for its time and no longer."""

import numpy as np

from touch_sim.command_hold import CommandHold

EFFORT = np.array([0.1, -0.2, 0.3])


def test_nothing_acts_before_the_first_command_and_none_is_missed():
    hold = CommandHold(3, 0.1)
    for _ in range(500):
        np.testing.assert_array_equal(hold.effort(1e-3), 0.0)
    assert not hold.lost
    assert not hold.received


def test_a_command_acts_until_its_timeout():
    hold = CommandHold(3, 0.1)
    hold.receive(EFFORT)
    acted = [bool(hold.effort(1e-3).any()) for _ in range(300)]
    # The step that takes it, then a tenth of a second in steps of 1 ms; one step of rounding.
    assert 100 <= sum(acted) <= 102
    assert acted == sorted(acted, reverse=True)
    assert hold.lost


def test_a_stream_never_times_out_and_the_newest_counts():
    hold = CommandHold(3, 0.1)
    for k in range(300):
        hold.receive(EFFORT)
        hold.receive(EFFORT * k)
        np.testing.assert_array_equal(hold.effort(0.09), EFFORT * k)
        assert not hold.lost


def test_a_command_after_a_loss_acts_again():
    hold = CommandHold(3, 0.1)
    hold.receive(EFFORT)
    hold.effort(1e-3)
    hold.effort(0.2)
    assert hold.lost
    hold.receive(EFFORT)
    np.testing.assert_array_equal(hold.effort(1e-3), EFFORT)
    assert not hold.lost


def test_a_command_from_before_a_reset_is_gone():
    hold = CommandHold(3, 0.1)
    hold.receive(EFFORT)
    hold.forget()
    np.testing.assert_array_equal(hold.effort(1e-3), 0.0)
    assert not hold.lost
