"""The laws of G(4,1) on random full multivectors, at every grade."""

import pickle
from itertools import combinations_with_replacement

import numpy as np
import pytest

from gaik_core.cga import Multivector, NotInvertibleError, blades
from gaik_core.cga.blades import I, Ie, e0, e1, e2, e3, e4, e5, e12, e123, einf
from gaik_core.errors import GaikError

GRADES = range(6)


def random_multivectors(seed, shape=(50,)):
    return Multivector(np.random.default_rng(seed).normal(size=(*shape, 32)))


def random_blade(seed, grade):
    vectors = np.random.default_rng(seed).normal(size=(grade, 5))
    blade = Multivector.from_scalar(1.0)
    for v in vectors:
        blade = blade ^ v[0] * e1 + v[1] * e2 + v[2] * e3 + v[3] * e4 + v[4] * e5
    return blade


def allclose(a, b):
    scale = 1.0 + np.abs(a.components).max()
    return np.abs((a - b).components).max() < 1e-12 * scale


A, B, C = (random_multivectors(seed) for seed in (1, 2, 3))


# --- the basis -------------------------------------------------------------------------------------------------------


def test_basis_vectors_square_to_the_signature_and_anticommute():
    for vector, square in zip((e1, e2, e3, e4, e5), (1, 1, 1, 1, -1), strict=True):
        assert vector * vector == square
    for a, b in combinations_with_replacement((e1, e2, e3, e4, e5), 2):
        assert bool(a == b) or a * b == -(b * a)


def test_null_basis():
    assert e0 == (e5 - e4) / 2
    assert einf == e4 + e5
    assert e0 * e0 == 0
    assert einf * einf == 0
    assert (e0 | einf) == -1


def test_bit_i_of_an_index_is_the_factor_e_i_plus_1():
    for index in range(1, 32):
        name = "e" + "".join(str(bit + 1) for bit in range(5) if index >> bit & 1)
        blade = getattr(blades, name)
        np.testing.assert_array_equal(np.flatnonzero(blade.components), [index])
        product = Multivector.from_scalar(1.0)
        for digit in name[1:]:
            product = product * getattr(blades, f"e{digit}")
        assert product == blade


def test_names_take_any_order_and_its_sign():
    assert blades.e31 == -blades.e13
    assert blades.e312 == e123
    assert A.coefficient("e21")[0] == -A.coefficient("e12")[0]
    assert e12.coefficient("e12") == 1.0
    assert (e12 + 3).coefficient("1") == 3.0
    assert (I, Ie) == (blades.e12345, e123)


@pytest.mark.parametrize("name", ["e", "e6", "e11", "f1", "e0inf", ""])
def test_unknown_blades_are_named(name):
    with pytest.raises(GaikError, match="no basis blade"):
        e1.coefficient(name)
    with pytest.raises(AttributeError):
        getattr(blades, name)


def test_star_import_gives_nothing():
    names = {}
    exec("from gaik_core.cga.blades import *", names)
    assert "e1" not in names


# --- products --------------------------------------------------------------------------------------------------------


def test_geometric_product_is_associative_and_distributes():
    assert allclose((A * B) * C, A * (B * C))
    assert allclose(A * (B + C), A * B + A * C)
    assert allclose((A + B) * C, A * C + B * C)


def test_outer_product_is_associative_and_distributes():
    assert allclose((A ^ B) ^ C, A ^ (B ^ C))
    assert allclose(A ^ (B + C), (A ^ B) + (A ^ C))


@pytest.mark.parametrize("r", GRADES)
@pytest.mark.parametrize("s", GRADES)
def test_products_are_the_grades_of_the_geometric_product(r, s):
    """For every pair of grades, from the geometric product by projection, as Hestenes and Dorst define them."""
    a, b = A.grade(r), B.grade(s)
    product = a * b
    assert allclose(a ^ b, product.grade(r + s))
    assert allclose(a | b, product.grade(abs(r - s)) if r and s else 0 * product)
    assert allclose(a.left_contraction(b), product.grade(s - r))
    assert allclose(a.right_contraction(b), product.grade(r - s))
    np.testing.assert_allclose(a.scalar_product(b), product.scalar, atol=1e-12)


@pytest.mark.parametrize("r", GRADES)
@pytest.mark.parametrize("s", GRADES)
def test_outer_product_of_r_and_s_commutes_up_to_minus_one_to_the_rs(r, s):
    assert allclose(A.grade(r) ^ B.grade(s), (-1) ** (r * s) * (B.grade(s) ^ A.grade(r)))


def test_vector_times_anything_is_inner_plus_outer():
    """a X = a⌋X + a∧X: the law that the paper's library breaks above grade 1."""
    a = A.grade(1)
    assert allclose(a * B, a.left_contraction(B) + (a ^ B))
    assert allclose(B * a, B.right_contraction(a) + (B ^ a))


def test_commutator_is_no_outer_product_above_grade_one():
    assert allclose(A.grade(1).commutator(B.grade(1)), A.grade(1) ^ B.grade(1))
    assert e12.commutator(e3) == 0
    assert (e12 ^ e3) == e123


def test_commutator_and_anticommutator_make_the_product():
    assert allclose(A.commutator(B) + A.anticommutator(B), A * B)
    assert allclose(A.commutator(B), -B.commutator(A))


def test_commutator_satisfies_jacobi():
    jacobi = A.commutator(B.commutator(C)) + B.commutator(C.commutator(A)) + C.commutator(A.commutator(B))
    assert np.abs(jacobi.components).max() < 1e-10


def test_contractions_are_adjoint_to_the_outer_product():
    """(A ∧ B) * C = A * (B ⌋ C)."""
    np.testing.assert_allclose(
        (A ^ B).scalar_product(C), A.scalar_product(B.left_contraction(C)), rtol=1e-9, atol=1e-9
    )


def test_outer_product_of_dependent_vectors_is_zero():
    a, b = A.grade(1), B.grade(1)
    assert np.abs((a ^ b ^ (2.0 * a - 3.0 * b)).components).max() < 1e-13


def test_scalars_in_every_product():
    assert allclose(2 ^ A, 2 * A)
    assert allclose(A ^ 2, 2 * A)
    assert (A | 2 == 0).all()
    assert (2 | A == 0).all()
    assert allclose(Multivector.from_scalar(2.0).left_contraction(A), 2 * A)


# --- involutions, duals, norm ----------------------------------------------------------------------------------------


def test_involutions_of_products():
    assert allclose(~(A * B), ~B * ~A)
    assert allclose((A * B).grade_involution(), A.grade_involution() * B.grade_involution())
    assert allclose((A * B).conjugate(), B.conjugate() * A.conjugate())
    assert allclose(A.conjugate(), (~A).grade_involution())


@pytest.mark.parametrize("grade", GRADES)
def test_reverse_turns_the_factors_of_a_blade_round(grade):
    blade, turned = random_blade(7, grade), Multivector.from_scalar(1.0)
    for v in np.random.default_rng(7).normal(size=(grade, 5))[::-1]:
        turned = turned ^ v[0] * e1 + v[1] * e2 + v[2] * e3 + v[3] * e4 + v[4] * e5
    assert allclose(~blade, turned)


def test_grades_sum_to_the_whole():
    total = 0 * A
    for grade in GRADES:
        assert A.grade(grade).grades() == (grade,)
        total = total + A.grade(grade)
    assert (total == A).all()
    assert (A.even() + A.odd() == A).all()
    assert (A.grade(1, 3, 5) == A.odd()).all()


def test_dual_is_division_by_the_pseudoscalar():
    assert allclose(A.dual(), A * I.inverse())
    assert (A.dual().undual() == A).all()
    assert (A.dual().dual() == -A).all()
    for grade in GRADES:
        assert A.grade(grade).dual().grades() == (5 - grade,)


def test_dual_exchanges_outer_product_and_contraction():
    assert allclose((A ^ B).dual(), A.left_contraction(B.dual()))


def test_regressive_product_is_the_outer_product_of_duals():
    assert allclose(A.regressive(B).dual(), B.dual() ^ A.dual())
    assert allclose(A.regressive(B).regressive(C), A.regressive(B.regressive(C)))
    assert allclose(I.regressive(A), A)


def test_norm():
    np.testing.assert_allclose(A.norm_squared(), (A * ~A).scalar, rtol=1e-10)
    assert e5.norm_squared() == -1
    assert e5.norm() == 1
    assert (e0 + 0.5 * einf + e1).norm() == 0
    rotor = (0.3 * e12 + 0.1 * blades.e23).exp()
    np.testing.assert_allclose((5 * rotor).normalised().components, rotor.components, atol=1e-15)


def test_norm_of_a_product_of_versors():
    versor = Multivector.from_scalar(1.0)
    norms = 1.0
    for seed in range(4):
        factor = random_blade(seed, 1)
        versor, norms = versor * factor, norms * factor.norm()
    np.testing.assert_allclose(versor.norm(), norms, rtol=1e-12)


# --- inverse ---------------------------------------------------------------------------------------------------------


def test_inverse_of_any_multivector():
    assert np.abs((A * A.inverse() - 1).components).max() < 1e-11
    assert np.abs((A.inverse() * A - 1).components).max() < 1e-11
    assert allclose((A / B) * B, A)
    assert allclose(1 / A, A.inverse())


@pytest.mark.parametrize("grade", GRADES)
def test_inverse_of_blades(grade):
    blade = random_blade(grade, grade)
    assert allclose(blade * blade.inverse(), Multivector.from_scalar(1.0))


@pytest.mark.parametrize(
    "singular",
    [e0, einf, e1 + e5, 1 + e1, 1 - e4, 0 * e1, einf ^ e1, (1 + e1) * (2 + e12), e0 + 0.5 * einf + e1],
)
def test_what_has_no_inverse_says_so(singular):
    with pytest.raises(NotInvertibleError, match="no inverse"):
        singular.inverse()


def test_null_vectors_have_no_direction():
    with pytest.raises(NotInvertibleError, match="cannot be normalised"):
        einf.normalised()


def test_powers():
    assert allclose(A**3, A * A * A)
    assert allclose(A**-2 * A**2, 0 * A + 1)
    assert (A**0 == 1).all()


def test_projection_onto_a_blade():
    plane = e12 + 2.0 * blades.e13
    part = e1.project_onto(plane)
    assert allclose(part ^ plane, 0 * e1)
    assert allclose((e1 - part).left_contraction(plane), 0 * e1)


# --- arrays, scalars, comparison -------------------------------------------------------------------------------------


def test_products_broadcast():
    left, right = random_multivectors(4, (5, 1)), random_multivectors(5, (1, 7))
    product = left * right
    assert product.shape == (5, 7)
    assert allclose(product[3, 2], left[3, 0] * right[0, 2])
    assert (left ^ e1).shape == (5, 1)
    assert (e1 * random_multivectors(6, (0,))).shape == (0,)


def test_arrays_of_numbers_are_arrays_of_scalars():
    factors = np.arange(50.0)
    assert (factors * A == A * factors).all()
    np.testing.assert_array_equal((factors * A).components, factors[:, None] * A.components)
    np.testing.assert_array_equal((factors + A).components[:, 0], factors + A.components[:, 0])
    np.testing.assert_array_equal((factors - A).components, (-(A - factors)).components)
    np.testing.assert_array_equal((A / (1 + factors)).components, A.components / (1 + factors)[:, None])
    assert (np.float64(2) * e1 == 2 * e1) and (np.int64(2) * e1 == e1 * 2)


def test_sequence():
    assert len(A) == 50
    assert A[3] == Multivector(A.components[3])
    assert A[1:4].shape == (3,)
    assert A[A.scalar > 0].shape == ((A.scalar > 0).sum(),)
    assert len(list(A)) == 50
    assert sum([e1, e2, e3]) == e1 + e2 + e3
    for of_one in (len, iter, list):
        with pytest.raises(TypeError, match="no length"):
            of_one(e1)
    with pytest.raises(IndexError, match="cannot be indexed"):
        e1[0]
    with pytest.raises(IndexError):
        A[0, 0]


def test_equality_is_exact_and_isclose_is_not():
    assert (A == A).all()
    assert not (A == B).any()
    nudged = A * (1 + 1e-13)
    assert not (nudged == A).all()
    assert nudged.isclose(A).all()
    assert not (A + 1e-3).isclose(A).any()
    assert e1 != "e1"


def test_truth():
    assert e1
    assert not 0 * e1
    with pytest.raises(ValueError, match="ambiguous"):
        bool(A)


def test_values_are_frozen():
    source = np.arange(32.0)
    x = Multivector(source)
    source[:] = 0.0
    np.testing.assert_array_equal(x.components, np.arange(32.0))
    with pytest.raises(ValueError, match="read-only"):
        x.components[0] = 1.0
    with pytest.raises(AttributeError):
        x.components = source
    y = x
    y += 1
    assert x.scalar == 0.0


def test_pickle():
    assert (pickle.loads(pickle.dumps(A)) == A).all()


@pytest.mark.parametrize(
    ("call", "error"),
    [
        (lambda: Multivector(np.zeros(16)), GaikError),
        (lambda: Multivector(1.0), GaikError),
        (lambda: Multivector("text"), GaikError),
        (lambda: Multivector(np.zeros(32, complex)), GaikError),
        (lambda: Multivector.from_vector([1, 2]), GaikError),
        (lambda: e1 * "e2", TypeError),
        (lambda: e1 + None, TypeError),
        (lambda: [1] ^ e1, TypeError),
        (lambda: e1.outer("e2"), TypeError),
        (lambda: e1**0.5, TypeError),
    ],
)
def test_bad_input(call, error):
    with pytest.raises(error):
        call()


def test_nan_is_not_swallowed():
    x = np.zeros(32)
    x[3] = np.nan
    assert np.isnan((Multivector(x) * A[0]).components).any()
    assert np.isnan((A[0] * Multivector(x)).components).any()
