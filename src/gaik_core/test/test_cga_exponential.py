"""exp and log: against the exponential of matrices, and as inverses of each other over every kind of bivector."""

import numpy as np
import pytest

from gaik_core.cga import LogarithmError, Multivector, blades, exponential
from gaik_core.cga.basis import BITS, GRADES, SIGNS
from gaik_core.cga.blades import e0, e1, e2, e3, e12, e45, einf
from gaik_core.errors import GaikError

linalg = pytest.importorskip("scipy.linalg", reason="the tests need scipy")

E34 = blades.e34
ZERO = 0 * e12


def matrix_of(x):
    """The matrix of Y ↦ X Y."""
    return x.components[BITS[:, None] ^ BITS] * SIGNS[BITS[:, None] ^ BITS, BITS]


def exp_by_matrix(x):
    """Independent of ours: scipy's Padé approximant, applied to 1."""
    return linalg.expm(matrix_of(x))[:, 0]


def random_bivector(seed):
    return Multivector(np.random.default_rng(seed).normal(size=32) * (GRADES == 2))


BIVECTORS = {
    "zero": ZERO,
    "rotation": 0.7 * e12,
    "rotation, tiny": 1e-9 * e12,
    "rotation, nearly 2 pi": (np.pi - 1e-3) * e12,
    "translation": -0.5 * (3 * e1 - e2 + 2 * e3) * einf,
    "screw": 0.4 * e12 + 1.5 * e3 * einf,
    "screw, nearly a translation": 1e-7 * e12 + 1.5 * e3 * einf,
    "screw about a line off the origin": 0.4 * e12 + (0.3 * e1 - 0.2 * e2 + 0.7 * e3) * einf,
    "dilation": 0.6 * e45,
    "dilation and rotation": 0.6 * e45 + 1.1 * e12,
    "transversion": 0.3 * (e1 ^ e0),
    "two rotations": 0.9 * e12 + 0.4 * E34,
    "two rotations, equal": 0.8 * e12 + 0.8 * E34,
    "two rotations, nearly equal": 0.8 * e12 + (0.8 + 1e-8) * E34,
    "two rotations, tiny": 1e-5 * e12 + 2e-5 * E34,
    "boost in e5": 0.5 * blades.e15 + 0.2 * blades.e23,
    **{f"random {seed}": 0.6 * random_bivector(seed) for seed in range(12)},
}


@pytest.mark.parametrize("name", BIVECTORS)
def test_exp_of_bivectors(name):
    b = BIVECTORS[name]
    expected = exp_by_matrix(b)
    np.testing.assert_allclose(b.exp().components, expected, rtol=0, atol=1e-13 * np.abs(expected).max())


@pytest.mark.parametrize("name", BIVECTORS)
def test_log_undoes_exp(name):
    b = BIVECTORS[name]
    np.testing.assert_allclose(b.exp().log().components, b.components, rtol=0, atol=2e-12)


@pytest.mark.parametrize("size", [1.3, 2.5])
def test_exp_of_log_is_the_same_beyond_the_principal_branch(size):
    for seed in range(30):
        versor = (size * random_bivector(seed)).exp()
        scale = np.abs(versor.components).max()
        np.testing.assert_allclose(
            versor.log().exp().components, versor.components, rtol=0, atol=1e-11 * scale
        )


def test_exp_is_a_unit_even_versor():
    for seed in range(20):
        versor = random_bivector(seed).exp()
        assert versor.grades(1e-13) in ((0, 2, 4), (0, 2))
        size = np.sum(versor.components**2)
        np.testing.assert_allclose((versor * ~versor - 1).components, 0.0, atol=1e-14 * size)


def test_exp_of_scalar_plus_bivector_and_of_full_multivectors():
    random = np.random.default_rng(3)
    for x in (
        0.5 + 0.3 * random_bivector(1),
        Multivector(0.3 * random.normal(size=32)),
        e1 + e2 * 0.1,
        3 * e0 + e12,
    ):
        expected = exp_by_matrix(x)
        np.testing.assert_allclose(x.exp().components, expected, rtol=0, atol=1e-12 * np.abs(expected).max())


def test_closed_form_and_series_agree():
    for b in BIVECTORS.values():
        series = exponential.exp_by_series(b.components)
        np.testing.assert_allclose(b.exp().components, series, rtol=0, atol=1e-12 * np.abs(series).max())


def test_derivative_of_exp_at_zero_is_the_bivector():
    b, step = random_bivector(5), 1e-6
    slope = ((step * b).exp() - (-step * b).exp()) / (2 * step)
    np.testing.assert_allclose(slope.components, b.components, atol=1e-9)


def test_exp_of_commuting_bivectors_is_the_product():
    a, b = 0.3 * e12, 0.9 * E34
    assert (a + b).exp().isclose(a.exp() * b.exp())


def test_exp_stays_exact_far_from_the_origin():
    """A turn about an axis a kilometre away: the closed form has no cancellation to lose it by."""
    distance, half_angle = 1000.0, 0.3
    line = e12 + distance * e1 * einf
    versor = (half_angle * line).exp()
    expected = np.cos(half_angle) + np.sin(half_angle) * line
    np.testing.assert_allclose(versor.components, expected.components, rtol=1e-14, atol=1e-15)


def test_arrays():
    b = Multivector(np.stack([x.components for x in BIVECTORS.values()]))
    for single, exp, log in zip(b, b.exp(), b.exp().log(), strict=True):
        np.testing.assert_allclose(exp.components, single.exp().components, atol=1e-15)
        np.testing.assert_allclose(log.components, single.exp().log().components, atol=1e-15)
    assert b[:0].exp().shape == (0,)


def test_turns_of_up_to_two_pi_are_on_the_principal_branch():
    for half_angle in (1e-8, 1.0, np.pi / 2, 3.0, np.pi - 1e-9):
        np.testing.assert_allclose((half_angle * e12).exp().log().coefficient("e12"), half_angle, rtol=1e-12)
    beyond = (4.0 * e12).exp().log()
    np.testing.assert_allclose(beyond.coefficient("e12"), 4.0 - 2 * np.pi)


@pytest.mark.parametrize(
    ("x", "message"),
    [
        (e1, "unit even versor"),
        (2 + e12, "unit even versor"),
        (0 * e1, "unit even versor"),
        (1 + e45, "unit even versor"),
        (0 * e1 - 1, "turns by 2π"),
        (-(1 - 0.5 * e1 * einf), "turns by 2π"),
        (-(0.5 * e45).exp(), "turns by 2π"),
    ],
)
def test_what_has_no_logarithm_says_so(x, message):
    with pytest.raises(LogarithmError, match=message):
        x.log()


def test_exp_of_infinite_numbers_is_refused():
    with pytest.raises(GaikError, match="infinity"):
        Multivector(np.full(32, np.inf)).exp()
