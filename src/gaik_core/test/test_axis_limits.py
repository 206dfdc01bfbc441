"""Limits of axes that share joints hold at the start, at every iterate and at the end."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gaik_core import Adam, GradientDescent, Joint, KinematicChain, LevenbergMarquardt, solve

ROUNDING = 1e-11  # rad


def corner(factor, home=(0.0, 0.0)):
    """Two axes that share two joints; their limits leave a wedge of joint values with its corner at zero."""
    return KinematicChain(
        [
            Joint("a", (0, 0, 1), (0.3, 0, 0), home=home[0]),
            Joint("b", (0, 0, 1), (0.3, 0, 0), coupling={"a": 1.0}, axis_lower=-5.0, axis_upper=0.0, home=home[1]),
            Joint("m", (0, 0, 1), (0.1, 0, 0), passive=True, coupling={"a": 1.0, "b": factor}, axis_lower=0.0),
        ]
    )  # fmt: skip


def outside(chain, angles):
    """By how much any axis is outside its limits (rad); 0 where none is."""
    turned = chain.axis_angles(angles)
    return np.maximum(turned - chain.axis_upper, chain.axis_lower - turned).max(initial=0.0)


@settings(max_examples=60, deadline=None)
@given(
    st.sampled_from([1.1, 1.2, 1.5, 2.0, -1.0]),
    st.tuples(st.floats(-3, 3), st.floats(-3, 3)),
    st.tuples(st.floats(-0.6, 0.6), st.floats(-0.6, 0.6)),
    st.sampled_from([Adam(), LevenbergMarquardt(), GradientDescent()]),
)
def test_hold_at_every_iterate_whatever_the_start(factor, start, xy, rule):
    chain = corner(factor)
    traced = solve(chain, [*xy, 0.0], start=start, rule=rule, max_iterations=200, trace=True)
    assert outside(chain, traced.trace.angles) < ROUNDING
    restarted = solve(chain, [*xy, 0.0], start=start, rule=rule, max_iterations=200, restarts=5)
    assert outside(chain, restarted.angles) < ROUNDING


def test_a_home_outside_is_no_reason_to_refuse_a_chain():
    chain = corner(1.2, home=(2.0, 1.0))
    end = solve(chain, chain.forward([-1.0, 0.9]), rule=LevenbergMarquardt(), restarts=20)
    assert end.converged and outside(chain, end.angles) < ROUNDING


def test_limits_that_exclude_each_other_are_refused():
    with pytest.raises(ValueError, match="no joint values are found within their limits"):
        KinematicChain(
            [
                Joint("a", (0, 0, 1), (0.3, 0, 0), lower=-1.0, upper=1.0),
                Joint("m", (0, 0, 1), (0.1, 0, 0), passive=True, coupling={"a": 1.0}, axis_lower=2.0),
            ]
        )
