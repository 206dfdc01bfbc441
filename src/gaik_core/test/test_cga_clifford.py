"""Every product and involution against the `clifford` package, on random multivectors and on every pair of blades."""

import numpy as np
import pytest

from gaik_core.cga import Multivector

clifford = pytest.importorskip("clifford", reason="the tests need the clifford package")

LAYOUT, _ = clifford.Cl(4, 1)
BITMAPS = np.array(
    LAYOUT._basis_blade_order.index_to_bitmap
)  # clifford orders blades by grade, we by their bits

BINARY = {
    "geometric": lambda a, b: a * b,
    "outer": lambda a, b: a ^ b,
    "inner": lambda a, b: a | b,
    "left_contraction": lambda a, b: a << b,
    "regressive": lambda a, b: a & b,
    "commutator": lambda a, b: a.commutator(b),
    "anticommutator": lambda a, b: a.anticommutator(b),
}
UNARY = {
    "reverse": lambda a: ~a,
    "conjugate": lambda a: a.conjugate(),
    "grade_involution": lambda a: a.gradeInvol(),
    "even": lambda a: a.even,
    "odd": lambda a: a.odd,
    "dual": lambda a: a.dual(),
    "inverse": lambda a: a.leftLaInv(),
}


def to_clifford(x):
    return LAYOUT.MultiVector(value=x.components[BITMAPS].copy())


def from_clifford(x):
    components = np.zeros(32)
    components[BITMAPS] = x.value
    return Multivector(components)


def random_multivectors(seed, count=20):
    return Multivector(np.random.default_rng(seed).normal(size=(count, 32)))


@pytest.mark.parametrize("name", BINARY)
def test_products_of_full_multivectors(name):
    for a, b in zip(random_multivectors(1), random_multivectors(2), strict=True):
        reference = from_clifford(BINARY[name](to_clifford(a), to_clifford(b)))
        np.testing.assert_allclose(getattr(a, name)(b).components, reference.components, atol=1e-12)


@pytest.mark.parametrize("name", BINARY)
def test_products_of_every_pair_of_blades(name):
    units = Multivector(np.eye(32))
    ours = getattr(units[:, None], name)(units)
    references = [to_clifford(unit) for unit in units]
    for i in range(32):
        for j in range(32):
            reference = from_clifford(BINARY[name](references[i], references[j]))
            np.testing.assert_array_equal(ours[i, j].components, reference.components)


@pytest.mark.parametrize("name", UNARY)
def test_functions_of_full_multivectors(name):
    for a in random_multivectors(3):
        reference = from_clifford(UNARY[name](to_clifford(a)))
        np.testing.assert_allclose(getattr(a, name)().components, reference.components, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("grade", range(6))
def test_grades(grade):
    for a in random_multivectors(4):
        np.testing.assert_array_equal(
            a.grade(grade).components, from_clifford(to_clifford(a)(grade)).components
        )


def test_norm():
    for a in random_multivectors(5):
        np.testing.assert_allclose(a.norm(), abs(to_clifford(a)), rtol=1e-10)
        np.testing.assert_allclose(a.norm_squared(), to_clifford(a).mag2(), rtol=1e-9, atol=1e-12)


def test_exp():
    for a in random_multivectors(6):
        small = 0.1 * a
        reference = from_clifford(to_clifford(small).exp())
        np.testing.assert_allclose(small.exp().components, reference.components, atol=1e-12)
