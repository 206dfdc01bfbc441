"""Exponential and logarithm in G(4,1), on arrays `(…, 32)`.

A bivector is B = b₁ + b₂, two commuting blades with real squares λ₁ and λ₂ (G(4,1) has but one negative direction), so

    B² = s + Q,   s = λ₁ + λ₂,   Q = B ∧ B = 2 b₁ b₂,   Q² = t = 4 λ₁ λ₂,   Q B = 2 (λ₁ b₂ + λ₂ b₁)

and, with c = cosh √λ and s = sinh √λ / √λ of each,

    exp B = (c₁ + s₁ b₁)(c₂ + s₂ b₂) = c₁c₂ + ½ s₁s₂ Q + μ B + ν Q B.

This holds whether a λ is negative (a rotation), positive (a dilation) or zero (a translation), and B is never split:
the blades are not unique where λ₁ = λ₂. (The split: Roelfs and De Keninck, "Graded symmetry groups", 2021.)
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gaik_core.arrays import Array
from gaik_core.cga.basis import BLADES, GRADES, REVERSE
from gaik_core.cga.inverse import norm_squared
from gaik_core.cga.products import GEOMETRIC, product
from gaik_core.errors import GaikError

Complex = NDArray[np.complex128]

_BIVECTOR = (GRADES == 2).astype(float)
_QUADVECTOR = (GRADES == 4).astype(float)
_OTHERS = ((GRADES != 0) & (GRADES != 2)).astype(float)
_SINHC_SERIES = [1.0 / math.factorial(2 * k + 1) for k in range(10)]
_ACOSHC_SERIES = [4.0**k * math.factorial(k) ** 2 / math.factorial(2 * k + 1) for k in range(18)]


class LogarithmError(GaikError):
    """A multivector that has no logarithm here: no unit even versor, or one on the edge of the principal branch."""


def exp(x: Array) -> Array:
    """e^X: in closed form where X is a scalar plus a bivector, else by its series."""
    if np.any(x * _OTHERS):
        return exp_by_series(x)
    factor: Array = np.exp(x[..., :1])
    return factor * exp_bivector(x * _BIVECTOR)


def exp_bivector(b: Array) -> Array:
    """exp B = c₁c₂ + ½ s₁s₂ Q + μ B + ν Q B, of any bivector."""
    square = product(GEOMETRIC, b, b)
    q = square * _QUADVECTOR
    s, t = -norm_squared(b), norm_squared(q)
    larger = 0.5 * (s + np.copysign(np.sqrt(np.maximum(s * s - t, 0.0)), s))
    smaller = _divide(0.25 * t, larger, where_zero=0.0)
    c1, s1, c2, s2 = _cosh(larger), _sinhc(larger), _cosh(smaller), _sinhc(smaller)
    nu = _odd_difference(larger, smaller, s, t)
    mu = 0.5 * (s1 * c2 + s2 * c1) - nu * s
    result: Array = mu[..., None] * b + nu[..., None] * product(GEOMETRIC, q, b) * _BIVECTOR
    result += (0.5 * s1 * s2)[..., None] * q
    result[..., 0] += c1 * c2
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

    B² is a function of the even grades w = ⟨R⟩₀ + ⟨R⟩₄ = cosh √(B²), so log R = k(w) ⟨R⟩₂ with k = acosh w / √(w² - 1).
    The branch is the principal one: a motor's turn comes out in [0, 2π). Where w reaches -1 (a turn of 2π, R = -1)
    there is none, and LogarithmError says so; so it does where R is no unit even versor.
    """
    _check_unit_versor(r)
    quad, bivector = r * _QUADVECTOR, r * _BIVECTOR
    w, t, sinh_squared = r[..., 0], norm_squared(quad), -norm_squared(bivector)
    root = np.sqrt(t.astype(complex))
    mean, difference = _acoshc_mean_and_difference(
        w,
        t,
        _Root.of(w + root, sinh_squared + 2.0 * w * root),
        _Root.of(w - root, sinh_squared - 2.0 * w * root),
    )
    factor: Array = difference[..., None] * quad
    factor[..., 0] = mean
    logarithm: Array = product(GEOMETRIC, factor, bivector) * _BIVECTOR
    return logarithm


def _check_unit_versor(r: Array) -> None:
    """LogarithmError unless R is even and R R̃ = 1, as near as rounding can leave it for the size of its components."""
    excess = product(GEOMETRIC, r, r * REVERSE)
    excess[..., 0] -= 1.0
    tolerance = 1e-9 * np.maximum(1.0, np.sum(r * r, axis=-1))
    off = np.maximum(np.abs(excess).max(axis=-1), np.abs(r * (GRADES % 2)).max(axis=-1))
    if not np.all(off <= tolerance):
        raise LogarithmError("only a unit even versor has a logarithm here: R must be even and R R̃ = 1")


def _cosh(x: Array) -> Array:
    """cosh √x, which is cos √-x below zero."""
    root = np.sqrt(np.abs(x))
    return np.where(x >= 0.0, np.cosh(np.where(x >= 0.0, root, 0.0)), np.cos(root))


def _sinhc(x: Array) -> Array:
    """sinh √x / √x, which is sin √-x / √-x below zero and 1 at zero."""
    root = np.sqrt(np.abs(x))
    return _divide(
        np.where(x >= 0.0, np.sinh(np.where(x >= 0.0, root, 0.0)), np.sin(root)), root, where_zero=1.0
    )


def _odd_difference(larger: Array, smaller: Array, s: Array, t: Array) -> Array:
    """ν: the difference quotient of sinh √z / √z between z = s ± √t, without cancellation anywhere.

    It equals (s₂c₁ - s₁c₂) / 2 (λ₁ - λ₂), which is good while λ₁ and λ₂ differ; the quotient itself is where they are
    near each other; and where both are small its series in the numbers a + bQ.
    """
    series = _series(_SINHC_SERIES, s, np.ones_like(s), t)[1]
    apart = _sinhc(smaller) * _cosh(larger) - _sinhc(larger) * _cosh(smaller)
    apart = _divide(apart, 2.0 * (larger - smaller), where_zero=0.0)
    root = np.sqrt(np.maximum(t, 0.0))
    near = _divide(_sinhc(s + root) - _sinhc(s - root), 2.0 * root, where_zero=0.0)
    quotient = np.where(np.abs(larger - smaller) >= 0.5 * np.abs(larger), apart, near)
    return np.where(np.abs(larger) < 0.1, series, quotient)


class _Root(NamedTuple):
    """A value of √(B²), with its cosh and sinh."""

    value: Complex
    cosh: Complex
    sinh: Complex

    @classmethod
    def of(cls, cosh: Complex, sinh_squared: Complex) -> _Root:
        """The principal one: its imaginary part is in [0, π). From cosh alone, but near -1 sinh says more."""
        if np.any((cosh.imag == 0.0) & (cosh.real < 0.0) & (sinh_squared.real >= 0.0)):
            raise LogarithmError("no logarithm on the principal branch: the versor turns by 2π; -R has one")
        sinh = np.sqrt(sinh_squared)
        by_sinh = np.abs(cosh + 1.0) < 0.1
        value = np.where(by_sinh, np.log(np.where(by_sinh, cosh + sinh, 1.0)), np.arccosh(cosh))
        return cls(value, cosh, np.where(by_sinh, sinh, np.sinh(value)))


def _acoshc_mean_and_difference(w: Array, t: Array, u: _Root, v: _Root) -> tuple[Array, Array]:
    """k at z = w ± √t, as half the sum and as the difference quotient: k(w + Q) = mean + difference Q."""
    k_u, k_v = _divide(u.value, u.sinh, where_zero=1.0), _divide(v.value, v.sinh, where_zero=1.0)
    # with p, q = (u ± v)/2 the difference of cosh factors, and nothing cancels where u and v are near each other
    p, q = 0.5 * (u.value + v.value), 0.5 * (u.value - v.value)
    sp, sq = _divide(np.sinh(p), p, where_zero=1.0), _divide(np.sinh(q), q, where_zero=1.0)
    near = _divide(sp * np.cosh(q) - sq * np.cosh(p), u.sinh * v.sinh * sp * sq, where_zero=0.0)
    apart = _divide(k_u - k_v, u.cosh - v.cosh, where_zero=0.0)
    difference = np.where(np.abs(u.cosh - v.cosh) < 0.1, near, apart).real
    mean_series, difference_series = _series(_ACOSHC_SERIES, 0.5 * (1.0 - w), np.full_like(w, -0.5), t)
    small = np.maximum(np.abs(u.cosh - 1.0), np.abs(v.cosh - 1.0)) < 0.2
    mean = np.where(small, mean_series, (0.5 * (k_u + k_v)).real)
    return mean, np.where(small, difference_series, difference)


def _series(coefficients: list[float], a: Array, b: Array, t: Array) -> tuple[Array, Array]:
    """Σ cₙ (a + bQ)ⁿ in the commuting numbers x + yQ with Q² = t, by Horner; where it diverges it is not used."""
    x, y = np.zeros_like(a), np.zeros_like(a)
    with np.errstate(over="ignore", invalid="ignore"):
        for coefficient in reversed(coefficients):
            x, y = coefficient + a * x + t * b * y, a * y + b * x
    return x, y


def _divide(a: np.ndarray, b: np.ndarray, where_zero: float) -> np.ndarray:
    """a / b, and the limit given where b is zero."""
    zero = b == 0.0
    quotient: np.ndarray = np.where(zero, where_zero, a / np.where(zero, 1.0, b))
    return quotient
