"""Inverse velocity: exact where it can be, bounded where it cannot, and the paper's eq. 38."""

import numpy as np
import pytest
from chains import ALGEBRAS, random_chain

from gaik_core import KinematicChain, gradient_velocity
from gaik_core.errors import GaikError, NotFiniteError, ShapeError

TOUCH, PLANAR = KinematicChain.load("touch"), KinematicChain.load("planar2")
REGULAR = np.array([0.3, 0.6, 0.4])


@pytest.mark.parametrize("algebra", ALGEBRAS)
def test_moves_the_tip_as_asked_where_the_arm_can(algebra):
    wanted = np.array([0.05, -0.1, 0.08])
    rates = TOUCH.inverse_velocity(REGULAR, wanted, algebra)
    h = 1e-6
    moved = (TOUCH.forward(REGULAR + h * rates) - TOUCH.forward(REGULAR - h * rates)) / (2 * h)
    assert np.allclose(moved, wanted, atol=1e-9)


def test_redundant_arms_move_as_little_as_does_it():
    """The Moore-Penrose inverse: no part in the null space of J."""
    arm = random_chain(np.random.default_rng(0), 7)
    angles, wanted = arm.home + 0.4, np.array([0.1, 0.2, -0.1])
    rates = arm.inverse_velocity(angles, wanted)
    assert np.allclose(rates, np.linalg.pinv(arm.jacobian(angles)) @ wanted, atol=1e-12)


def test_bounded_at_a_singular_pose_and_on_the_way_there():
    wanted = np.array([0.0, 0.1, 0.0])
    for elbow in [0.0, *np.logspace(-12, -1, 60)]:
        rates = PLANAR.inverse_velocity([np.pi / 2, elbow], wanted)
        assert np.isfinite(rates).all() and np.abs(rates).max() < 0.1 / (0.02 * 0.1)


def test_continuous_through_a_singular_pose():
    rates = np.array(
        [PLANAR.inverse_velocity([1.0, e], [0.05, 0.1, 0.0]) for e in np.linspace(-0.3, 0.3, 6001)]
    )
    assert np.abs(np.diff(rates, axis=0)).max() < 0.05


def test_a_given_damping_is_wamplers():
    jacobian, wanted, damping = TOUCH.jacobian(REGULAR), np.array([0.1, 0.0, 0.2]), 0.03
    wampler = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + damping**2 * np.eye(3), wanted)
    assert np.allclose(TOUCH.inverse_velocity(REGULAR, wanted, damping=damping), wampler, atol=1e-12)


def test_what_no_joint_can_do_is_left_out():
    assert np.allclose(PLANAR.inverse_velocity([0.3, 0.5], [0.0, 0.0, 1.0]), 0.0)


def test_without_any_damping_it_is_the_pseudo_inverse_at_singular_poses_too():
    straight = KinematicChain.load("planar3")
    jacobian = straight.jacobian([0.7, 0.0, 0.0])
    rates = straight.inverse_velocity([0.7, 0.0, 0.0], [1.0, 1.0, 1.0], damping=0.0)
    assert np.allclose(rates, np.linalg.pinv(jacobian, rcond=1e-10) @ [1.0, 1.0, 1.0], atol=1e-9)


@pytest.mark.parametrize("algebra", ALGEBRAS)
def test_gradient_velocity_is_one_descent_step_per_period(algebra):
    """Eq. 38: β = α/Δt makes θ' Δt the step of eq. 34."""
    target, alpha, dt = np.array([0.05, 0.05, 0.0]), 20.0, 1e-3
    rates = gradient_velocity(TOUCH, REGULAR, target, alpha / dt, algebra)
    step = alpha * TOUCH.jacobian(REGULAR).T @ (target - TOUCH.forward(REGULAR))
    assert np.allclose(rates * dt, step, atol=1e-14)


def test_bad_arguments_are_named():
    with pytest.raises(ShapeError, match=r"velocity has shape \(2,\)"):
        TOUCH.inverse_velocity(REGULAR, [0, 0])
    with pytest.raises(NotFiniteError, match="velocity"):
        TOUCH.inverse_velocity(REGULAR, [0, np.nan, 0])
    for damping in (-1, np.nan, np.inf, "x"):
        with pytest.raises(GaikError, match=f"damping is {damping!r}; expected"):
            TOUCH.inverse_velocity(REGULAR, [0, 0, 0], damping=damping)
    for beta in (0.0, np.nan, "x", None):
        with pytest.raises(GaikError, match=f"beta is {beta!r}; expected a number above 0"):
            gradient_velocity(TOUCH, REGULAR, [0, 0, 0], beta)
    with pytest.raises(GaikError, match="chain is 'touch'; expected a KinematicChain; load one"):
        gradient_velocity("touch", REGULAR, [0, 0, 0], 1.0)
