"""Paths over time, and points from a file."""

import numpy as np
import pytest

from gaik_core.paths import Circle
from gaik_ros.point_file import PointFileError, read_points
from gaik_ros.trajectory import Progress, along_path, through_points


def test_a_lap_takes_its_time_and_repeats():
    circle, lap = Circle(radius=0.05), along_path(Circle(radius=0.05), 6.3)
    np.testing.assert_allclose(lap.once(0.0), circle.position(0.0))
    np.testing.assert_allclose(lap.once(6.3 / 4), circle.position(np.pi / 2), atol=1e-12)
    np.testing.assert_allclose(lap.looped(6.3 * 7 + 1.0), lap.once(1.0), atol=1e-9)
    np.testing.assert_allclose(lap.once(100.0), circle.position(0.0), atol=1e-12)
    assert not lap.done(6.29)
    assert lap.done(630 * 0.01)


def test_points_come_one_by_one_and_each_once_a_round():
    points = np.arange(15.0).reshape(5, 3)
    way = through_points(points, 100.0)
    times = np.cumsum([0.0] + [0.01] * 11)  # sums that round
    np.testing.assert_array_equal([way.looped(t) for t in times], np.tile(points, (3, 1))[:12])
    np.testing.assert_array_equal([way.once(t) for t in times[:7]], points[[0, 1, 2, 3, 4, 4, 4]])
    assert [way.done(t) for t in times[:6]] == [False] * 4 + [True] * 2


def test_a_single_point_is_a_trajectory_too():
    way = through_points([[1, 2, 3]], 10.0)
    assert way.done(0.0)
    np.testing.assert_array_equal(way.looped(12.3), [1, 2, 3])


CIRCLE, PERIOD = Circle(radius=0.05), 0.01


def walked(progress, steps, loop=True):
    return np.array([progress.step(PERIOD, loop) for _ in range(steps)])


def largest_step(points):
    return np.linalg.norm(np.diff(points, axis=0), axis=1).max()


@pytest.mark.parametrize("lap_time", [3.0, 7.0, 20.0])
@pytest.mark.parametrize("steps", [400, 630, 4000])  # in the first lap, at its end, and in a later one
def test_progress_goes_on_from_where_it_is_when_the_lap_time_changes(steps, lap_time):
    progress = Progress(along_path(CIRCLE, 6.3))
    points = walked(progress, steps)
    progress.change(along_path(CIRCLE, lap_time))
    points = np.concatenate([points, walked(progress, 500)])
    assert largest_step(points) < 1.01 * 2 * np.pi * 0.05 * PERIOD / min(lap_time, 6.3)


@pytest.mark.parametrize("steps", [250, 300])
def test_progress_that_loops_no_more_ends_with_the_lap_it_is_in(steps):
    progress = Progress(along_path(CIRCLE, 1.0))
    points = walked(progress, steps)
    assert not progress.done
    points = np.concatenate([points, walked(progress, 301 - steps, loop=False)])
    assert progress.done
    assert largest_step(points) < 1.01 * 2 * np.pi * 0.05 * PERIOD
    np.testing.assert_allclose(points[-1], CIRCLE.position(0.0), atol=1e-9)


def test_progress_through_points_says_each_once_a_round_and_begins_anew():
    points = np.arange(15.0).reshape(5, 3)
    progress = Progress(through_points(points, 100.0))
    np.testing.assert_array_equal(walked(progress, 12), np.tile(points, (3, 1))[:12])
    np.testing.assert_array_equal(walked(progress, 3, loop=False), points[2:])
    assert progress.done
    progress.restart()
    np.testing.assert_array_equal(walked(progress, 2), points[:2])


def write(tmp_path, text):
    path = tmp_path / "points.csv"
    path.write_text(text)
    return path


def test_columns_are_found_by_name(tmp_path):
    text = "# a comment\n t , Z, x,y\n\n0.1, 3, 1, 2e-1\n# more\n0.2,6,4,-5\n"
    np.testing.assert_array_equal(read_points(write(tmp_path, text)), [[1, 0.2, 3], [4, -5, 6]])


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("", "is empty"),
        ("x,y,z\n", "no points"),
        ("x,y\n1,2\n", "line 1: the columns x, y and z"),
        ("1,2,3\n4,5,6\n", "line 1: the columns x, y and z"),
        ("x,y,z\n1,2,3\n4,,6\n", "line 3: y is ''"),
        ("x,y,z\n1,2\n", "line 2: z is missing"),
        ("x,y,z\n\n1,nan,3\n", "line 3: y is 'nan'"),
        ("x,y,z\n1,2,abc\n", "line 2: z is 'abc'"),
    ],
)
def test_a_bad_file_is_refused_with_its_line(tmp_path, text, complaint):
    with pytest.raises(PointFileError, match=complaint) as refusal:
        read_points(write(tmp_path, text))
    assert "points.csv" in str(refusal.value)


def test_a_file_that_is_not_there_or_not_text_is_refused(tmp_path):
    with pytest.raises(PointFileError, match="cannot be read: No such file"):
        read_points(tmp_path / "none.csv")
    binary = tmp_path / "binary.csv"
    binary.write_bytes(b"\xff\xfe\x00\x81")
    with pytest.raises(PointFileError, match="cannot be read"):
        read_points(binary)
