"""What the subcommands share of the terminal: colour and progress only where someone looks, tables, JSON."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, TextIO

from tqdm import tqdm

BOLD, RED, GREEN = "1", "31", "32"


def coloured(text: str, code: str, stream: TextIO | None = None) -> str:
    """The text in a colour, on a terminal that has not been asked for none (https://no-color.org)."""
    stream = sys.stdout if stream is None else stream
    if not stream.isatty() or os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb":
        return text
    return f"\x1b[{code}m{text}\x1b[0m"


def complain(message: str) -> None:
    """One line on standard error."""
    print(coloured(message, RED, sys.stderr), file=sys.stderr)


def print_json(data: Any) -> None:
    """Data as JSON on standard output."""
    print(json.dumps(data, indent=2, ensure_ascii=False, allow_nan=False))


def print_table(columns: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """A table with aligned columns."""
    widths = [max(map(len, column)) for column in zip(columns, *rows, strict=True)]
    for number, row in enumerate((columns, *rows)):
        line = "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        print(coloured(line, BOLD) if number == 0 else line)


@contextmanager
def progress(total: int, unit: str) -> Iterator[Any]:
    """A progress bar on standard error; nothing where that is no terminal."""
    with tqdm(total=total, unit=unit, disable=None, leave=False, dynamic_ncols=True) as bar:
        yield bar
