"""Exponential of a bivector and logarithm of a versor of G(4,1).

A bivector is B = b₁ + b₂, two commuting blades with real squares λ₁ and λ₂ (G(4,1) has but one negative direction), so

    B² = s + Q,   s = λ₁ + λ₂,   Q = B ∧ B = 2 b₁ b₂,   Q² = t = 4 λ₁ λ₂,   Q B = 2 (λ₁ b₂ + λ₂ b₁)

and, with c = cosh √λ and s = sinh √λ / √λ of each,

    exp B = (c₁ + s₁ b₁)(c₂ + s₂ b₂) = c₁c₂ + ½ s₁s₂ Q + μ B + ν Q B.

This holds whether a λ is negative (a rotation), positive (a dilation) or zero (a translation). B is never split: its
blades are not unique where λ₁ = λ₂. (The split: Roelfs and De Keninck, "Graded symmetry groups", 2021.) The logarithm
goes the same way back: with k(cosh x) = x / sinh x,

    log R = k(⟨R⟩₀ + ⟨R⟩₄) ⟨R⟩₂ = (m + d ⟨R⟩₄) ⟨R⟩₂.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from gaik_core.kernels.compiled import compiled
from gaik_core.kernels.multivector import product

Array = NDArray[np.float64]

DONE, NO_UNIT_VERSOR, NO_LOGARITHM = 0, 1, 2
"""What `log_versor` returns."""

SINHC_SERIES = tuple(1.0 / math.factorial(2 * n + 1) for n in range(10))
"""sinh √z / √z in powers of z."""
K_SERIES = tuple(4.0**n * math.factorial(n) ** 2 / math.factorial(2 * n + 1) for n in range(18))
"""k(w) in powers of (1 - w)/2."""


@compiled
def exp_bivector(signs: Array, x: Array, out: Array) -> None:
    """out = exp X of a scalar plus a bivector B: e^⟨X⟩₀ (c₁c₂ + ½ s₁s₂ Q + μ B + ν Q B)."""
    b, q = np.empty(32), np.empty(32)
    keep_bivector(x, b)
    product(signs, b, b, q)
    keep_grade_four(q)
    one, half_quad, mu, nu = exp_coefficients(-norm_squared(b), norm_squared(q))
    product(signs, q, b, out)
    factor = math.exp(x[0])
    for i in range(32):
        out[i] = factor * (mu * b[i] + nu * out[i] if is_bivector(i) else half_quad * q[i])
    out[0] = factor * one


@compiled
def exp_coefficients(s: float, t: float) -> tuple[float, float, float, float]:
    """c₁c₂, ½ s₁s₂, μ and ν of B² = s + Q, Q² = t.

    ν is the difference quotient of sinh √z / √z between z = s ± √t. That equals (s₂c₁ - s₁c₂) / 2 (λ₁ - λ₂), which is
    good while λ₁ and λ₂ differ; the quotient itself where they are near each other; its series where both are small.
    """
    x, y = roots(s, 0.25 * t)
    c1, s1, c2, s2 = cosh_root(x), sinhc_root(x), cosh_root(y), sinhc_root(y)
    if abs(x) < 0.1:
        nu = series(SINHC_SERIES, s, 1.0, t)[1]
    elif abs(x - y) >= 0.5 * abs(x):
        nu = 0.5 * (s2 * c1 - s1 * c2) / (x - y)
    else:
        root = math.sqrt(t)
        nu = 0.5 * (sinhc_root(s + root) - sinhc_root(s - root)) / root
    return c1 * c2, 0.5 * s1 * s2, 0.5 * (s1 * c2 + s2 * c1) - nu * s, nu


@compiled
def log_versor(signs: Array, r: Array, out: Array) -> int:
    """out = log R, on the principal branch; returns DONE, or why there is none."""
    q, b = np.empty(32), np.empty(32)
    if not is_unit_even_versor(signs, r, out):
        return NO_UNIT_VERSOR
    keep_bivector(r, b)
    q[:] = r
    keep_grade_four(q)
    mean, difference, exists = log_coefficients(r[0], norm_squared(q), -norm_squared(b))
    if not exists:
        return NO_LOGARITHM
    for i in range(32):
        q[i] *= difference
    q[0] = mean
    product(signs, q, b, out)
    keep_bivector(out, out)
    return DONE


@compiled
def log_coefficients(w: float, t: float, square: float) -> tuple[float, float, bool]:
    """m and d, half the sum and the difference quotient of k at w ± √t, and whether they exist: not for R = -1.

    For w = ⟨R⟩₀ = c₁c₂, t = ⟨R⟩₄² and square = ⟨⟨R⟩₂²⟩₀. With a = sinh² √λ₁ and b = sinh² √λ₂, a b = t and
    a + b = square - 2t.
    """
    if abs(1.0 - w) + math.sqrt(abs(t)) < 0.2:
        mean, difference = series(K_SERIES, 0.5 * (1.0 - w), -0.5, t)
        return mean, difference, True
    larger, smaller = roots(square - 2.0 * t, t)
    a, b = max(larger, smaller), min(larger, smaller)
    if w <= 0.0 and b >= 0.0:
        return 0.0, 0.0, False
    if abs(a - b) < 0.5 * abs(larger):  # two rotations by nearly the same angle
        root = math.sqrt(t)
        k_plus, k_minus = angle_over_sine(w + root), angle_over_sine(w - root)
        return 0.5 * (k_plus + k_minus), 0.5 * (k_plus - k_minus) / root, True
    c1 = math.sqrt(1.0 + a)
    c2 = w / c1
    x, s1 = square_and_sinhc(a, c1)
    y, s2 = square_and_sinhc(b, c2)
    return (x * s1 * c2 - y * s2 * c1) / (a - b), (s1 * c2 - s2 * c1) / ((a - b) * s1 * s2), True


@compiled
def is_unit_even_versor(signs: Array, r: Array, work: Array) -> bool:
    """Whether R is even and R R̃ = 1, as near as rounding can leave it for the size of its components."""
    reverse, size = np.empty(32), 0.0
    for i in range(32):
        reverse[i] = -r[i] if is_bivector(i) else r[i]
        size += r[i] * r[i]
    product(signs, r, reverse, work)
    work[0] -= 1.0
    for i in range(32):
        off = max(abs(work[i]), abs(r[i]) if is_odd(i) else 0.0)
        if not off <= 1e-9 * max(1.0, size):  # not >: nan is no versor either
            return False
    return True


@compiled
def norm_squared(x: Array) -> float:
    """⟨X X̃⟩₀, with x4² - x5² as a product: in a motor far from the origin those two are large and equal."""
    total = 0.0
    for i in range(8):
        total += x[i] * x[i] - x[i + 24] * x[i + 24] + (x[i + 8] - x[i + 16]) * (x[i + 8] + x[i + 16])
    return total


@compiled
def roots(total: float, prod: float) -> tuple[float, float]:
    """Two real numbers by their sum and product, the one of larger magnitude first."""
    larger = 0.5 * (total + math.copysign(math.sqrt(max(total * total - 4.0 * prod, 0.0)), total))
    return larger, prod / larger if larger != 0.0 else 0.0


@compiled
def cosh_root(x: float) -> float:
    """cosh √x, which is cos √-x below zero."""
    return math.cosh(math.sqrt(x)) if x >= 0.0 else math.cos(math.sqrt(-x))


@compiled
def sinhc_root(x: float) -> float:
    """sinh √x / √x, which is sin √-x / √-x below zero and 1 at zero."""
    if x == 0.0:
        return 1.0
    root = math.sqrt(abs(x))
    return math.sinh(root) / root if x > 0.0 else math.sin(root) / root


@compiled
def square_and_sinhc(sinh_squared: float, cosh: float) -> tuple[float, float]:
    """λ and sinh √λ / √λ, from sinh² √λ and cosh √λ."""
    if sinh_squared == 0.0:
        return 0.0, 1.0
    sinh = math.sqrt(abs(sinh_squared))
    if sinh_squared > 0.0:
        value = math.asinh(sinh)
        return value * value, sinh / value
    value = math.atan2(sinh, cosh)
    return -value * value, sinh / value


@compiled
def angle_over_sine(cosine: float) -> float:
    """k(cos x) = x / sin x."""
    sine = math.sqrt(max((1.0 - cosine) * (1.0 + cosine), 0.0))
    return math.atan2(sine, cosine) / sine if sine > 0.0 else 1.0


@compiled
def series(coefficients: tuple[float, ...], a: float, b: float, t: float) -> tuple[float, float]:
    """Σ cₙ (a + bQ)ⁿ in the commuting numbers x + yQ with Q² = t, by Horner."""
    x, y = 0.0, 0.0
    for n in range(len(coefficients) - 1, -1, -1):
        x, y = coefficients[n] + a * x + t * b * y, a * y + b * x
    return x, y


@compiled
def keep_bivector(x: Array, out: Array) -> None:
    """out = ⟨X⟩₂."""
    for i in range(32):
        out[i] = x[i] if is_bivector(i) else 0.0


@compiled
def keep_grade_four(x: Array) -> None:
    """Zero every component but those of e1234, e1235, e1245, e1345 and e2345."""
    for i in range(32):
        if not (i == 15 or i == 23 or i == 27 or i == 29 or i == 30):
            x[i] = 0.0


@compiled
def is_bivector(i: int) -> bool:
    """Whether blade i has two factors: one bit is left when the lowest is gone."""
    rest = i & (i - 1)
    return i > 0 and rest > 0 and rest & (rest - 1) == 0


@compiled
def is_odd(i: int) -> bool:
    """Whether blade i has an odd number of factors."""
    return (i ^ i >> 1 ^ i >> 2 ^ i >> 3 ^ i >> 4) & 1 == 1


@compiled
def exp_rows(signs: Array, b: Array, out: Array) -> None:
    """The exponential of each row, arrays (m, 32)."""
    for row in range(out.shape[0]):
        exp_bivector(signs, b[row], out[row])


@compiled
def log_rows(signs: Array, r: Array, out: Array) -> int:
    """The logarithm of each row, arrays (m, 32); DONE, or why the first row that has none has none."""
    for row in range(out.shape[0]):
        status = log_versor(signs, r[row], out[row])
        if status != DONE:
            return status
    return DONE
