"""What the sampled loop bears, against the eigenvalues of its matrix and figures found independently."""

import numpy as np
import pytest

from touch_sim.loop_margins import largest_gain, longest_delay, remaining_share, settles

P, D, DT = (
    3.1,
    0.3,
    1e-3,
)  # the paper's gains but for the integral, too small to matter here, and the step in s


def spectral_radius(mobility, delay, filter_time):
    """Of one step of the loop; its state: the angles now and up to `delay + 1` steps ago, and the derivative."""
    keep = np.exp(-DT / filter_time) if filter_time else 0.0
    unit = np.eye(delay + 3)
    known, before = -unit[delay], -unit[delay + 1]
    derivative = keep * unit[-1] + (1.0 - keep) / DT * (known - before)
    now = unit[0] + DT * mobility * (P * known + D * derivative)
    step = np.array([now, *unit[: delay + 1], derivative])
    return np.abs(np.linalg.eigvals(step)).max()


@pytest.mark.parametrize("filter_time", [0.0, 0.01, 0.05])
@pytest.mark.parametrize("delay", [0, 1, 2, 3, 8])
def test_a_loop_settles_where_its_eigenvalues_are_inside_the_circle(filter_time, delay):
    mobility = np.arange(1.0, 80.0, 3.0)
    radius = np.array([spectral_radius(gain, delay, filter_time) for gain in mobility])
    clear = np.abs(radius - 1.0) > 0.002  # nearer to the circle, two seconds do not show it
    assert clear.sum() > 20
    settled = settles(mobility, np.full(mobility.shape, delay), filter_time)
    np.testing.assert_array_equal(settled[clear], radius[clear] < 1.0)


def test_the_raw_difference_bears_no_more_than_the_inverse_of_its_gain():
    for delay in range(4):
        assert 3.0 <= largest_gain(0.0, delay) <= 1.0 / D


@pytest.mark.parametrize(("delay", "gain"), [(0, 60.0), (1, 32.0), (2, 21.0), (3, 15.0)])
def test_ten_milliseconds_bear_what_was_found_independently(delay, gain):
    assert largest_gain(0.01, delay) == pytest.approx(gain, abs=1.0)


def test_the_longer_filter_forgives_more_delay():
    assert longest_delay(0.0) < 0.0
    assert 0.001 <= longest_delay(0.01) <= 0.003
    assert longest_delay(0.05) == pytest.approx(0.009, abs=0.0015)


def test_a_stiff_joint_keeps_a_share_of_a_step():
    assert remaining_share(1.0) == pytest.approx(1.0 / (1.0 + P), abs=0.005)
    assert remaining_share(0.0) == pytest.approx(0.0, abs=0.001)
