"""Redundant arms: what they do with the freedom that a target leaves them."""

import numpy as np
import pytest
from chains import ALGEBRAS, random_chain

from gaik_core import GradientDescent, Joint, KinematicChain, LevenbergMarquardt, Momentum, Motor, Pose, solve
from gaik_core.errors import GaikError, NotFiniteError, ShapeError

ARM = random_chain(np.random.default_rng(12), 7)
START = np.full(7, 0.2)


def null_space(jacobian):
    """Orthonormal columns that J maps to zero."""
    _, sigma, vt = np.linalg.svd(jacobian)
    return vt[np.count_nonzero(sigma > 1e-10) :].T


@pytest.mark.parametrize("rule", [LevenbergMarquardt(), GradientDescent(0.05), GradientDescent("auto")])
def test_no_step_has_a_part_in_the_null_space(rule):
    """Rules that step along Jᵀ(…): the arm does not drift in directions that do not help."""
    end = solve(ARM, ARM.forward(START + 0.5), START, rule=rule, max_iterations=8, trace=True)
    for angles, step in zip(end.trace.angles, np.diff(end.trace.angles, axis=0), strict=False):
        assert np.abs(null_space(ARM.jacobian(angles)).T @ step).max() < 1e-9
    assert end.iterations >= 3


@pytest.mark.parametrize("algebra", ALGEBRAS)
@pytest.mark.parametrize("kind", ["position", "pose"])
def test_with_a_posture_what_motion_remains_has_no_null_space_part(algebra, kind):
    rng = np.random.default_rng(3)
    options = {
        "rule": LevenbergMarquardt(),
        "tolerance": 1e-7,
        "orientation_tolerance": 1e-7,
        "algebra": algebra,
    }
    settled = 0
    for _ in range(20):
        goal, posture = START + rng.uniform(-0.4, 0.4, 7), START + rng.uniform(-0.3, 0.3, 7)
        target = ARM.forward(goal) if kind == "position" else Pose(*ARM.pose(goal))
        end = solve(ARM, target, START, posture=posture, **options)
        assert end.converged and end.error < 1e-7
        jacobian = ARM.jacobian(end.angles) if kind == "position" else ARM.geometric_jacobian(end.angles)
        remains = null_space(jacobian).T @ (posture - end.angles)
        settled += np.linalg.norm(remains) < 1e-3
        without = solve(ARM, target, START, **options)
        assert np.linalg.norm(posture - end.angles) <= np.linalg.norm(posture - without.angles) + 1e-6
    assert settled == 20


def test_a_posture_that_reaches_the_target_is_kept():
    posture = START + 0.3
    end = solve(ARM, ARM.forward(posture), START, rule=LevenbergMarquardt(), tolerance=1e-8, posture=posture)
    assert np.allclose(end.angles, posture, atol=1e-3)


def test_limits_hold_on_the_way_to_a_posture():
    joints = [Joint(j.name, j.axis, j.link, lower=-0.5, upper=0.9) for j in ARM.joints]
    arm = KinematicChain(joints)
    rng = np.random.default_rng(8)
    for _ in range(20):
        goal, posture = rng.uniform(-0.5, 0.9, 7), rng.uniform(-3, 3, 7)
        end = solve(arm, arm.forward(goal), rule=LevenbergMarquardt(), tolerance=1e-6, posture=posture)
        assert (end.angles >= arm.lower).all() and (end.angles <= arm.upper).all()
        assert end.converged == (end.error < 1e-6)


def test_an_arm_without_freedom_stays():
    touch = KinematicChain.load("touch")
    target = [0.03, 0.02, 0.01]
    with_posture = solve(touch, target, rule=LevenbergMarquardt(), tolerance=1e-9, posture=[1, 1, 1])
    without = solve(touch, target, rule=LevenbergMarquardt(), tolerance=1e-9)
    assert np.allclose(with_posture.angles, without.angles, atol=1e-6)


@pytest.mark.parametrize("rule", [Momentum(0.05), LevenbergMarquardt()])
def test_a_motor_is_a_pose(rule):
    position, orientation = ARM.pose(START + 0.3)
    motor = Motor.from_rotation_translation(orientation, position)
    by_motor = solve(ARM, motor, START, rule=rule, max_iterations=50)
    by_pose = solve(ARM, Pose(position, orientation), START, rule=rule, max_iterations=50)
    assert np.allclose(by_motor.angles, by_pose.angles, atol=1e-9)


def test_no_solve_ends_further_from_the_posture_for_having_preferred_it():
    """Of many solves, as bringing the tip back after a step undoes what was won only now and then."""
    chain, rule = KinematicChain.load("planar4"), LevenbergMarquardt()
    rng = np.random.default_rng(3)
    for angles, posture in rng.uniform(-1.5, 1.5, (200, 2, 4)):
        target = chain.forward(angles)
        alone = solve(chain, target, rule=rule, tolerance=1e-4)
        preferring = solve(chain, target, rule=rule, tolerance=1e-4, posture=posture, max_iterations=300)
        if alone.converged:
            apart = [np.linalg.norm(end.angles - posture) for end in (alone, preferring)]
            assert preferring.converged and apart[1] <= apart[0] + 1e-12
            assert preferring.iterations <= 300


@pytest.mark.parametrize("target", [ARM.forward(START), [90.0, 0.0, 0.0]], ids=["reached", "out of reach"])
def test_bad_postures_are_named(target):
    with pytest.raises(ShapeError, match=r"posture has shape \(2,\); expected \(7,\)"):
        solve(ARM, target, START, posture=[0, 0])
    with pytest.raises(NotFiniteError, match="posture"):
        solve(ARM, target, START, posture=np.full(7, np.nan))
    with pytest.raises(GaikError, match=r"posture is .* expected None with trace"):
        solve(ARM, target, START, posture=START, trace=True)
