"""Products of full multivectors of G(4,1), by a table of signs: every product of the algebra is one table."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gaik_core.kernels.compiled import compiled

Array = NDArray[np.float64]


@compiled
def product(table: Array, a: Array, b: Array, out: Array) -> None:
    """out = Σ table[i, j] a_i b_j e_(i xor j), each array (32,); blades that `a` lacks cost nothing."""
    for k in range(32):
        out[k] = 0.0
    for i in range(32):
        factor = a[i]
        if factor != 0.0:
            for j in range(32):
                out[i ^ j] += table[i, j] * factor * b[j]


@compiled
def sandwich(table: Array, reverse: Array, versor: Array, x: Array, out: Array) -> None:
    """out = V x Ṽ by the geometric product's table and the signs of the reverse, each array (32,)."""
    half, reversed_versor = np.empty(32), np.empty(32)
    for k in range(32):
        reversed_versor[k] = reverse[k] * versor[k]
    product(table, versor, x, half)
    product(table, half, reversed_versor, out)


@compiled
def product_rows(table: Array, a: Array, b: Array, out: Array) -> None:
    """The product of each row of a with the same row of b, each array (m, 32)."""
    for row in range(out.shape[0]):
        product(table, a[row], b[row], out[row])
