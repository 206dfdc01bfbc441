"""What an encoder does to angles."""

import numpy as np
import pytest

from touch_sim.encoder import Encoder

ANGLES = np.array([0.1, -0.7, 1.3])


def test_an_ideal_encoder_passes_everything_through():
    angles, velocity = Encoder().read(ANGLES, np.array([1.0, 2.0, 3.0]), 1e-3)
    np.testing.assert_array_equal(angles, ANGLES)
    np.testing.assert_array_equal(velocity, [1.0, 2.0, 3.0])


def test_readings_are_whole_counts_within_half_a_count():
    encoder = Encoder(resolution=0.004)
    for angles in np.random.default_rng(1).uniform(-2.0, 2.0, (100, 3)):
        reading, _ = encoder.read(angles, np.zeros(3), 1e-3)
        np.testing.assert_allclose(reading / 0.004, np.round(reading / 0.004), atol=1e-9)
        assert np.abs(reading - angles).max() <= 0.002 + 1e-12


def test_noise_has_the_deviation_asked_for_and_no_bias():
    encoder = Encoder(noise=0.01, seed=3)
    errors = np.array([encoder.read(ANGLES, np.zeros(3), 1e-3)[0] - ANGLES for _ in range(5000)])
    assert errors.std() == pytest.approx(0.01, rel=0.05)
    assert abs(errors.mean()) < 4 * 0.01 / np.sqrt(errors.size)


def test_the_same_seed_gives_the_same_readings_and_another_seed_others():
    first, again, other = (
        [Encoder(noise=0.01, seed=seed).read(ANGLES, np.zeros(3), 1e-3)[0]] for seed in (5, 5, 6)
    )
    np.testing.assert_array_equal(first, again)
    assert (first[0] != other[0]).all()


def test_reset_repeats_the_readings():
    encoder = Encoder(noise=0.01, seed=5)
    before = [encoder.read(ANGLES, np.zeros(3), 1e-3) for _ in range(4)]
    encoder.reset()
    np.testing.assert_array_equal([encoder.read(ANGLES, np.zeros(3), 1e-3) for _ in range(4)], before)


def test_the_velocity_of_quantised_readings_settles_on_the_true_one():
    encoder, dt = Encoder(resolution=1e-4, velocity_time_constant=0.02), 1e-3
    rate = np.array([0.5, -1.0, 0.0])
    velocities = [encoder.read(rate * k * dt, rate, dt)[1] for k in range(1000)]
    np.testing.assert_array_equal(velocities[0], 0.0)
    np.testing.assert_allclose(np.mean(velocities[500:], axis=0), rate, atol=1e-3)


@pytest.mark.parametrize("name", ["resolution", "noise", "velocity_time_constant"])
@pytest.mark.parametrize("value", [-1.0, np.nan, np.inf])
def test_a_bad_setting_is_refused_by_name(name, value):
    with pytest.raises(ValueError, match=name):
        Encoder(**{name: value})
