"""From measured periods to a level, by thresholds that are parameters."""

import math

import pytest

from gaik_ros.health import ERROR, LOOP_PARAMETERS, OK, WARN, Health, loop_health, status_message, worst
from gaik_ros.parameters import ParameterSet, ParameterTable
from gaik_ros.periods import Percentiles, PeriodReport, TimeWindow

VALUES = ParameterTable("any", LOOP_PARAMETERS).defaults()


def report(rate=1000.0, p99=0.002, longest=0.003, ticks=1000):
    return PeriodReport(ticks, Percentiles(ticks, 1.0 / rate, p99, longest), 0, rate)


@pytest.mark.parametrize(
    ("measured", "level"),
    [
        (report(), OK),
        (report(rate=960.0), WARN),
        (report(rate=500.0), ERROR),
        (report(p99=0.03), WARN),
        (report(longest=0.5), ERROR),
        (report(ticks=0), ERROR),
    ],
)
def test_levels(measured, level):
    assert loop_health(measured, 1000.0, VALUES).level == level


def test_thresholds_are_parameters():
    strict = ParameterSet({**VALUES, "diagnostics.rate_warn": 0.9999})
    assert loop_health(report(rate=999.0), 1000.0, VALUES).level == OK
    assert loop_health(report(rate=999.0), 1000.0, strict).level == WARN


def test_a_slow_loop_is_not_told_off_for_its_own_period():
    assert loop_health(report(rate=10.0, p99=0.101, longest=0.102, ticks=10), 10.0, VALUES).level == OK


@pytest.mark.parametrize("rate", [0.01, 0.5, 2.0])
def test_a_loop_slower_than_the_reports_is_well_as_long_as_no_tick_is_missing(rate):
    period = 1.0 / rate
    one = report(rate, p99=period, longest=1.01 * period, ticks=1)
    assert loop_health(one, rate, VALUES).level == OK
    assert loop_health(report(rate, longest=1.6 * period, ticks=1), rate, VALUES).level == ERROR
    none = PeriodReport(0, Percentiles.of([]), 0, 0.0)
    assert loop_health(none, rate, VALUES, silence=1.9 * period).level == OK
    late = loop_health(none, rate, VALUES, silence=2.1 * period)
    assert (late.level, late.message) == (ERROR, "the loop does not run")


def test_the_worst_wins_and_says_why():
    assert worst([]) == (OK, "ok")
    assert worst([(WARN, "a"), (ERROR, "b"), (ERROR, "c")]) == (ERROR, "b; c")


def test_a_status_has_text_for_every_figure():
    status = status_message(
        "left/node: part", Health(WARN, "why", {"a": 0.1, "b": math.nan, "c": 3, "d": "x"})
    )
    assert [(pair.key, pair.value) for pair in status.values] == [
        ("a", "0.1"),
        ("b", "nan"),
        ("c", "3"),
        ("d", "x"),
    ]
    assert (status.level, status.name, status.message) == (WARN, "left/node: part", "why")


def test_percentiles():
    found = Percentiles.of([float(k) for k in range(101)])
    assert (found.count, found.p50, found.p99, found.maximum) == (101, 50.0, 99.0, 100.0)
    assert math.isnan(Percentiles.of([]).p99)


def test_a_window_gives_each_time_once_and_does_not_grow_without_end():
    window = TimeWindow(capacity=3)
    for k in range(5):
        window.add(float(k))
    assert window.take() == [2.0, 3.0, 4.0]  # the newest
    assert window.take() == []
