"""The products of G(4,1) on arrays `(…, 32)` that broadcast, each by its table of signs.

A product keeps, of the blade products e_i e_j = SIGNS[i, j] e_(i xor j), those of the grade that defines it. So each is
a table, zero where the product drops the term, and one formula serves them all.
"""

from __future__ import annotations

from types import FunctionType

import numpy as np

from gaik_core.arrays import Array
from gaik_core.cga.basis import BITS, BLADES, GRADES, PSEUDOSCALAR, REVERSE, SIGNS
from gaik_core.kernels import multivector as kernels

_left, _right = GRADES[:, None], GRADES[None, :]
_result = GRADES[BITS[:, None] ^ BITS]

GEOMETRIC: Array = SIGNS
OUTER: Array = np.where(_result == _left + _right, SIGNS, 0.0)
INNER: Array = np.where((_result == abs(_left - _right)) & (_left > 0) & (_right > 0), SIGNS, 0.0)
"""Hestenes' inner product: grade |r - s|, zero where either side is a scalar."""
LEFT_CONTRACTION: Array = np.where(_result == _right - _left, SIGNS, 0.0)
RIGHT_CONTRACTION: Array = np.where(_result == _left - _right, SIGNS, 0.0)
SCALAR_PRODUCT: Array = np.where(_result == 0, SIGNS, 0.0)
COMMUTATOR: Array = 0.5 * (SIGNS - SIGNS.T)
ANTICOMMUTATOR: Array = 0.5 * (SIGNS + SIGNS.T)

DUAL: Array = -SIGNS[::-1, PSEUDOSCALAR].copy()
"""The signs of X I⁻¹ = -X I: component k comes from component 31 - k."""


def product(table: Array, a: Array, b: Array) -> Array:
    """Σ table[i, j] a_i b_j e_(i xor j)."""
    if a.ndim == 1 and b.ndim == 1:
        out = np.empty(BLADES)
        kernels.product(table, a, b, out)
        return out
    shape = np.broadcast_shapes(a.shape, b.shape)
    a, b = np.broadcast_to(a, shape), np.broadcast_to(b, shape)
    if isinstance(kernels.product_rows, FunctionType):  # not compiled: a Python loop over rows would be slow
        return product_by_numpy(table, a, b)
    out = np.empty(shape)
    kernels.product_rows(table, a.reshape(-1, BLADES), b.reshape(-1, BLADES), out.reshape(-1, BLADES))
    return out


def sandwich(versor: Array, x: Array) -> Array:
    """V x Ṽ; of two single ones in one kernel, which takes half the time of two products."""
    if versor.ndim == 1 and x.ndim == 1:
        out = np.empty(BLADES)
        kernels.sandwich(GEOMETRIC, REVERSE, versor, x, out)
        return out
    return product(GEOMETRIC, product(GEOMETRIC, versor, x), versor * REVERSE)


def product_by_numpy(table: Array, a: Array, b: Array) -> Array:
    """The same sum by whole arrays: one term for each blade of a."""
    out = np.zeros(np.broadcast_shapes(a.shape, b.shape))
    for i in range(BLADES):
        source = BITS ^ i
        out += a[..., i, None] * (table[i, source] * b[..., source])
    return out


def dual(x: Array) -> Array:
    """X I⁻¹, with I = e12345."""
    return x[..., ::-1] * DUAL


def undual(x: Array) -> Array:
    """X I, which undoes `dual`."""
    return x[..., ::-1] * -DUAL


def regressive(a: Array, b: Array) -> Array:
    """A ∨ B, whose dual is B* ∧ A*, in Dorst's order ("Geometric Algebra for Computer Science", section 5.2)."""
    return undual(product(OUTER, dual(b), dual(a)))
