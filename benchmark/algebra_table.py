"""Write docs/algebra_comparison.md: the paper's MATLAB library, clifford, and gaik_core.cga, row by row.

What can be measured is measured here: of clifford and of ours by running them, of the MATLAB library's products by
putting its formulas on a geometric product known to be right. Its other rows say what stands in its code, which was
read at commit e73c7ea of github.com/iqedgarmg/conformal_library and is not copied.

    python benchmark/algebra_table.py [--out docs/algebra_comparison.md]
"""

from __future__ import annotations

import argparse
import math
import platform
import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import gaik_core.cga as cga
from gaik_core.cga import Multivector, blades
from gaik_core.versors import Motor

try:
    import clifford
    import scipy.linalg
    from clifford import g3c
    from clifford.tools.g3c.rotor_parameterisation import general_logarithm
except ImportError as missing:
    sys.exit(f"{missing.name} is not installed; pip install -r requirements-test.txt")

LAYOUT, _ = clifford.Cl(4, 1)
BITMAPS = np.array(LAYOUT._basis_blade_order.index_to_bitmap)
RANDOM = np.random.default_rng(1)


class Row(NamedTuple):
    """One property, and what each library has of it."""

    what: str
    matlab: str
    clifford: str
    ours: str


def to_clifford(x: Multivector) -> Any:
    """Ours as theirs, which orders the blades by grade."""
    return LAYOUT.MultiVector(value=x.components[BITMAPS].copy())


def from_clifford(x: Any) -> Multivector:
    """Theirs as ours."""
    components = np.zeros(32)
    components[BITMAPS] = x.value
    return Multivector(components)


# --- measuring -------------------------------------------------------------------------------------------------------

Binary = Callable[[Multivector, Multivector], Multivector]


def grade_pairs_right(product: Binary, grade: Callable[[int, int], int | None]) -> str:
    """Of the 36 pairs of grades, in how many the product is the part of a b that defines it."""
    right = 0
    for r in range(6):
        for s in range(6):
            a, b = (Multivector(RANDOM.normal(size=32)).grade(g) for g in (r, s))
            wanted = grade(r, s)
            expected = (a * b).grade(wanted) if wanted is not None else 0 * a
            right += bool(product(a, b).isclose(expected, atol=1e-12))
    return f"right for {right} of 36 pairs of grades"


def outer_grade(r: int, s: int) -> int:
    """The grade of the outer product."""
    return r + s


def inner_grade(r: int, s: int) -> int | None:
    """The grade of Hestenes' inner product; None where it is zero."""
    return abs(r - s) if r and s else None


def kept(product: Binary) -> str:
    """Whether 1e-5 e123 is still there in (1e-5 e12 + e1) e3."""
    result = product(1e-5 * blades.e12 + blades.e1, blades.e3)
    return "kept" if result.coefficient("e123") == 1e-5 else "dropped"


def by_clifford(product: Callable[[Any, Any], Any]) -> Binary:
    """A product of theirs on multivectors of ours."""
    return lambda a, b: from_clifford(product(to_clifford(a), to_clifford(b)))


def timed(what: str, theirs: Callable[[], object], ours: Callable[[], object]) -> Row:
    """A row of times per call: the best of 30 rounds of about 5 ms, theirs and ours by turns, after a warm-up."""
    counts = {
        call: max(1, int(5e-3 / min(seconds_of(call, 1), seconds_of(call, 1)))) for call in (theirs, ours)
    }
    best = {theirs: math.inf, ours: math.inf}
    for _ in range(30):
        for call, count in counts.items():
            best[call] = min(best[call], seconds_of(call, count))
    return Row(f"{what}, µs", "not run", f"{1e6 * best[theirs]:.3g}", f"{1e6 * best[ours]:.3g}")


def seconds_of(call: Callable[[], object], count: int) -> float:
    """Seconds per call."""
    start = time.perf_counter()
    for _ in range(count):
        call()
    return (time.perf_counter() - start) / count


def exp_error(exp: Callable[[Multivector], Multivector]) -> str:
    """The largest relative error over random bivectors, against scipy's exponential of the matrix of Y ↦ X Y."""
    worst = 0.0
    for _ in range(200):
        b = RANDOM.uniform(0.1, 2.0) * Multivector(RANDOM.normal(size=32)).grade(2)
        matrix = np.stack([(b * Multivector(unit)).components for unit in np.eye(32)], axis=-1)
        expected = scipy.linalg.expm(matrix)[:, 0]
        worst = max(worst, float(np.abs(exp(b).components - expected).max() / np.abs(expected).max()))
    return f"largest relative error {worst:.0e}"


def logs_right(log: Callable[[Multivector], Multivector]) -> str:
    """For how many random versors exp(log R) is R; or -R, which moves everything as R does."""
    right, up_to_sign = 0, 0
    for _ in range(200):
        versor = (RANDOM.uniform(0.1, 2.0) * Multivector(RANDOM.normal(size=32)).grade(2)).exp()
        again = log(versor).exp()
        right += bool(again.isclose(versor, rtol=1e-6))
        up_to_sign += bool(again.isclose(versor, rtol=1e-6) or again.isclose(-versor, rtol=1e-6))
    return f"exp(log R) is R for {right} of 200 conformal rotors, ±R for {up_to_sign}"


def log_of_clifford(r: Multivector) -> Multivector:
    """By its tools, which work in their own layout of the same blades."""
    return from_clifford(general_logarithm(g3c.layout.MultiVector(value=to_clifford(r).value)))


def round_trip(text_and_back: Callable[[Multivector], Multivector]) -> str:
    """How much is lost between printing and reading."""
    worst = 0.0
    for _ in range(50):
        x = Multivector(RANDOM.normal(size=32))
        worst = max(worst, float(np.abs((text_and_back(x) - x).components).max()))
    return "exact" if worst == 0.0 else f"to {worst:.0e}"


def parsed_by_clifford(text: str) -> Any:
    """What its parser reads, without its warning about parentheses."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return LAYOUT.parse_multivector(text)


def meeting_lines() -> tuple[str, str]:
    """Two lines in a plane, whose outer product vanishes."""
    p, q = cga.line([1.0, 2, 3], [0, 0, 0]), cga.line([1.0, 2, 3], [0, 1, 0])
    ours = cga.flat_point_position(cga.meet(p, q))
    theirs = from_clifford(to_clifford(p.undual()).meet(to_clifford(q.undual())))
    found = cga.flat_point_position(theirs.dual())
    theirs_found, ours_found = ("found" if np.allclose(x, [1, 2, 3]) else "not found" for x in (found, ours))
    return theirs_found, ours_found


# --- the table -------------------------------------------------------------------------------------------------------


def rows() -> list[Row]:
    """All rows, in the order of the page."""
    return [*algebra_rows(), *function_rows(), *geometry_rows(), *handling_rows(), *time_rows()]


def algebra_rows() -> list[Row]:
    """Building, sums and products."""
    commutator: Binary = lambda a, b: 0.5 * (a * b - b * a)  # noqa: E731 - the two formulas, side by side
    anticommutator: Binary = lambda a, b: 0.5 * (a * b + b * a)  # noqa: E731
    return [
        Row(
            "building",
            "`e1` … `e5`, `e12` … `e45`, `e0`, `ei` put into the workspace; grade 3 by `blades([1,2,3])`, of the same "
            "sign in any order; grades 4 and 5 by a mask only: `blades([1,2,3,4])` is zero",
            "a dict of blades, or star imports; any algebra",
            "`from gaik_core.cga.blades import e1, e312, e0, einf`, any order of digits with its sign; G(4,1) only",
        ),
        Row(
            "sum and difference with a number",
            "sum from both sides; difference has no branch for it, and there is no unary minus",
            "yes",
            "yes",
        ),
        Row("geometric product", "all grades", "all grades", "all grades"),
        Row(
            "coefficients of 1e-4 and less",
            "dropped from every product of more than one term",
            kept(by_clifford(lambda a, b: a * b)),
            kept(lambda a, b: a * b),
        ),
        Row(
            "outer product",
            "is ½(ab - ba): " + grade_pairs_right(commutator, outer_grade),
            grade_pairs_right(by_clifford(lambda a, b: a ^ b), outer_grade),
            grade_pairs_right(lambda a, b: a ^ b, outer_grade),
        ),
        Row(
            "inner product (Hestenes)",
            "is ½(ab + ba): " + grade_pairs_right(anticommutator, inner_grade),
            grade_pairs_right(by_clifford(lambda a, b: a | b), inner_grade),
            grade_pairs_right(lambda a, b: a | b, inner_grade),
        ),
        Row("left and right contraction", "none", "left", "both"),
        Row("regressive product", "none", "yes, `&`", "yes, the same sign"),
        Row("reverse, conjugate, grade involution, grades, dual", "none", "yes", "yes, and `undual`"),
    ]


def function_rows() -> list[Row]:
    """Norm, inverse, exp and log."""
    return [
        Row(
            "norm",
            "√ abs(a a), where `a*a` has one term",
            "√ abs ⟨A Ã⟩₀",
            "√ abs ⟨A Ã⟩₀, and `norm_squared`",
        ),
        Row("inverse and division", "none", "any invertible multivector", "any invertible multivector"),
        Row(
            "exp of a bivector",
            "none",
            "series: " + exp_error(lambda b: from_clifford(to_clifford(b).exp())),
            "closed form: " + exp_error(lambda b: b.exp()),
        ),
        Row("exp of any multivector", "none", "series", "series"),
        Row(
            "log",
            "none",
            "`general_logarithm` in `tools.g3c`: " + logs_right(log_of_clifford),
            logs_right(Multivector.log),
        ),
    ]


def geometry_rows() -> list[Row]:
    """Points, objects, motions."""
    theirs, ours = meeting_lines()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        conformal, _, stuff = clifford.conformalize(clifford.Cl(3)[0])
        infinite = "nan" if np.isnan(stuff["down"](conformal.einf).value).any() else "an error"
    return [
        Row("point up", "`euc2confpoint`, one", "`up`, one", "`up`, arrays (…, 3)"),
        Row(
            "point down", "the e1, e2, e3 coefficients: right at weight 1", "any weight", "any weight, arrays"
        ),
        Row("down of the point at infinity", "zero", infinite, "an error that says so"),
        Row(
            "lines, planes, spheres, circles, point pairs",
            "none",
            "outer products; classes `Round` and `Flat` in `clifford.cga`",
            "from points and from parameters, arrays; and the parameters back",
        ),
        Row("meet of two lines in a plane", "none", theirs, ours),
        Row("join", "none", "of blades", "of blades, and of points as points"),
        Row(
            "rigid motions",
            "by formula",
            "rotors; helpers in `tools.g3c`",
            "`Motor`, `Rotor`, `Translator`, arrays",
        ),
    ]


def handling_rows() -> list[Row]:
    """Printing, arrays, and what else a user meets."""
    return [
        Row(
            "printing",
            "6 digits; terms on e1245 and e1345 are left out",
            "5 digits",
            "exact, or any number format; also by e0 and einf",
        ),
        Row(
            "printed text read back",
            "no parser",
            round_trip(lambda x: from_clifford(parsed_by_clifford(str(to_clifford(x))))),
            round_trip(lambda x: Multivector.parse(str(x))),
        ),
        Row(
            "arrays of multivectors",
            "none: an array is the terms of one",
            "object arrays `MVArray`",
            "one float array (…, 32)",
        ),
        Row("a value can change under you", "no", "yes, by index", "no: frozen"),
        Row("licence", "GPL-3.0", "BSD-3-Clause", "Apache-2.0"),
    ]


def time_rows() -> list[Row]:
    """Calls from Python."""
    a, b = (Multivector(RANDOM.normal(size=32)) for _ in range(2))
    motor, point = Motor.from_axis([0.1, 0.2, 0.3], [1, 2, 3], 0.7, 0.1), cga.up([0.3, -0.2, 0.5])
    bivector = Multivector(RANDOM.normal(size=32)).grade(2)
    many = [Multivector(RANDOM.normal(size=(1000, 32))) for _ in range(2)]
    ca, cb, cm, cp, cbv = (to_clifford(x) for x in (a, b, motor, point, bivector))
    arrays = [clifford.MVArray([to_clifford(x) for x in array]) for array in many]
    return [
        timed("full geometric product", lambda: ca * cb, lambda: a * b),
        timed("motor * point * ~motor", lambda: cm * cp * ~cm, lambda: motor * point * ~motor),
        timed("outer product", lambda: ca ^ cb, lambda: a ^ b),
        timed("sum", lambda: ca + cb, lambda: a + b),
        timed("inverse of a full multivector", lambda: ca.inv(), lambda: a.inverse()),
        timed("inverse of a motor", lambda: cm.inv(), lambda: motor.inverse()),
        timed("exp of a bivector", lambda: cbv.exp(), lambda: bivector.exp()),
        timed("1000 products of two arrays", lambda: arrays[0] * arrays[1], lambda: many[0] * many[1]),
    ]


HEADER = """\
# The algebra beside its neighbours

Written by `python benchmark/algebra_table.py`, which measures what can be measured: Python {python}, numpy {numpy},
clifford {clifford}, {machine}. Times are the best of 30 rounds of calls from Python, theirs and ours by turns.

The MATLAB library is the paper's own, [conformal_library](https://github.com/iqedgarmg/conformal_library), read at
commit e73c7ea (`include/blades.m`, `include/conformal.m`). It was not run. Its outer and inner products are measured
by putting its two formulas on a geometric product that is right: they are the products of two vectors, but not of all
grades. `clifford` makes every algebra; here there is G(4,1) alone. It is the reference of our tests.

| | MATLAB library | clifford | gaik_core.cga |
| --- | --- | --- | --- |
"""


def main() -> None:
    """Write the page."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    default = Path(__file__).parents[1] / "docs" / "algebra_comparison.md"
    parser.add_argument("--out", type=Path, default=default, help="the page to write")
    out: Path = parser.parse_args().out
    page = HEADER.format(
        python=platform.python_version(),
        numpy=np.__version__,
        clifford=clifford.__version__,
        machine=f"{platform.system()} on {platform.machine()}",
    )
    page += "".join(f"| {row.what} | {row.matlab} | {row.clifford} | {row.ours} |\n" for row in rows())
    out.write_text(page, encoding="utf-8")
    print(f"wrote {out}")


if __name__ == "__main__":
    main()
