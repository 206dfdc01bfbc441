"""The update rules, each against its own paper's recurrence written out in numpy, and their settings."""

import numpy as np
import pytest

from gaik_core import (
    RULES,
    Adam,
    AMSGrad,
    DampedLeastSquares,
    GradientDescent,
    KinematicChain,
    LevenbergMarquardt,
    Momentum,
    Nesterov,
    RMSProp,
    rule_by_name,
    solve,
)
from gaik_core.errors import GaikError, UnknownNameError

ARM = KinematicChain.load("arm3")
START, TARGET = np.array([0.2, 1.2, 0.4]), np.array([0.5, 0.45, 0.1])


def errors_and_jacobians(angles):
    return TARGET - ARM.forward(angles), ARM.jacobian(angles)


def descend(update, steps):
    """Iterates of a rule given as update(e, J, t) -> Δθ."""
    angles = [START]
    for t in range(1, steps + 1):
        angles.append(angles[-1] + update(*errors_and_jacobians(angles[-1]), t))
    return np.array(angles)


def moments(rate, beta1, beta2, epsilon, largest):
    m, v, top = np.zeros(3), np.zeros(3), np.zeros(3)

    def update(e, J, t):
        nonlocal m, v, top
        g = -J.T @ e
        m, v = beta1 * m + (1 - beta1) * g, beta2 * v + (1 - beta2) * g**2
        top = np.maximum(top, v)
        second = top if largest else v
        return -rate * (m / (1 - beta1**t)) / (np.sqrt(second / (1 - beta2**t)) + epsilon)

    return update


def heavy_ball(rate, share, look_ahead):
    v = np.zeros(3)

    def update(e, J, t):
        nonlocal v
        v = share * v - rate * (-J.T @ e)
        return share * v + rate * J.T @ e if look_ahead else v

    return update


def root_mean_square(rate, decay, epsilon):
    s = np.zeros(3)

    def update(e, J, t):
        nonlocal s
        g = -J.T @ e
        s = decay * s + (1 - decay) * g**2
        return -rate * g / (np.sqrt(s) + epsilon)

    return update


def damped(square):
    def update(e, J, t):
        return J.T @ np.linalg.solve(J @ J.T + square(e, J) * np.eye(3), e)

    return update


def best_step(e, J, t):
    f = J @ J.T @ e
    return (e @ f) / (f @ f) * J.T @ e


CASES = [
    (GradientDescent(0.3), lambda e, J, t: 0.3 * J.T @ e),
    (GradientDescent(), best_step),
    (Momentum(0.2, 0.7), heavy_ball(0.2, 0.7, False)),
    (Nesterov(0.2, 0.7), heavy_ball(0.2, 0.7, True)),
    (RMSProp(0.02, 0.8), root_mean_square(0.02, 0.8, 1e-8)),
    (Adam(), moments(0.05, 0.9, 0.999, 1e-8, False)),
    (AMSGrad(0.05, 0.5, 0.6), moments(0.05, 0.5, 0.6, 1e-8, True)),
    (DampedLeastSquares(0.1), damped(lambda e, J: 0.01)),
    (LevenbergMarquardt(1.0, 1e-3), damped(lambda e, J: 0.5 * e @ e + 1e-3 * np.trace(J @ J.T) / 3)),
]


@pytest.mark.parametrize(("rule", "update"), CASES, ids=lambda case: type(case).__name__)
def test_is_the_recurrence_of_its_paper(rule, update):
    end = solve(ARM, TARGET, START, rule=rule, tolerance=1e-7, max_iterations=12, trace=True)
    assert end.iterations >= 3
    assert np.allclose(end.trace.angles, descend(update, end.iterations), atol=1e-9)


def test_all_rules_are_among_the_cases():
    assert {type(rule) for rule, _ in CASES} == set(RULES.values())


@pytest.mark.parametrize("name", RULES)
def test_every_rule_solves_table_1s_problem_by_its_defaults(name):
    assert solve(ARM, TARGET, START, rule=rule_by_name(name), max_iterations=2000).converged


def test_rules_are_settings_only_and_can_be_shared():
    rule = Adam()
    first = solve(ARM, TARGET, START, rule=rule)
    second = solve(ARM, TARGET, START, rule=rule)
    assert np.array_equal(first.angles, second.angles) and rule == Adam()
    with pytest.raises(AttributeError):
        rule.learning_rate = 1.0


def test_by_name_with_a_learning_rate_where_the_rule_has_one():
    assert rule_by_name("adam", 0.1) == Adam(0.1)
    assert rule_by_name("gradient_descent") == GradientDescent("auto")
    assert rule_by_name("levenberg_marquardt", 0.1) == LevenbergMarquardt()
    with pytest.raises(
        UnknownNameError, match=r"'adm' \(did you mean 'adam'\?\); known: gradient_descent, momentum"
    ):
        rule_by_name("adm")
    with pytest.raises(UnknownNameError, match="known: gradient_descent"):
        rule_by_name(["adam"])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: GradientDescent(0.0), "GradientDescent: learning_rate is 0.0"),
        (lambda: GradientDescent("fast"), "learning_rate is 'fast'"),
        (lambda: Adam(float("nan")), "Adam: learning_rate is nan"),
        (lambda: Adam(beta1=1.0), "beta1 is 1.0; expected a number at least 0 and below 1"),
        (lambda: Adam(epsilon=0), "epsilon is 0"),
        (lambda: Momentum(momentum=-0.1), "momentum is -0.1"),
        (lambda: Momentum(True), "learning_rate is True"),
        (lambda: DampedLeastSquares(-1), "damping is -1"),
        (lambda: LevenbergMarquardt(bias=0), "bias is 0"),
    ],
)
def test_bad_settings_are_named(make, message):
    with pytest.raises(GaikError, match=message.replace("(", r"\(")):
        make()
