"""The schedule with a synthetic clock, and the thread with the real one."""

import threading
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ros_bench import wait_until

from gaik_ros.deadline_loop import DeadlineLoop, DeadlineSchedule, LoopThread
from gaik_ros.periods import PeriodWindow

T = 0.001


def started(rate=1000.0, **options):
    schedule = DeadlineSchedule(rate, **options)
    schedule.start(100.0)
    return schedule


def ticks_at(schedule, now):
    """All ticks that are due at `now`."""
    ticks = []
    while (dt := schedule.due(now)) is not None:
        ticks.append(dt)
    return ticks


def test_nothing_is_due_before_the_deadline_and_lateness_does_not_move_the_next():
    schedule = started()
    assert schedule.due(100.0005) is None
    assert schedule.due(100.0013) == pytest.approx(T)
    assert schedule.deadline == pytest.approx(100.002)


def test_a_short_lateness_is_caught_up_tick_by_tick():
    schedule = started(catch_up=0.05)
    assert ticks_at(schedule, 100.0205) == pytest.approx([T] * 20)
    assert schedule.skipped == 0


def test_a_long_stall_is_skipped_and_counted_and_dt_tells():
    schedule = started(catch_up=0.05)
    assert ticks_at(schedule, 100.2005) == pytest.approx([200 * T])
    assert schedule.skipped == 199
    assert ticks_at(schedule, 100.2016) == pytest.approx([T])


@given(st.lists(st.floats(0, 0.2), min_size=1, max_size=60), st.floats(0.5, 2000))
def test_the_sum_of_dt_keeps_up_with_the_clock_whatever_the_lateness(delays, rate):
    schedule, now, total, ticks = started(rate), 100.0, 0.0, 0
    for delay in delays:
        now += delay
        due = ticks_at(schedule, now)
        assert all(dt > 0.0 for dt in due)
        total, ticks = total + sum(due), ticks + len(due)
        elapsed = now - 100.0
        assert elapsed - 1.0 / rate - 1e-6 <= total <= elapsed + 1e-6
    assert ticks + schedule.skipped == round(total * rate)


@pytest.mark.parametrize("rate", [0.0, -5.0, float("nan")])
def test_a_rate_that_is_none_is_refused(rate):
    with pytest.raises(ValueError, match="rate"):
        DeadlineSchedule(rate)


def test_the_thread_makes_the_ticks_of_all_loops_at_their_rates():
    times = {200.0: [], 50.0: []}
    loops = [
        DeadlineLoop(rate, lambda dt, ticks=ticks: ticks.append(time.monotonic()))
        for rate, ticks in times.items()
    ]
    thread = LoopThread(loops)

    def keeps_up(loop):
        """Whether no tick is missing up to now; a loop that loses ticks falls behind for good."""
        ticks, now = times[loop.rate], time.monotonic()
        return len(ticks) + loop.schedule.skipped >= (now - ticks[0]) * loop.rate

    began = time.monotonic()
    thread.start()
    time.sleep(1.0)
    wait_until(lambda: all(keeps_up(loop) for loop in loops), "the loops do not keep up with the clock")
    thread.stop()
    elapsed = time.monotonic() - began
    for loop in loops:
        assert len(times[loop.rate]) + loop.schedule.skipped <= elapsed * loop.rate
    after = [len(ticks) for ticks in times.values()]
    time.sleep(0.1)
    assert [len(ticks) for ticks in times.values()] == after


def test_an_error_in_a_tick_ends_the_thread_and_is_told():
    told = threading.Event()

    def tick(dt):
        raise ZeroDivisionError

    thread = LoopThread([DeadlineLoop(100.0, tick)], on_error=lambda error: told.set())
    thread.start()
    assert told.wait(10.0)
    thread.stop()
    assert isinstance(thread.error, ZeroDivisionError)


def test_a_window_reports_periods_rate_and_overruns_and_begins_anew():
    window, now = PeriodWindow(0.01), 5.0
    for step in [0.01] * 98 + [0.025]:
        window.add(now)
        now += step
    window.add(now, skipped=3)
    report = window.take()
    assert report.ticks == 99
    assert report.periods.p50 == pytest.approx(0.01)
    assert report.periods.maximum == pytest.approx(0.025)
    assert report.overruns == 4
    assert report.rate == pytest.approx(99 / (0.98 + 0.025))
    assert window.take().ticks == 0
    assert window.all_overruns == 4
