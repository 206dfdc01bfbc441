"""Findings as plain data for the JSON file."""

from __future__ import annotations

from typing import Any

import numpy as np

from gaik_core.experiments.findings import Comparison, Experiment, Findings


def as_data(experiment: Experiment, findings: Findings) -> dict[str, Any]:
    """Everything an experiment found, as `json.dumps` takes it; a unit stands beside each number or in its name."""
    data = {
        "section": experiment.section,
        "title": experiment.title,
        "largest_difference_between_algebras_rad": findings.gap,
        "comparisons": [_comparison(comparison) for comparison in findings.comparisons],
        "tables": [{"title": t.title, "columns": t.columns, "rows": t.rows} for t in findings.tables],
        "errata": [vars(erratum) for erratum in findings.errata],
        "numbers": findings.numbers,
    }
    return {key: _plain(value) for key, value in data.items()}


def _comparison(comparison: Comparison) -> dict[str, Any]:
    return {
        "quantity": comparison.quantity,
        "unit": comparison.unit,
        "printed": comparison.printed,
        "quaternion": comparison.quaternion,
        "conformal": comparison.conformal,
        "difference": comparison.difference,
        "remark": comparison.remark,
    }


def _plain(value: Any) -> Any:
    """Arrays as lists, numpy's numbers as Python's; an infinity, which JSON has not, as None."""
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value
