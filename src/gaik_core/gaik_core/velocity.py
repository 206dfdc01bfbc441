"""Inverse velocity kinematics (section 3.3)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gaik_core.chain import KinematicChain, no_chain
from gaik_core.checks import finite_vector, is_number, positive
from gaik_core.errors import GaikError

Array = NDArray[np.float64]

ROUNDING = 1e-12
"""Singular values below this share of the largest are zero but for rounding."""

NEAR_SINGULAR = 0.02
"""Singular values below this share of the largest are inverted more and more gently."""


def damped_pseudo_inverse(jacobian: Array, damping: float | None = None) -> Array:
    """Pseudo-inverse (d, r) of a Jacobian (r, d) that stays bounded at singular poses.

    With a `damping` λ in m, every singular value is inverted as σ / (σ² + λ²) (Wampler 1986); at 0 that is the
    Moore-Penrose inverse, which takes singular values under 1e-12 σ_max for zero. Without a damping, the inverse
    is exact but for singular values under ε = 0.02 σ_max, inverted as σ / ε², which is continuous and goes to zero
    (after Maciejewski and Klein 1988).

    Raises:
        GaikError: a negative or NaN damping.
    """
    u, sigma, vt = np.linalg.svd(jacobian, full_matrices=False)
    if damping is None:
        floor = NEAR_SINGULAR * sigma[0]
        gains = np.zeros_like(sigma)
        np.divide(sigma, np.maximum(sigma, floor) ** 2, out=gains, where=sigma > 0.0)
    else:
        damping = _damping(damping)
        gains = np.zeros_like(sigma)
        np.divide(sigma, sigma**2 + damping * damping, out=gains, where=sigma > ROUNDING * sigma[0])
    result: Array = (vt.T * gains) @ u.T
    return result


def _damping(given: float) -> float:
    if is_number(given) and 0.0 <= given < np.inf:
        return float(given)
    raise GaikError(f"damping is {given!r}; expected a finite number of at least 0, in m")


def gradient_velocity(
    chain: KinematicChain, angles: ArrayLike, target: ArrayLike, beta: float, algebra: str = "quaternion"
) -> Array:
    """Joint rates β 𝓛 J (dof,) in rad/s toward a target position (3,) in m (eq. 38), with β in 1/(m²·s).

    β = α/Δt makes one step of eq. 34 out of one period Δt. Its argument is a position error, not a velocity.

    Raises:
        GaikError: a β that is not above 0 and finite, or arguments that do not fit the chain.
    """
    if not isinstance(chain, KinematicChain):
        raise no_chain(chain)
    beta = positive("beta", beta)
    error = finite_vector("target", target, 3) - chain.forward(angles, algebra)
    result: Array = beta * (error @ chain.jacobian(angles, algebra))
    return result
