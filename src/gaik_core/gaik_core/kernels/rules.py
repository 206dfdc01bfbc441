"""One update of the angles by each rule: `step(angles, error, jacobian, state, settings)`.

`jacobian` is (r, d) and `error` (r,), with g = Jᵀ e the direction of descent (eqs. 34 and 53); a rule may spend them.
`state` is (SLOTS, d or more), zero when a solve begins; its meaning is the rule's own. `settings` are the numbers of
the class in `gaik_core.update_rules` that stands for the kernel.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from gaik_core.kernels.compiled import inlined

Array = NDArray[np.float64]

SLOTS = 7
"""Rows of a rule's state, and its fewest columns: the normal matrix of a pose fits, with a row below it."""

LONGEST_STEP = 0.25 * math.pi
"""How far a joint moves at most in an update whose length is chosen (rad or m): further, no linearisation holds."""

RAISE, LOWER = 4.0, 0.7
"""Of the damping, where the loss grew and where it fell: lowered much faster, the arm soon swings again."""

(
    GRADIENT_DESCENT,
    STEEPEST_DESCENT,
    MOMENTUM,
    NESTEROV,
    RMSPROP,
    ADAM,
    AMSGRAD,
    DAMPED,
    LEVENBERG_MARQUARDT,
) = range(9)


@inlined
def forget(state: Array) -> None:
    """What a solve begins with."""
    for k in range(state.shape[0]):
        for j in range(state.shape[1]):
            state[k, j] = 0.0


@inlined
def descent_direction(error: Array, jacobian: Array, joint: int) -> float:
    """One element of g = Jᵀ e."""
    total = 0.0
    for row in range(error.shape[0]):
        total += jacobian[row, joint] * error[row]
    return total


@inlined
def gradient_descent(angles: Array, error: Array, jacobian: Array, state: Array, settings: Array) -> None:
    """θ ← θ + α Jᵀ e (eqs. 34 and 53)."""
    for j in range(angles.shape[0]):
        angles[j] += settings[0] * descent_direction(error, jacobian, j)


@inlined
def steepest_descent(angles: Array, error: Array, jacobian: Array, state: Array, settings: Array) -> None:
    """θ ← θ + α Jᵀ e with α = e·f / f·f, f = J Jᵀ e: the best step of the linearised arm (Buss 2004, section 5).

    Where the arm bends away from its linearisation and the loss grows, α is halved, and let grow again as it falls:
    without that, a stretched arm under an unreachable target swings for ever. No joint moves further than LONGEST_STEP:
    where f nearly vanishes, the linearised arm would spin.
    """
    for j in range(angles.shape[0]):
        state[0, j] = descent_direction(error, jacobian, j)
    loss = 0.0
    for row in range(error.shape[0]):
        loss += error[row] * error[row]
    if state[2, 0] > 0.0 and loss > state[2, 0]:
        state[1, 0] += 1.0
    else:
        state[1, 0] = max(0.0, state[1, 0] - 0.5)
    state[2, 0] = loss
    along, square = 0.0, 0.0
    for row in range(error.shape[0]):
        f = 0.0
        for j in range(angles.shape[0]):
            f += jacobian[row, j] * state[0, j]
        along += error[row] * f
        square += f * f
    if square > 0.0:
        alpha = along / square * 0.5 ** state[1, 0]
        largest = 0.0
        for j in range(angles.shape[0]):
            largest = max(largest, abs(alpha * state[0, j]))
        if largest > LONGEST_STEP:
            alpha *= LONGEST_STEP / largest
        for j in range(angles.shape[0]):
            angles[j] += alpha * state[0, j]


@inlined
def momentum(angles: Array, error: Array, jacobian: Array, state: Array, settings: Array) -> None:
    """v ← μ v + α g, θ ← θ + v (Polyak 1964)."""
    for j in range(angles.shape[0]):
        state[0, j] = settings[1] * state[0, j] + settings[0] * descent_direction(error, jacobian, j)
        angles[j] += state[0, j]


@inlined
def nesterov(angles: Array, error: Array, jacobian: Array, state: Array, settings: Array) -> None:
    """v ← μ v + α g, θ ← θ + μ v + α g: the look-ahead form of Sutskever et al. 2013 with θ at the look-ahead point."""
    for j in range(angles.shape[0]):
        step = settings[0] * descent_direction(error, jacobian, j)
        state[0, j] = settings[1] * state[0, j] + step
        angles[j] += settings[1] * state[0, j] + step


@inlined
def rmsprop(angles: Array, error: Array, jacobian: Array, state: Array, settings: Array) -> None:
    """s ← ρ s + (1 - ρ) g², θ ← θ + α g / (√s + ε) (Hinton 2012)."""
    for j in range(angles.shape[0]):
        g = descent_direction(error, jacobian, j)
        state[0, j] = settings[1] * state[0, j] + (1.0 - settings[1]) * g * g
        angles[j] += settings[0] * g / (math.sqrt(state[0, j]) + settings[2])


@inlined
def adam(angles: Array, error: Array, jacobian: Array, state: Array, settings: Array) -> None:
    """Algorithm 1 of Kingma and Ba 2015; `state` keeps both moments and 1 - βᵗ of each."""
    for j in range(angles.shape[0]):
        g = descent_direction(error, jacobian, j)
        state[0, j] = settings[1] * state[0, j] + (1.0 - settings[1]) * g
        state[1, j] = settings[2] * state[1, j] + (1.0 - settings[2]) * g * g
    correct_bias(state, settings)
    for j in range(angles.shape[0]):
        angles[j] += (
            settings[0] * (state[0, j] / state[3, 0]) / (math.sqrt(state[1, j] / state[4, 0]) + settings[3])
        )


@inlined
def amsgrad(angles: Array, error: Array, jacobian: Array, state: Array, settings: Array) -> None:
    """Adam with the largest second moment so far (Reddi, Kale and Kumar 2018), its bias corrected as Adam's is."""
    for j in range(angles.shape[0]):
        g = descent_direction(error, jacobian, j)
        state[0, j] = settings[1] * state[0, j] + (1.0 - settings[1]) * g
        state[1, j] = settings[2] * state[1, j] + (1.0 - settings[2]) * g * g
        state[2, j] = max(state[2, j], state[1, j])
    correct_bias(state, settings)
    for j in range(angles.shape[0]):
        angles[j] += (
            settings[0] * (state[0, j] / state[3, 0]) / (math.sqrt(state[2, j] / state[4, 0]) + settings[3])
        )


@inlined
def correct_bias(state: Array, settings: Array) -> None:
    """Take 1 - βᵗ, by which the moments fall short after t updates, to its next value: u ← β u + (1 - β)."""
    state[3, 0] = settings[1] * state[3, 0] + (1.0 - settings[1])
    state[4, 0] = settings[2] * state[4, 0] + (1.0 - settings[2])


@inlined
def solve_normal(matrix: Array, vector: Array) -> None:
    """Solve A x = b in place for b (r,) and a symmetric positive definite A, the (r, r) corner of `matrix`."""
    n = vector.shape[0]
    for i in range(n):
        for j in range(i + 1):
            total = matrix[i, j]
            for k in range(j):
                total -= matrix[i, k] * matrix[j, k]
            matrix[i, j] = math.sqrt(total) if i == j else total / matrix[j, j]
    for i in range(n):
        for k in range(i):
            vector[i] -= matrix[i, k] * vector[k]
        vector[i] /= matrix[i, i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            vector[i] -= matrix[k, i] * vector[k]
        vector[i] /= matrix[i, i]


@inlined
def damped_step(
    angles: Array, error: Array, jacobian: Array, normal: Array, damping: float, relative: float
) -> None:
    """θ ← θ + Jᵀ (J Jᵀ + λ I)⁻¹ e, where λ = damping + relative · mean diagonal of J Jᵀ; `error` becomes (…)⁻¹ e."""
    rows, joints = error.shape[0], angles.shape[0]
    trace = 0.0
    for i in range(rows):
        for k in range(i + 1):
            total = 0.0
            for j in range(joints):
                total += jacobian[i, j] * jacobian[k, j]
            normal[i, k] = total
        trace += normal[i, i]
    if trace == 0.0:  # no joint can move the tip
        return
    for i in range(rows):
        normal[i, i] += damping + relative * trace / rows
    solve_normal(normal, error)
    for j in range(joints):
        angles[j] += descent_direction(error, jacobian, j)


@inlined
def damped_least_squares(angles: Array, error: Array, jacobian: Array, state: Array, settings: Array) -> None:
    """A constant damping λ² (Wampler 1986)."""
    damped_step(angles, error, jacobian, state, settings[0] * settings[0], 1e-12)


@inlined
def raised_damping(raised: float, square: float, last: float) -> float:
    """How many times its formula's value the damping is to be, by what it was and by |e|² now and an update ago.

    Both are zero when a solve begins.
    """
    return RAISE * raised if square > last > 0.0 else max(1.0, LOWER * raised)


@inlined
def levenberg_marquardt(angles: Array, error: Array, jacobian: Array, state: Array, settings: Array) -> None:
    """A damping that fades with the loss: λ = c ½ |e|² + a small multiple of J Jᵀ (Sugihara 2011).

    It is raised where the loss grew, and lowered again as it falls: without that the arm swings under a target out of
    reach, whose loss does not fade.
    """
    square = 0.0
    for row in range(error.shape[0]):
        square += error[row] * error[row]
    raised, last = state[SLOTS - 1, 0], state[SLOTS - 1, 1]
    raised = raised_damping(raised, square, last)
    state[SLOTS - 1, 0], state[SLOTS - 1, 1] = raised, square
    damped_step(angles, error, jacobian, state, raised * 0.5 * settings[0] * square, raised * settings[1])


@inlined
def step(rule: int, angles: Array, error: Array, jacobian: Array, state: Array, settings: Array) -> None:
    """Make one update by the rule's number."""
    if rule == GRADIENT_DESCENT:
        gradient_descent(angles, error, jacobian, state, settings)
    elif rule == STEEPEST_DESCENT:
        steepest_descent(angles, error, jacobian, state, settings)
    elif rule == MOMENTUM:
        momentum(angles, error, jacobian, state, settings)
    elif rule == NESTEROV:
        nesterov(angles, error, jacobian, state, settings)
    elif rule == RMSPROP:
        rmsprop(angles, error, jacobian, state, settings)
    elif rule == ADAM:
        adam(angles, error, jacobian, state, settings)
    elif rule == AMSGRAD:
        amsgrad(angles, error, jacobian, state, settings)
    elif rule == DAMPED:
        damped_least_squares(angles, error, jacobian, state, settings)
    else:
        levenberg_marquardt(angles, error, jacobian, state, settings)
