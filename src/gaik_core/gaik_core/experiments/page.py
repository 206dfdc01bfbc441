"""The page `reproduction.md`: what the paper prints beside what comes out here."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from gaik_core.experiments.findings import Comparison, Erratum, Experiment, Findings

Result = tuple[Experiment, Findings]

INTRODUCTION = """\
# The paper, reproduced

Written by `gaik reproduce --docs docs`; do not edit. Every number on this page was computed by that command, from the
paper's own starts, targets and settings.

- *quaternion* and *conformal* are two separate implementations: section 3's and section 4's.
- *difference* is ours, by quaternions, less what the paper prints.
- *iterates differ by* is the largest difference of any joint between the algebras, at any step of any descent.
- A dash stands where the paper prints no number, or where its number did not survive in our copy.
"""


def page(results: Sequence[Result], images: Mapping[str, str]) -> str:
    """The whole page; `images` are the pictures' addresses by experiment."""
    parts = [INTRODUCTION, overview(results)]
    parts += [section(experiment, findings, images) for experiment, findings in results]
    parts.append(errata(results))
    return "\n".join(parts)


def overview(results: Sequence[Result]) -> str:
    """A row per experiment: its first comparison."""
    rows = []
    for experiment, findings in results:
        first = findings.comparisons[0]
        gap = f"{findings.gap:.0e} rad" if findings.iterates else "-"
        rows.append([f"[{experiment.name}](#{experiment.name})", experiment.section, *_cells(first), gap])
    columns = [
        "experiment", "section", "quantity", "the paper", "quaternion", "conformal", "difference", "iterates differ by"
    ]  # fmt: skip
    return "## Overview\n\n" + table(columns, rows)


def section(experiment: Experiment, findings: Findings, images: Mapping[str, str]) -> str:
    """One experiment: what was done, its picture, all its numbers."""
    parts = [
        f"## {experiment.name}",
        f"**{experiment.title}** (section {experiment.section}). {experiment.about}",
    ]
    if experiment.name in images:
        parts.append(f"![{experiment.title}]({images[experiment.name]})")
    columns = ["quantity", "the paper", "quaternion", "conformal", "difference", "remark"]
    parts.append(table(columns, [[*_cells(row), row.remark] for row in findings.comparisons]))
    for extra in findings.tables:
        parts += [f"{extra.title}:", table(extra.columns, extra.rows)]
    return "\n\n".join(part.rstrip("\n") for part in parts) + "\n"


def errata(results: Iterable[Result]) -> str:
    """Every place where the paper errs, as measured."""
    found = [erratum for _, findings in results for erratum in findings.errata]
    equations = [erratum for erratum in found if erratum.where.startswith("eq")]
    others = [erratum for erratum in found if not erratum.where.startswith("eq")]
    rows = [_erratum(erratum) for erratum in [*equations, *others]]
    return "## All errata\n\n" + table(["where", "printed", "what holds", "measured here"], rows)


def _erratum(erratum: Erratum) -> list[str]:
    measured = erratum.measured if erratum.confirmed else f"**not confirmed**: {erratum.measured}"
    return [erratum.where, erratum.printed, erratum.holds, measured]


def table(columns: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A Markdown table."""
    lines = [columns, ["---"] * len(columns), *rows]
    return "".join("| " + " | ".join(_escaped(cell) for cell in line) + " |\n" for line in lines)


def _escaped(cell: object) -> str:
    return str(cell).replace("|", r"\|")


def _cells(comparison: Comparison) -> list[str]:
    """Quantity, the paper's, ours twice, the difference."""
    values = (comparison.printed, comparison.quaternion, comparison.conformal, comparison.difference)
    unit = f" ({comparison.unit})" if comparison.unit else ""
    return [comparison.quantity + unit, *(shown(value, comparison.decimals) for value in values)]


def shown(value: ArrayLike | None, decimals: int) -> str:
    """A number or several with so many decimals, or in powers of ten where those would leave nothing; "-" for None."""
    if value is None:
        return "-"
    array = np.asarray(value, dtype=float)
    if array.ndim:
        return "[" + ", ".join(shown(item, decimals) for item in array) + "]"
    text = f"{float(array):.{decimals}f}"
    if float(text) == 0.0:
        return f"{0.0:.{decimals}f}" if abs(array) < 1e-12 or decimals < 5 else f"{float(array):.0e}"
    return text if decimals < 9 else f"{float(array):.1e}"
