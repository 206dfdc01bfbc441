"""Exponential and logarithm in G(4,1), on arrays `(…, 32)`. The formulas stand in `gaik_core.kernels.exponential`."""

from __future__ import annotations

import math

import numpy as np

from gaik_core.arrays import Array
from gaik_core.cga.basis import BLADES, GRADES, SIGNS
from gaik_core.cga.products import GEOMETRIC, product
from gaik_core.errors import GaikError
from gaik_core.kernels import exponential as kernels

_OTHERS = np.flatnonzero((GRADES != 0) & (GRADES != 2))


class LogarithmError(GaikError):
    """A multivector that has no logarithm here: no unit even versor, or one on the edge of the principal branch."""


_REASONS = {
    kernels.NO_UNIT_VERSOR: "only a unit even versor has a logarithm here: R must be even and R R̃ = 1",
    kernels.NO_LOGARITHM: "no logarithm on the principal branch: the versor turns by 2π; -R has one",
}


def exp(x: Array) -> Array:
    """e^X: in closed form where X is a scalar plus a bivector, else by its series."""
    if x[..., _OTHERS].any():
        return exp_by_series(x)
    result = np.empty(x.shape)
    kernels.exp_rows(SIGNS, x.reshape(-1, BLADES), result.reshape(-1, BLADES))
    return result


def exp_by_series(x: Array) -> Array:
    """e^X of any multivector: X halved until it is small, Taylor's series, then squared as often."""
    size = float(np.max(np.sum(np.abs(x), axis=-1), initial=0.0))  # |XY| ≤ |X| |Y| in this norm
    if not math.isfinite(size):
        raise GaikError("exp of a multivector that has a NaN or an infinity")
    halvings = max(0, math.ceil(math.log2(size)) + 1) if size > 0.0 else 0
    x = x / 2.0**halvings
    one = np.zeros(BLADES)
    one[0] = 1.0
    result = np.broadcast_to(one, x.shape)
    for order in range(16, 0, -1):  # Horner; (1/2)^17 / 17! is below rounding
        result = one + product(GEOMETRIC, x, result) / order
    for _ in range(halvings):
        result = product(GEOMETRIC, result, result)
    return result


def log(r: Array) -> Array:
    """The bivector B with exp B = R, for a unit even versor R (R R̃ = 1): a motor, a dilator, any conformal rotor.

    The branch is the principal one: a motor's turn comes out in [0, 2π). A turn of exactly 2π (R = -1) is its edge and
    has no logarithm; LogarithmError says so, and so it does where R is no unit even versor.
    """
    result = np.empty(r.shape)
    status = kernels.log_rows(SIGNS, r.reshape(-1, BLADES), result.reshape(-1, BLADES))
    if status != kernels.DONE:
        raise LogarithmError(_REASONS[status])
    return result
