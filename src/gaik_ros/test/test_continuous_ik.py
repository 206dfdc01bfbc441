"""Answers for any target: on the branch, inside the limits, with an honest result."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gaik_core import GradientDescent, KinematicChain, LevenbergMarquardt, solve
from gaik_ros.continuous_ik import ContinuousIk, Result

TOUCH = KinematicChain.load("touch_device")
MARGIN = 1e-9


def ik(chain=TOUCH, rule=None, tolerance=1e-6):
    return ContinuousIk(chain, "quaternion", rule or LevenbergMarquardt(), tolerance, 1000)


def drawn(rng, inside=1.0):
    """Angles of the Touch inside its limits, or in the inner part of them."""
    waist, shoulder = 0.98 * inside * rng.uniform(-1, 1), 0.875 * (1 + inside * rng.uniform(-1, 1))
    return np.array([waist, shoulder, shoulder + 0.22 + 1.03 * inside * rng.uniform(-1, 1)])


def assert_inside(angles):
    axes = TOUCH.axis_angles(angles)
    assert (angles >= TOUCH.lower - MARGIN).all()
    assert (angles <= TOUCH.upper + MARGIN).all()
    assert (axes >= TOUCH.axis_lower - MARGIN).all()
    assert (axes <= TOUCH.axis_upper + MARGIN).all()


@pytest.mark.parametrize("rule", [LevenbergMarquardt(), GradientDescent()])
def test_every_reachable_point_is_reached_from_everywhere(rule):
    rng, solver = np.random.default_rng(0), ik(rule=rule)
    for _ in range(200):
        start, target = drawn(rng), TOUCH.forward(drawn(rng, 0.95))
        answer = solver.solve(target, start)
        assert answer.result is Result.REACHED
        assert answer.error < 1e-6
        assert np.linalg.norm(TOUCH.forward(answer.angles) - target) < 1e-6
        assert_inside(answer.angles)


@settings(deadline=None)
@given(st.lists(st.floats(-10, 10), min_size=3, max_size=3), st.integers(0, 1000))
def test_any_target_has_a_finite_answer_inside_the_limits(target, seed):
    start = drawn(np.random.default_rng(seed))
    answer = ik().solve(np.array(target), start)
    assert np.isfinite(answer.angles).all()
    assert_inside(answer.angles)
    assert answer.error == pytest.approx(np.linalg.norm(TOUCH.forward(answer.angles) - target))
    assert (answer.result is Result.REACHED) == (answer.error < 1e-6)
    before = np.linalg.norm(TOUCH.forward(start) - target)
    assert answer.error <= before + 1e-6  # never further away than it was


def test_beyond_reach_is_unreachable_with_the_nearest_point():
    cloud = TOUCH.forward(np.array([drawn(np.random.default_rng(k)) for k in range(20_000)]))
    for target in ([0.0, 0.0, 0.5], [0.2, 0.2, 0.1], [0.0, 5.0, 0.0], [0.0, 0.0, 9.0]):
        answer = ik().solve(np.array(target), TOUCH.home)
        assert answer.result is Result.UNREACHABLE
        nearest = np.linalg.norm(cloud - target, axis=1).min()
        assert answer.error <= nearest + 2e-3


def test_off_the_limits_says_which_joint():
    answer = ik().solve(TOUCH.forward([1.3, 0.9, 0.9]), TOUCH.home)  # the waist ends at 0.98
    assert answer.result is Result.LIMITED
    assert answer.joint == "waist"
    coupled = ik().solve(TOUCH.forward([0.0, 0.5, 2.0]), TOUCH.home)  # elbow less shoulder ends at 1.25
    assert coupled.result is Result.LIMITED
    assert "elbow" in coupled.joint


def test_the_branch_is_kept_where_a_plain_solve_would_leave_it():
    """A planar arm with its elbow up: wherever it can go straight to, its answer has the elbow up too."""
    chain, rng = KinematicChain.load("planar2"), np.random.default_rng(4)
    solver, flips = ik(chain, tolerance=1e-5), 0
    for _ in range(400):
        start, goal = (np.array([rng.uniform(-np.pi, np.pi), rng.uniform(0.1, 3.0)]) for _ in range(2))
        line = np.linspace(chain.forward(start), chain.forward(goal), 50)
        radii = np.linalg.norm(line - chain.frames(start)[0], axis=1) / chain.reach
        if radii.min() < 0.15 or radii.max() > 0.97:
            continue  # the straight line leaves the ring that the arm can reach, or grazes its edge
        target = chain.forward(goal)
        answer = solver.solve(target, start)
        assert answer.result is Result.REACHED
        assert answer.angles[1] == pytest.approx(goal[1], abs=1e-3)
        plain = solve(chain, target, start, rule=LevenbergMarquardt(), tolerance=1e-5)
        flips += plain.converged and abs(plain.angles[1] - goal[1]) > 1e-2
    assert flips > 0


def test_a_stream_never_jumps():
    rng, solver = np.random.default_rng(7), ik()
    angles = drawn(rng, 0.5)
    points = TOUCH.forward(drawn(rng, 0.5)) + np.linspace(0, 1, 400)[:, None] * (
        TOUCH.forward(drawn(rng, 0.5)) - TOUCH.forward(angles)
    )
    angles = solver.solve(points[0], angles).angles
    for point in points:
        answer = solver.solve(point, angles)
        assert np.abs(answer.angles - angles).max() < 0.05
        angles = answer.angles
