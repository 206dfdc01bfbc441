"""Printing and reading back."""

import numpy as np
import pytest

from gaik_core.cga import Multivector, ParseError, blades, up
from gaik_core.cga.blades import e0, e1, e2, e3, e12, e45, einf


@pytest.mark.parametrize("exponent", [0, -30, 200])
def test_what_is_printed_reads_back_exactly(exponent):
    random = np.random.default_rng(1)
    for _ in range(50):
        x = Multivector(random.normal(size=32) * (random.random(32) < 0.4) * 10.0**exponent)
        assert Multivector.parse(str(x)) == x


def test_what_is_printed_is_python():
    x = 1.5 + 2 * e12 - e45 + 1e-7 * e3
    names = {name: getattr(blades, name) for name in dir(blades)}
    assert eval(str(x), {}, names) == x


def test_null_basis_reads_back():
    x = Multivector(np.random.default_rng(2).normal(size=32))
    assert Multivector.parse(x.to_text(null_basis=True)).isclose(x, rtol=1e-15, atol=1e-15)


@pytest.mark.parametrize(
    ("x", "text"),
    [
        (0 * e1, "0"),
        (e1 * 0 + 3, "3"),
        (-e1, "-e1"),
        (1.5 + 2 * e12 - e45, "1.5 + 2*e12 - e45"),
        (0.1 * e2 - 1e-20 * e3, "0.1*e2 - 1e-20*e3"),
    ],
)
def test_str(x, text):
    assert str(x) == text
    assert repr(x) == text


def test_points_in_the_null_basis():
    assert up([1, 0, -2]).to_text(null_basis=True) == "e1 - 2*e3 + e0 + 2.5*einf"
    assert ((e0 ^ einf) + (e12 ^ e0) - (e1 ^ e0 ^ einf)).to_text(
        null_basis=True
    ) == "e0^einf - e1^e0^einf + e12^e0"


def test_formats_round_and_drop_what_rounds_to_zero():
    x = 0.25 + e1 / 3 + 1e-9 * e2 - 100 * e3
    assert f"{x:.3f}" == "0.250 + 0.333*e1 - 100.000*e3"
    assert f"{x:.2e}" == "2.50e-01 + 3.33e-01*e1 + 1.00e-09*e2 - 1.00e+02*e3"


def test_arrays_print_as_lists():
    x = Multivector(np.eye(32)[1:4])
    assert str(x) == "[e1, e2, e12]"
    assert repr(x) == "Multivector (3,): [e1, e2, e12]"
    assert "..." in str(Multivector(np.zeros((1000, 32))))


@pytest.mark.parametrize(
    ("text", "x"),
    [
        ("e21", -e12),
        ("+2.5", e1 * 0 + 2.5),
        ("-e1+e1", 0 * e1),
        ("1e3*e1", 1000 * e1),
        (" 2 * e1 ^ e2 ", 2 * e12),
        ("e1^einf - .5*e0", (e1 ^ einf) - 0.5 * e0),
        ("2e12", e1 * 0 + 2e12),
    ],
)
def test_parse(text, x):
    assert Multivector.parse(text) == x


def test_infinite_coefficients_survive():
    components = np.zeros(32)
    components[3], components[9] = np.inf, -np.inf
    np.testing.assert_array_equal(Multivector.parse(str(Multivector(components))).components, components)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "character 0 stands the end"),
        ("  ", "stands the end"),
        ("e1 +", "character 4 stands the end"),
        ("e1 e2", "character 3 stands 'e2'; expected \\+ or -"),
        ("2*", "character 2 stands the end"),
        ("e11", "different digits from 1 to 5"),
        ("e6", "different digits from 1 to 5"),
        ("x", "character 0 stands 'x'; expected a number or a blade"),
        ("e1*2", "character 2 stands '\\*2'"),
        ("1 + 2*e1^", "stands the end"),
    ],
)
def test_bad_text_shows_the_place(text, message):
    with pytest.raises(ParseError, match=message):
        Multivector.parse(text)
