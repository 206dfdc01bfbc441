"""The tracking error against hand-made recordings whose error is known."""

import numpy as np
import pytest

from gaik_core.paths import Circle, Lemniscate, path_by_name
from gaik_ros.tracking import Run, Series, tracking_error
from touch_sim.tracking import Lap, lap_of, setpoint_numbers

PERIOD, RATE = 6.3, 100.0
NOTHING = Series(np.zeros(0), np.zeros((0, 3)))


def run_of(lap, tip):
    return Run("circle", lap, ("waist", "shoulder", "elbow"), NOTHING, tip, NOTHING, NOTHING)


def test_a_tip_on_the_path_but_late_is_in_error_by_the_way_it_is_late():
    lap = Lap(Circle(radius=0.05), PERIOD, start=3.0, end=3.0 + PERIOD)
    time = np.arange(0.0, 20.0, 1e-3)
    late = lap.desired(time - 0.02)
    error = tracking_error(run_of(lap, Series(time, late)))
    chord = 2.0 * 0.05 * np.sin(np.pi * 0.02 / PERIOD)
    assert error.rms_m == pytest.approx(chord, rel=1e-9)
    assert error.max_m == pytest.approx(chord, rel=1e-9)


def test_what_is_before_and_after_the_laps_does_not_count():
    lap = Lap(Circle(), PERIOD, start=3.0, end=3.0 + PERIOD)
    time = np.arange(0.0, 20.0, 1e-3)
    tip = lap.desired(time)
    tip[(time < 3.0) | (time >= 3.0 + PERIOD)] += 1.0
    error = tracking_error(run_of(lap, Series(time, tip)))
    assert error.max_m < 1e-12
    assert error.samples == 6300


def test_rms_and_max_of_a_known_distance():
    lap = Lap(Circle(), PERIOD, start=0.0, end=PERIOD)
    time = np.arange(4) * 1e-3
    offsets = np.array([[0.003, 0.0, 0.0], [0.0, 0.004, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    error = tracking_error(run_of(lap, Series(time, lap.desired(time) + offsets)))
    assert error.rms_m == pytest.approx(0.0025)
    assert error.max_m == pytest.approx(0.004)


def test_no_tip_in_the_laps_is_said():
    with pytest.raises(ValueError, match="no tip was measured while the circle was followed"):
        tracking_error(run_of(Lap(Circle(), PERIOD, 0.0, PERIOD), NOTHING))


@pytest.mark.parametrize("name", ["circle", "lemniscate"])
@pytest.mark.parametrize("laps", [1, 3])
def test_the_clock_of_a_path_is_found_from_late_and_lost_setpoints(name, laps):
    path, random = path_by_name(name), np.random.default_rng(4)
    points = np.tile(path.sample(RATE, PERIOD), (laps, 1))
    received = 100.0 + np.arange(len(points)) / RATE + random.uniform(0.0, 0.004, len(points))
    received[17] = 100.17  # one is on time
    kept = random.random(len(points)) > 0.2
    kept[[0, 17]] = True
    lap = lap_of(Series(received[kept], points[kept]), path, RATE, PERIOD, laps)
    assert lap.start == pytest.approx(100.0, abs=1e-9)
    assert lap.end - lap.start == pytest.approx(laps * PERIOD)
    numbers = setpoint_numbers(points[kept], path, RATE, PERIOD)
    np.testing.assert_array_equal(numbers, np.flatnonzero(kept))


def test_a_setpoint_off_the_path_is_said():
    points = Lemniscate().sample(RATE, PERIOD)
    points[3] += 1e-3
    with pytest.raises(ValueError, match="setpoint 3 is no point of the path"):
        setpoint_numbers(points, Lemniscate(), RATE, PERIOD)


def test_no_setpoint_is_said():
    with pytest.raises(ValueError, match="no setpoint"):
        lap_of(NOTHING, Circle(), RATE, PERIOD, 1)
