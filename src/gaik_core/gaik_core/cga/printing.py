"""Multivectors as text, and text as multivectors.

What is printed, `1.5 + 2*e12 - e45`, reads back to the same numbers; it is also valid Python where the blades are
names. In the null basis the same multivector is written by e0 = (e5 - e4)/2 and einf = e4 + e5, the way conformal
points are read: `e1 + e0 + 0.5*einf`. Both forms can be parsed.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from gaik_core.arrays import Array
from gaik_core.cga.basis import BLADES, E4, E5, E45, NAMES, BladeNameError, blade_index_and_sign
from gaik_core.cga.products import OUTER, product
from gaik_core.errors import GaikError

_EUCLIDEAN_BLADES = 8
_ORDER = sorted(range(BLADES), key=lambda index: (index.bit_count(), NAMES[index]))
_EUCLIDEAN_ORDER = [index for index in _ORDER if index < _EUCLIDEAN_BLADES]

_NUMBER = re.compile(r"(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|nan|inf")
_FACTOR = re.compile(r"e(?:inf|0|[1-9]+)")


class ParseError(GaikError):
    """Text that is no multivector; the message shows where."""


def to_text(x: Array, spec: str = "", null_basis: bool = False) -> str:
    """One multivector `(32,)` as a sum of blades; `spec` formats each number (".3f"), else it is exact."""
    text = ""
    for name, value in _null_terms(x) if null_basis else _terms(x):
        number = format(abs(value), spec) if spec else _shortest(abs(value))
        if _is_zero(number):
            continue
        sign = "-" if value < 0.0 else "+"
        text += f" {sign} " if text else sign.strip("+")
        text += number if name == "1" else name if number == "1" else f"{number}*{name}"
    return text or "0"


def _terms(x: Array) -> Iterator[tuple[str, float]]:
    """Name and coefficient of each basis blade, by grade."""
    for index in _ORDER:
        yield NAMES[index], float(x[index])


def _null_terms(x: Array) -> Iterator[tuple[str, float]]:
    """Name and coefficient by e0 and einf: a e4 + b e5 = (b - a) e0 + (a + b)/2 einf, and e45 = -e0 ∧ einf."""
    for index in _EUCLIDEAN_ORDER:
        yield NAMES[index], float(x[index])
    for index in _EUCLIDEAN_ORDER:
        on_e4, on_e5 = float(x[index | E4]), float(x[index | E5])
        prefix = f"{NAMES[index]}^" if index else ""
        yield f"{prefix}e0", on_e5 - on_e4
        yield f"{prefix}einf", 0.5 * (on_e4 + on_e5)
        yield f"{prefix}e0^einf", -float(x[index | E45])


def _shortest(value: float) -> str:
    """The shortest digits that read back to the same number."""
    text = repr(value)
    return text.removesuffix(".0")


def _is_zero(number: str) -> bool:
    digits = number.lower().partition("e")[0]
    return "n" not in digits and not any(digit in digits for digit in "123456789")


def parse(text: str) -> Array:
    """The multivector `(32,)` that a sum such as "1.5 + 2*e12 - e1^einf" writes.

    A term is a number, a blade, or number*blade; a blade is e and digits (e12, e31 = -e13), e0, einf, or an outer
    product of such. "2e12" is the number 2·10¹², as everywhere. ParseError shows the place that cannot be read.
    """
    x, position = np.zeros(BLADES), 0
    while position < len(text.rstrip()) or position == 0:
        sign, position = _read_sign(text, position)
        term, position = _read_term(text, position)
        x += sign * term
    return x


def _read_sign(text: str, position: int) -> tuple[float, int]:
    start = _skip_spaces(text, position)
    if text[start : start + 1] in ("+", "-"):
        return (-1.0 if text[start] == "-" else 1.0), _skip_spaces(text, start + 1)
    if position > 0:
        raise _error(text, start, "+ or -")
    return 1.0, start


def _read_term(text: str, position: int) -> tuple[Array, int]:
    """A number, a blade, or both with a * between them."""
    term = np.zeros(BLADES)
    number = _NUMBER.match(text, position)
    if number is None:
        return _read_blade(text, position)
    after = _skip_spaces(text, number.end())
    if text[after : after + 1] != "*":
        term[0] = float(number.group())
        return term, number.end()
    term, end = _read_blade(text, _skip_spaces(text, after + 1))
    present = term != 0.0
    term[present] *= float(number.group())  # not the zeros, which nan or inf would make nan
    return term, end


def _read_blade(text: str, position: int) -> tuple[Array, int]:
    """Factors such as e12, e0 or einf, with ^ between them."""
    blade, position = _read_factor(text, position)
    while text[_skip_spaces(text, position) :].startswith("^"):
        factor, position = _read_factor(text, _skip_spaces(text, _skip_spaces(text, position) + 1))
        blade = product(OUTER, blade, factor)
    return blade, position


def _read_factor(text: str, position: int) -> tuple[Array, int]:
    match = _FACTOR.match(text, position)
    if match is None:
        raise _error(text, position, "a number or a blade such as e12, e0 or einf")
    try:
        return named_blade(match.group()), match.end()
    except BladeNameError as error:
        raise ParseError(f"cannot read {text!r}: {error}") from None


def named_blade(name: str) -> Array:
    """The components of e0, einf, or e with different digits from 1 to 5, of which the order gives the sign."""
    blade = np.zeros(BLADES)
    if name == "e0":
        blade[[E4, E5]] = -0.5, 0.5
    elif name == "einf":
        blade[[E4, E5]] = 1.0, 1.0
    else:
        index, sign = blade_index_and_sign(name)
        blade[index] = sign
    return blade


def _skip_spaces(text: str, position: int) -> int:
    while position < len(text) and text[position].isspace():
        position += 1
    return position


def _error(text: str, position: int, expected: str) -> ParseError:
    found = repr(text[position : position + 10]) if position < len(text) else "the end"
    return ParseError(f"cannot read {text!r}: at character {position} stands {found}; expected {expected}")
