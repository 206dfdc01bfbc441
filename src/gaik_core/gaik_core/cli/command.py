"""What a subcommand of `gaik` is."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from dataclasses import dataclass

GROUP = "gaik.commands"
"""Another package adds a subcommand with an entry point `view = package.module:COMMAND` in this group, a `Command`."""


@dataclass(frozen=True)
class Command:
    """A subcommand; its module should be quick to import, so heavy imports belong into `run`.

    Attributes:
        summary: one line for `gaik --help`.
        examples: lines that work as typed, for its own help.
        configure: adds its arguments.
        run: does it and returns the exit code: 0, or 1 where what was asked for could not be had. A GaikError or an
            OSError that it raises becomes one line and the exit code 2.
    """

    summary: str
    examples: tuple[str, ...]
    configure: Callable[[ArgumentParser], None]
    run: Callable[[Namespace], int]


def robot_names(**_: object) -> list[str]:
    """What the shell may complete a robot to: argcomplete's completer of an argument."""
    from gaik_core import KinematicChain

    return KinematicChain.names()
