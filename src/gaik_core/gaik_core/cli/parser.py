"""The parser of `gaik` and of the other command lines that may import gaik_core: errors are one line, exit code 2."""

from __future__ import annotations

import re
import sys
from argparse import ArgumentParser, RawDescriptionHelpFormatter
from typing import Any, NoReturn

from gaik_core.cli.terminal import complain


class Formatter(RawDescriptionHelpFormatter):
    """Help with room for the longest option beside its text."""

    def __init__(self, prog: str) -> None:
        super().__init__(prog, max_help_position=30)
        self._action_max_length = (
            16  # argparse forgets that subcommands are indented, and would break the longest
        )


class Parser(ArgumentParser):
    """A parser whose errors are one line, and that takes -1e-3 for a number."""

    def __init__(self, **options: Any) -> None:
        super().__init__(formatter_class=Formatter, **options)
        # Before Python 3.14 argparse takes -0.001 for a number and -1e-3 for an option.
        self._negative_number_matcher = re.compile(r"^-(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$|^-(inf|nan)$")

    def error(self, message: str) -> NoReturn:
        """Say what was wrong and leave with exit code 2."""
        complain(f"{self.prog}: {message} (see {self.prog} --help)")
        sys.exit(2)
