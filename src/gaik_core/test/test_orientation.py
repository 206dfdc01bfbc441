"""Targets with an orientation or a direction: met by both algebras, however written and whatever carries the arm."""

import numpy as np
import pytest
from chains import ALGEBRAS, random_chain

from gaik_core import (
    Adam,
    GradientDescent,
    Joint,
    KinematicChain,
    LevenbergMarquardt,
    Pointing,
    Pose,
    Quaternion,
    Rotor,
    solve,
)


def test_pose_and_pointing_are_met_by_both_algebras():
    rng = np.random.default_rng(2)
    chain = random_chain(rng, 7)
    options = {
        "tolerance": 1e-6,
        "orientation_tolerance": 1e-6,
        "rule": LevenbergMarquardt(),
        "restarts": 20,
    }
    for angles in rng.uniform(-2, 2, (10, 7)):
        position, orientation = chain.pose(angles)
        for algebra in ALGEBRAS:
            end = solve(chain, Pose(position, orientation), algebra=algebra, **options)
            found, turned = chain.pose(end.angles, algebra)
            assert end.converged and np.allclose(found, position, atol=1e-6)
            assert abs(turned @ orientation) == pytest.approx(1.0, abs=1e-10)


def test_an_orientation_may_be_a_quaternion_or_a_rotor():
    chain = random_chain(np.random.default_rng(4), 7)
    position, orientation = chain.pose(chain.home + 0.2)
    turned = Quaternion(orientation)
    for given in (turned, Rotor.from_quaternion(turned)):
        assert np.allclose(Pose(position, given).packed(), Pose(position, orientation).packed(), atol=1e-15)
        again = KinematicChain([Joint("a", (0, 0, 1))], orientation=given)
        assert np.allclose(again.pose([0.0])[1], orientation)


@pytest.mark.parametrize("travel", [1.0, 1e3, np.inf])
def test_a_slide_s_travel_does_not_make_a_pose_worth_less(travel):
    """Two slides carry four turns: what is reached does not hang on how far the slides might go."""
    slides = [
        Joint(name, axis, kind="prismatic", lower=-travel, upper=travel)
        for name, axis in (("x", (1, 0, 0)), ("y", (0, 1, 0)))
    ]
    turns = [
        Joint(f"t{i}", axis, (0.0, 0.0, 0.2))
        for i, axis in enumerate(((0, 0, 1), (0, 1, 0), (1, 0, 0), (0, 0, 1)))
    ]
    gantry = KinematicChain(slides + turns)
    rng = np.random.default_rng(6)
    ends = [
        solve(gantry, Pose(*gantry.pose(angles)), rule=Adam(), max_iterations=3000)
        for angles in rng.uniform(-1.0, 1.0, (40, 6))
    ]
    assert np.mean([end.converged for end in ends]) > 0.8


def test_a_quaternion_and_its_negative_are_one_orientation():
    chain = random_chain(np.random.default_rng(4), 7)
    position, orientation = chain.pose(chain.home + 0.2)
    ends = [solve(chain, Pose(position, q), rule=LevenbergMarquardt()) for q in (orientation, -orientation)]
    assert np.allclose(ends[0].angles, ends[1].angles, atol=1e-12)


@pytest.mark.parametrize("kind", ["pose", "pointing"])
def test_the_step_is_along_the_gradient_of_the_loss(kind):
    """Against central differences of ½ (|Δp|² + w² φ²), measured by the solver's own reported errors."""
    chain = random_chain(np.random.default_rng(8), 6)
    if kind == "pose":
        target = Pose([0.2, 0.1, 0.4], [0.5, -0.5, 0.1, 0.7])
    else:
        target = Pointing([0.2, 0.1, 0.4], [1.0, 2.0, -1.0], [0.0, 1.0, 1.0])

    def loss(angles):
        at = solve(chain, target, angles, max_iterations=0, orientation_weight=0.3)
        return 0.5 * (at.error**2 + (0.3 * at.orientation_error) ** 2)

    start, h = np.full(6, 0.1), 1e-6
    gradient = [(loss(start + e) - loss(start - e)) / (2 * h) for e in h * np.eye(6)]
    rule = GradientDescent(1e-3)
    one = solve(chain, target, start, rule=rule, max_iterations=1, orientation_weight=0.3)
    assert np.allclose((start - one.angles) / 1e-3, gradient, atol=1e-6)


def test_pointing_leaves_the_turn_about_the_tool_free():
    chain = random_chain(np.random.default_rng(6), 7)
    spin = Joint("spin", (0.0, 0.0, 1.0))
    arm = KinematicChain([*chain.joints, spin])
    position, _ = arm.pose(np.full(8, 0.3))
    end = solve(arm, Pointing(position, [0, 0, 1]), np.full(8, 0.1), rule=LevenbergMarquardt())
    assert end.converged and end.orientation_error < 1e-2
