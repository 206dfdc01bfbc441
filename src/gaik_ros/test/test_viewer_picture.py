"""What the viewer draws from what it hears: paths, errors over time, verdicts in words, the nodes' health."""

import math

import numpy as np
import pytest

from gaik_core import KinematicChain
from gaik_ros.continuous_ik import Answer, ContinuousIk, Result
from gaik_ros.health import ERROR, OK, STALE, WARN
from gaik_ros.verdict import Verdict, describe, verdict_message
from gaik_ros.viewer.board import SILENT, Board
from gaik_ros.viewer.picture import ERROR_WINDOW, FRESH, Picture
from gaik_ros.viewer.strip_chart import StripChart
from gaik_ros.viewer.trail import Trail
from gaik_ros.viewer.words import nearest_point, verdict_in_words

CHAIN = KinematicChain.load("touch_device")
ANGLES = np.array([0.2, 0.7, 0.9])
TIP = CHAIN.forward(ANGLES)


# trails


def test_a_trail_is_the_way_of_the_point():
    trail = Trail(step=1e-3, gap=0.02)
    way = [np.array([0.005 * k, 0.0, 0.0]) for k in range(5)]
    for point in way:
        trail.add(point)
    segments = trail.segments()
    np.testing.assert_array_equal(segments[:, 0], way[:-1])
    np.testing.assert_array_equal(segments[:, 1], way[1:])


def test_a_point_that_rests_adds_nothing_to_its_trail():
    trail = Trail()
    trail.add(TIP)
    trail.add(TIP + 0.01)
    version = trail.version
    for _ in range(1000):
        trail.add(TIP + 0.01 + 1e-5)
    assert trail.version == version
    assert len(trail.segments()) == 1


def test_a_jump_leaves_a_gap_in_a_trail():
    trail = Trail(gap=0.02)
    for x in (0.0, 0.01, 0.5, 0.51):
        trail.add(np.array([x, 0.0, 0.0]))
    np.testing.assert_array_equal(trail.segments()[:, :, 0], [[0.0, 0.01], [0.5, 0.51]])


def test_a_trail_forgets_its_oldest_points_and_can_be_cleared():
    trail = Trail(step=0.0, gap=10.0, capacity=10)
    for x in range(100):
        trail.add(np.array([x, 0.0, 0.0]))
    assert trail.segments()[:, 1, 0].tolist() == list(range(91, 100))
    trail.clear()
    assert trail.segments().shape == (0, 2, 3)


def test_a_trail_keeps_a_copy_of_each_point():
    trail, point = Trail(), np.zeros(3)
    trail.add(point)
    point += 0.01
    trail.add(point)
    point += 1.0
    np.testing.assert_allclose(trail.segments(), [[[0, 0, 0], [0.01, 0.01, 0.01]]])


# strip charts


def test_a_strip_chart_shows_its_window_relative_to_now():
    chart = StripChart(2, window=10.0)
    for second in range(100):
        chart.add(float(second), (second, -second))
    times, rising, falling = chart.columns(99.0)
    np.testing.assert_array_equal(times, np.arange(-10.0, 1.0))
    np.testing.assert_array_equal(rising, np.arange(89.0, 100.0))
    np.testing.assert_array_equal(falling, -rising)


def test_a_strip_chart_that_hears_no_more_empties():
    chart = StripChart(1, window=10.0)
    assert [column.size for column in chart.columns(0.0)] == [0, 0]
    chart.add(0.0, (1.0,))
    assert chart.columns(9.0)[0].tolist() == [-9.0]
    assert chart.columns(11.0)[0].size == 0


def test_a_strip_chart_wants_a_value_for_each_series():
    with pytest.raises(ValueError, match="1 values for 2 series"):
        StripChart(2, 1.0).add(0.0, (1.0,))


# the picture


def test_the_arm_is_drawn_where_the_device_is():
    picture = Picture(CHAIN)
    assert not picture.live(0.0)
    picture.hear_state(ANGLES, 1.0)
    np.testing.assert_array_equal(picture.angles, ANGLES)
    np.testing.assert_allclose(picture.tip, TIP, atol=1e-12)
    assert picture.live(1.0 + FRESH)
    assert not picture.live(1.1 + FRESH)


def test_both_errors_are_distances_of_the_tip():
    picture = Picture(CHAIN)
    picture.hear_state(ANGLES, 0.0)
    picture.hear_setpoint(TIP + np.array([0.003, 0.0, 0.004]), None)
    picture.hear_reference(ANGLES)
    picture.sample(0.1)
    _, to_setpoint, to_reference = picture.errors.columns(0.1)
    np.testing.assert_allclose(to_setpoint, [0.005])
    np.testing.assert_allclose(to_reference, [0.0], atol=1e-15)


def test_the_error_on_a_path_is_that_at_the_moment_of_the_setpoint():
    picture = Picture(CHAIN)
    picture.hear_setpoint(TIP, angles=ANGLES + 0.1)
    picture.hear_state(ANGLES, 0.0)  # a moment later the tip has come there
    picture.sample(0.0)
    picture.sample(0.1)
    _, to_setpoint, _ = picture.errors.columns(0.1)
    np.testing.assert_allclose(
        to_setpoint, [np.linalg.norm(CHAIN.forward(ANGLES + 0.1) - TIP), 0.0], atol=1e-12
    )


def test_there_is_no_error_where_there_is_nothing_to_compare():
    picture = Picture(CHAIN)
    picture.sample(0.0)
    picture.hear_setpoint(TIP, None)
    picture.sample(0.1)
    picture.hear_state(ANGLES, 0.1)
    picture.sample(0.2 + FRESH)  # the device is not heard any more
    _, *errors = picture.errors.columns(min(0.2 + FRESH, ERROR_WINDOW))
    assert np.isnan(errors).all()


def test_a_setpoint_that_is_none_is_not_drawn():
    picture = Picture(CHAIN)
    picture.hear_setpoint(TIP, None)
    picture.hear_setpoint(np.array([np.nan, 0.0, 0.0]), None)
    picture.hear_setpoint(np.array([np.inf, 0.0, 0.0]), None)
    np.testing.assert_array_equal(picture.setpoint, TIP)


def test_desired_and_followed_paths_are_two_and_are_cleared_together():
    picture = Picture(CHAIN)
    for turn in (0.0, 0.02, 0.04):
        picture.hear_state(ANGLES + np.array([turn, 0.0, 0.0]), 0.0)
    picture.hear_setpoint(TIP, None)
    assert len(picture.followed.segments()) == 2
    assert len(picture.desired.segments()) == 0
    picture.clear()
    assert len(picture.followed.segments()) == 0


# verdicts in words


def said(verdict):
    """The words for a verdict as it comes over the topic."""
    message = verdict_message("ik_node: setpoint", verdict)
    return verdict_in_words({pair.key: pair.value for pair in message.values}, message.message)


def solved(target, **changes):
    answer = ContinuousIk(CHAIN, "quaternion", default_rule(), 1e-6, 1000).solve(np.array(target), CHAIN.home)
    answer = Answer(**{**vars(answer), **changes})
    return said(Verdict(7, np.array(target), answer.result, describe(answer), 0, 42e-6, answer))


def default_rule():
    from gaik_core import LevenbergMarquardt

    return LevenbergMarquardt()


def test_a_setpoint_that_is_reached_is_said_with_place_accuracy_and_effort():
    words = solved([0.05, 0.05, 0.0], error=2.34e-7, iterations=3)
    assert (words.headline, words.good) == ("Reached", True)
    assert words.sentence == "(50.0, 50.0, 0.0) mm, to 0.2 µm: 3 updates in 42 µs."


def test_one_update_is_not_called_updates():
    assert "1 update in" in solved([0.05, 0.05, 0.0], iterations=1).sentence


def test_a_branch_that_was_refused_is_mentioned():
    assert "another branch was refused" in solved([0.05, 0.05, 0.0], branch_refused=True).sentence


def test_a_setpoint_out_of_reach_is_said_with_how_far():
    words = solved([0.0, 0.0, 0.9])
    assert (words.headline, words.good) == ("Out of reach", False)
    assert "(0.0, 0.0, 900.0) mm" in words.sentence
    distance = float(words.sentence.split("nearest found is ")[1].split(" mm")[0])
    from_first_axis = np.linalg.norm(np.array([0.0, 0.0, 0.9]) - CHAIN.frames(CHAIN.home)[0])
    assert distance >= 1e3 * (from_first_axis - CHAIN.reach) - 0.1


def test_a_limit_is_said_with_the_joint():
    words = solved([0.25, 0.0, -0.1])
    assert words.headline == "Held off by a limit"
    assert "waist" in words.sentence


def test_what_is_refused_or_waits_is_said_in_the_nodes_own_words():
    refused = said(
        Verdict(1, np.full(3, np.nan), Result.REFUSED, "refused, [nan]: every coordinate must be finite")
    )
    assert refused.headline == "Refused"
    assert refused.sentence == "Refused, [nan]: every coordinate must be finite."
    waiting = said(Verdict(1, np.zeros(3), Result.WAITING, "waiting for joint_states to start from"))
    assert (waiting.headline, waiting.good) == ("Waiting", False)


@pytest.mark.parametrize("result", Result)
def test_there_are_words_for_every_result(result):
    answer = Answer(result, CHAIN.home, np.zeros(3), 0.1, 5, "waist")
    words = said(Verdict(1, np.zeros(3), result, "because", 0, 1e-5, answer))
    assert words.good == (result is Result.REACHED)
    assert words.headline != "Verdict"


@pytest.mark.parametrize(
    "values", [{}, {"result": "reached"}, {"result": "splendid"}, {"result": "reached", "x": "a"}]
)
def test_a_verdict_of_another_make_is_given_as_its_message(values):
    words = verdict_in_words(values, "all is well")
    assert (words.headline, words.sentence) == ("Verdict", "all is well")


def test_the_nearest_point_is_drawn_only_where_the_setpoint_is_not_reached():
    picture = Picture(CHAIN)
    picture.hear_verdict({"nearest_x": "0.1", "nearest_y": "0.2", "nearest_z": "0.3"}, "")
    np.testing.assert_array_equal(picture.nearest, [0.1, 0.2, 0.3])
    picture.hear_verdict({"result": "reached"}, "")
    assert picture.nearest is None
    assert nearest_point({"nearest_x": "0.1"}) is None


# the board of nodes

LOOP = {"reached_hz": "999.5", "period_p50_s": "0.001", "period_p99_s": "0.0012", "period_max_s": "0.004"}


def test_the_board_shows_the_worst_of_a_node():
    board = Board(["left/pid_controller"], 60.0)
    board.hear("left/pid_controller: loop", OK, "999.5 Hz", LOOP, 0.0)
    assert (board.health(0.0)[0].level, board.health(0.0)[0].message) == (OK, "ok")
    board.hear("left/pid_controller: control", ERROR, "state lost", {}, 0.5)
    board.hear("left/pid_controller: topics", WARN, "2 publishers", {}, 0.5)
    (health,) = board.health(0.5)
    assert (health.level, health.message, health.rate) == (ERROR, "state lost", 999.5)


def test_a_node_that_falls_silent_is_shown_as_not_heard():
    board = Board(["pid_controller"], 60.0)
    assert board.health(0.0)[0].level == STALE
    board.hear("pid_controller: loop", OK, "fine", LOOP, 0.0)
    assert board.health(SILENT)[0].level == OK
    (gone,) = board.health(SILENT + 0.1)
    assert (gone.level, gone.message) == (STALE, "not heard")
    assert math.isnan(gone.rate)


def test_the_board_passes_over_other_nodes_and_other_namespaces():
    board = Board(["left/pid_controller"], 60.0)
    board.hear("right/pid_controller: loop", ERROR, "no", LOOP, 0.0)
    board.hear("pid_controller: loop", ERROR, "no", LOOP, 0.0)
    assert board.health(0.0)[0].message == "not heard"


def test_the_periods_of_a_loop_are_kept_for_the_plot():
    board = Board(["pid_controller"], 60.0)
    for second in range(3):
        board.hear("pid_controller: loop", OK, "", LOOP, float(second))
    board.hear("pid_controller: control", OK, "", {}, 2.5)
    times, p50, p99, longest = board.periods["pid_controller"].columns(2.0)
    assert times.tolist() == [-2.0, -1.0, 0.0]
    assert (p50[0], p99[0], longest[0]) == (0.001, 0.0012, 0.004)


def test_a_loop_of_another_make_leaves_gaps_in_the_plot():
    board = Board(["driver"], 60.0)
    board.hear("driver: loop", OK, "", {"reached_hz": "fast"}, 0.0)
    assert all(math.isnan(column[0]) for column in board.periods["driver"].columns(0.0)[1:])
    assert math.isnan(board.health(0.0)[0].rate)
