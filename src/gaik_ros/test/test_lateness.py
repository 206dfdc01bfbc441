"""Lateness takes gain away, the derivative's first, and gives it back."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gaik_ros.lateness import MEMORY, MOST, SPAN, Lateness

DT = 1e-3
latenesses = st.floats(-1.0, 10.0)


def after(late, tolerated=0.004):
    lateness = Lateness(tolerated)
    lateness.note(late, DT)
    return lateness


@given(st.floats(-1.0, 0.004))
def test_up_to_what_is_tolerated_the_gains_are_full(late):
    assert (after(late).share, after(late).derivative_share) == (1.0, 1.0)


@given(latenesses, latenesses)
def test_the_later_the_less(one, other):
    earlier, later = sorted((one, other))
    assert after(later).share <= after(earlier).share
    assert after(later).derivative_share <= after(earlier).derivative_share


@given(latenesses)
def test_the_derivative_is_gone_before_the_rest_begins_to_fall(late):
    lateness = after(late)
    assert lateness.share == 1.0 or lateness.derivative_share == 0.0
    assert 0.0 <= lateness.derivative_share <= 1.0
    assert 0.0 < lateness.share <= 1.0


@given(st.floats(0.01, MOST))
def test_lateness_times_gain_is_bounded(late):
    assert late * after(late).share == pytest.approx(SPAN * 0.004)


def test_it_is_forgotten():
    lateness = after(1.0)
    assert lateness.worst == MOST
    steps = 0
    while lateness.derivative_share < 1.0:
        lateness.note(0.0, DT)
        steps += 1
    assert 0.5 * MEMORY < steps * DT < 5.0 * MEMORY
    assert lateness.share == 1.0
