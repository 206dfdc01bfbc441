"""Points from a CSV file with the columns x, y and z, in m."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

COLUMNS = ("x", "y", "z")


class PointFileError(ValueError):
    """A file that is no list of points; the message names the file, the line and what is wrong with it."""


def read_points(path: str | Path) -> NDArray[np.float64]:
    """The points (n, 3) in m. Other columns, empty lines and lines that begin with # are passed over."""
    try:
        with Path(path).open(newline="", encoding="utf-8-sig") as file:
            lines = [(n, row) for n, row in _rows(file) if row and not row[0].lstrip().startswith("#")]
    except (OSError, UnicodeDecodeError, csv.Error) as reason:
        raise PointFileError(
            f"{path} cannot be read: {getattr(reason, 'strerror', None) or reason}"
        ) from reason
    if not lines:
        raise PointFileError(f"{path} is empty: its first line must name the columns x, y and z")
    number, header = lines[0]
    names = [name.strip().lower() for name in header]
    missing = [name for name in COLUMNS if names.count(name) != 1]
    if missing:
        raise PointFileError(
            f"{path}, line {number}: the columns x, y and z must each stand there once, not {header}"
        )
    columns = [names.index(name) for name in COLUMNS]
    points = [
        [_number(path, n, row, name, column) for name, column in zip(COLUMNS, columns, strict=True)]
        for n, row in lines[1:]
    ]
    if not points:
        raise PointFileError(f"{path} has no points after its first line")
    return np.array(points)


def _rows(file: Iterable[str]) -> Iterator[tuple[int, list[str]]]:
    reader = csv.reader(file)
    for row in reader:
        yield reader.line_num, row


def _number(path: str | Path, line: int, row: list[str], name: str, column: int) -> float:
    if column >= len(row):
        raise PointFileError(f"{path}, line {line}: {name} is missing")
    try:
        value = float(row[column])
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise PointFileError(
            f"{path}, line {line}: {name} is {row[column]!r}, it must be a finite number in m"
        )
    return value
