"""Where a target is not reached: the angles are the nearest found, and no joint winds up on the way."""

from dataclasses import replace

import numpy as np
import pytest
from chains import ALGEBRAS
from scipy.optimize import least_squares

from gaik_core import (
    RULES,
    GradientDescent,
    Joint,
    KinematicChain,
    LevenbergMarquardt,
    Momentum,
    Status,
    rule_by_name,
    solve,
    solve_path,
)

TWO_LINKS = KinematicChain([Joint("a", (0, 0, 1), (0.1, 0, 0)), Joint("b", (0, 0, 1), (0.06, 0, 0))])


def beyond(chain, rng, how_many):
    """Targets at one to two reaches."""
    directions = rng.normal(size=(how_many, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return chain.reach * rng.uniform(1.0, 2.0, (how_many, 1)) * directions


@pytest.mark.parametrize("algebra", ALGEBRAS)
@pytest.mark.parametrize("rule", RULES)
def test_no_iterate_was_nearer(rule, algebra):
    arm = KinematicChain.load("arm3")
    for target in beyond(arm, np.random.default_rng(1), 5):
        for most in (7, 300):
            end = solve(
                arm, target, rule=rule_by_name(rule), algebra=algebra, max_iterations=most, trace=True
            )
            assert not end.converged
            assert end.error == pytest.approx(end.trace.error.min(), rel=1e-12)
            assert (end.trace.angles == end.angles).all(axis=1).any()


@pytest.mark.parametrize("name", ["touch", "arm3", "arm5"])
def test_an_independent_descent_from_there_leads_hardly_nearer(name):
    chain = KinematicChain.load(name)
    left = []
    for target in beyond(chain, np.random.default_rng(2), 60):
        end = solve(chain, target, rule=LevenbergMarquardt())
        further = least_squares(lambda angles, t=target: chain.forward(angles) - t, end.angles)
        left.append(end.error - np.sqrt(2.0 * further.cost))
    assert np.mean(np.array(left) < 0.01 * chain.reach) > 0.9
    assert np.median(left) < 1e-4 * chain.reach


def test_two_links_stretch_toward_what_is_too_far():
    for angle in np.linspace(0.0, 2.0 * np.pi, 30):
        target = 0.25 * np.array([np.cos(angle), np.sin(angle), 0.0])
        end = solve(TWO_LINKS, target, [angle + 0.5, 0.3], rule=LevenbergMarquardt())
        assert end.status == Status.UNREACHABLE
        assert end.error == pytest.approx(0.25 - 0.16, rel=1e-5)


def test_a_trace_of_a_far_target_tells_the_distance_from_it():
    touch = KinematicChain.load("touch")
    end = solve(touch, [100.0, 0.0, 0.0], trace=True)
    tips = touch.forward(end.trace.angles)
    assert end.trace.error == pytest.approx(np.linalg.norm(tips - [100.0, 0.0, 0.0], axis=1), rel=1e-12)


@pytest.mark.parametrize("name", ["touch", "planar6", "arm3"])
def test_no_joint_winds_up(name):
    """The best step of the linearised arm is as long as one likes where the arm is nearly stretched."""
    chain = KinematicChain.load(name)
    rng = np.random.default_rng(3)
    for target in chain.forward(rng.uniform(-3.0, 3.0, (300, chain.dof))):
        end = solve(chain, target, rule=GradientDescent())
        assert np.abs(end.angles - chain.home).max() < 2.0 * np.pi


@pytest.mark.parametrize("rule", [GradientDescent(), LevenbergMarquardt()])
def test_a_path_through_the_hole_goes_on_behind_it(rule):
    x = np.linspace(0.12, -0.12, 13)
    targets = np.column_stack([x, np.full(13, 0.003), np.zeros(13)])
    start = solve(TWO_LINKS, targets[0], [0.3, -1.2], rule=rule, tolerance=1e-7).angles
    path = solve_path(TWO_LINKS, targets, start, rule=rule, tolerance=1e-5)
    inside = np.linalg.norm(targets, axis=1) < 0.04
    assert (path.status[inside] == Status.UNREACHABLE).all()
    assert path.converged[~inside].all()
    assert np.abs(np.diff(path.angles, axis=0)).max() < np.pi


def test_a_descent_that_runs_away_is_not_held_off_by_limits():
    arm = KinematicChain.load("arm5")
    limited = KinematicChain([replace(joint, lower=-2.5, upper=2.5) for joint in arm.joints])
    target = limited.forward(np.full(limited.dof, 0.1))
    assert solve(limited, target, rule=LevenbergMarquardt()).converged
    assert solve(limited, target, rule=Momentum()).status == Status.STAGNATED
