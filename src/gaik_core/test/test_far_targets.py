"""Targets that no angles reach: told by distances measured here, whatever the chain's reach or the tolerance."""

import numpy as np
import pytest
from chains import ALGEBRAS

from gaik_core import (
    Joint,
    KinematicChain,
    LevenbergMarquardt,
    Pointing,
    Pose,
    Status,
    solve,
    solve_batch,
    solve_path,
)

GIMBAL = KinematicChain([Joint("pan", (0, 0, 1)), Joint("tilt", (0, 1, 0))])
TINY = KinematicChain([Joint("a", (0, 0, 1), (2e-4, 0, 0)), Joint("b", (0, 0, 1), (2e-4, 0, 0))])
LIFT = KinematicChain([Joint("lift", (0, 0, 1), (0, 0, 0.1), kind="prismatic", lower=0.0, upper=0.5)])
RULE = LevenbergMarquardt()


@pytest.mark.parametrize("algebra", ALGEBRAS)
@pytest.mark.parametrize(
    ("chain", "target", "tolerance"),
    [
        (GIMBAL, [3.0, 0.0, 0.0], 5e-3),
        (TINY, [1.0, 0.0, 0.0], 5e-3),
        (KinematicChain.load("planar3"), [30.0, 0.0, 0.0], 28.5),
        (KinematicChain.load("arm5"), [0.0, 0.0, 1e12], 1.0),
    ],
)
def test_no_far_target_is_taken_for_reached(algebra, chain, target, tolerance):
    batch = solve_batch(chain, np.tile(target, (40, 1)), rule=RULE, tolerance=tolerance, algebra=algebra)
    along = solve_path(chain, [target], algebra=algebra, tolerance=tolerance)
    for end in (
        solve(chain, target, algebra=algebra, tolerance=tolerance),
        solve(chain, Pose(target), algebra=algebra, tolerance=tolerance, rule=RULE, restarts=2),
    ):
        assert end.status == Status.UNREACHABLE
        assert end.error == pytest.approx(np.linalg.norm(chain.forward(end.angles) - target), rel=1e-9)
    assert set(batch.status) == set(along.status) == {Status.UNREACHABLE}


def test_a_tolerance_wider_than_the_way_is_reached():
    end = solve(GIMBAL, [3.0, 0.0, 0.0], tolerance=3.5)
    assert end.converged and end.error == pytest.approx(3.0)


def test_without_limits_a_slide_goes_as_far_as_is_asked():
    for target in ([0.0, 0.0, 100.0], [0.0, 0.0, 2.0]):
        end = solve(LIFT, target, limits=False, rule=RULE)
        assert end.converged and np.allclose(LIFT.forward(end.angles), target, atol=5e-3)
        short = solve(LIFT, target, limits=False, rule=RULE, max_iterations=1)
        assert short.status == Status.ITERATION_LIMIT
        assert solve(LIFT, target, rule=RULE).status == Status.UNREACHABLE


def test_what_only_turns_is_pointed_all_the_same():
    direction = np.array([0.0, 1.0, 0.5]) / np.linalg.norm([0.0, 1.0, 0.5])
    end = solve(GIMBAL, Pointing([0, 0, 0], direction, tool_axis=[1, 0, 0]), rule=RULE)
    pan, tilt = end.angles
    forward = np.array([np.cos(pan) * np.cos(tilt), np.sin(pan) * np.cos(tilt), -np.sin(tilt)])
    assert end.converged and np.arccos(forward @ direction) < 1e-2
