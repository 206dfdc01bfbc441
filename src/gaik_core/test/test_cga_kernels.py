"""The compiled product, its plain Python, and the formula in whole arrays: one sum, one set of numbers."""

import numpy as np
import pytest

from gaik_core.cga import products
from gaik_core.kernels import multivector as kernels

TABLES = [
    "GEOMETRIC",
    "OUTER",
    "INNER",
    "LEFT_CONTRACTION",
    "RIGHT_CONTRACTION",
    "SCALAR_PRODUCT",
    "COMMUTATOR",
]


@pytest.mark.parametrize("name", TABLES)
def test_compiled_and_plain_give_the_same_bits(name):
    table, random = getattr(products, name), np.random.default_rng(1)
    a, b = random.normal(size=32), random.normal(size=32)
    a[random.integers(32, size=12)] = 0.0
    compiled, plain = np.empty(32), np.empty(32)
    kernels.product(table, a, b, compiled)
    getattr(kernels.product, "py_func", kernels.product)(table, a, b, plain)
    np.testing.assert_array_equal(compiled, plain)


@pytest.mark.parametrize("name", TABLES)
def test_rows_and_whole_arrays_agree(name):
    table, random = getattr(products, name), np.random.default_rng(2)
    a, b = random.normal(size=(4, 1, 32)), random.normal(size=(3, 32))
    whole = products.product_by_numpy(table, a, b)
    assert whole.shape == (4, 3, 32)
    np.testing.assert_allclose(products.product(table, a, b), whole, atol=1e-14)
    np.testing.assert_allclose(products.product(table, a[2, 0], b[1]), whole[2, 1], atol=1e-14)


def test_views_that_are_not_contiguous():
    random = np.random.default_rng(3)
    a, b = random.normal(size=(32, 5)).T, random.normal(size=(5, 64))[:, ::2]
    expected = products.product_by_numpy(products.GEOMETRIC, a.copy(), b.copy())
    np.testing.assert_allclose(products.product(products.GEOMETRIC, a, b), expected, atol=1e-14)
    np.testing.assert_allclose(products.product(products.GEOMETRIC, a[0], b[0]), expected[0], atol=1e-14)
