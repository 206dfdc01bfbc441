"""The command `gaik`: finds the subcommands by entry points, runs one, and turns errors into one line.

Exit codes: 0; 1 where what was asked for could not be had; 2 for bad input; 130 after Ctrl-C.
"""

from __future__ import annotations

import os
import sys
from argparse import ArgumentParser
from collections.abc import Sequence
from contextlib import suppress
from importlib.metadata import EntryPoint, entry_points
from typing import NoReturn

from gaik_core import __version__
from gaik_core.cli.command import GROUP, Command
from gaik_core.cli.parser import Parser
from gaik_core.cli.terminal import complain
from gaik_core.errors import GaikError, UnknownNameError

INTERRUPTED = 130  # 128 + SIGINT, as shells report it
COMPLETION = 'eval "$(register-python-argcomplete gaik)"'


def main(arguments: Sequence[str] | None = None) -> int:
    """Run `gaik` with arguments, those of the process by default; return the exit code."""
    given = sys.argv[1:] if arguments is None else list(arguments)
    try:
        return run(given)
    except KeyboardInterrupt:
        if arguments is None:
            leave_at_once()
        return INTERRUPTED
    except BrokenPipeError:  # the reader has seen enough, as `head` does
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except GaikError as error:
        complain(f"gaik: {error}")
        return 2
    except MemoryError as error:
        complain(f"gaik: not enough memory: {error}")
        return 2
    except OSError as error:
        complain(f"gaik: {error.filename or 'input or output'}: {error.strerror or error}")
        return 2


def leave_at_once() -> NoReturn:
    """End the process without the interpreter's clean-up: a compilation may have been interrupted halfway."""
    with suppress(OSError):
        sys.stdout.flush()
        sys.stderr.flush()
    os._exit(INTERRUPTED)


def run(given: Sequence[str]) -> int:
    """Parse and run; raises what the subcommand raises."""
    points = {point.name: point for point in entry_points(group=GROUP)}
    wanted = next((argument for argument in given if not argument.startswith("-")), None)
    if wanted is not None and wanted not in points:
        raise UnknownNameError("command", wanted, sorted(points))
    completing = "_ARGCOMPLETE" in os.environ
    # The one that is asked for is imported, and no other: help and completion need all.
    names = [wanted] if wanted is not None and not completing else sorted(points)
    commands = {name: load(points[name]) for name in names}
    parser = build_parser(commands)
    if completing:
        complete(parser)
    parsed = parser.parse_args(given)
    if parsed.command is None:
        parser.print_help()
        return 2
    return commands[parsed.command].run(parsed)


def load(point: EntryPoint) -> Command:
    """The subcommand of an entry point; one that cannot be imported says so when it is run."""
    try:
        command = point.load()
    except (ImportError, AttributeError) as error:
        return unavailable(point, str(error))
    if not isinstance(command, Command):
        return unavailable(point, f"{point.value} is no Command")
    return command


def unavailable(point: EntryPoint, reason: str) -> Command:
    """A subcommand in the place of one that cannot be loaded."""

    def run(_: object) -> int:
        raise GaikError(f"{point.name} is not available: {reason}")

    def configure(parser: ArgumentParser) -> None:
        parser.add_argument("rest", nargs="*")

    return Command(f"(not available: {reason})", (), configure, run)


def build_parser(commands: dict[str, Command]) -> ArgumentParser:
    """The parser of `gaik` with these subcommands."""
    parser = Parser(
        prog="gaik",
        description="Inverse kinematics in quaternion algebra and in conformal geometric algebra.",
        epilog=f"gaik COMMAND --help tells more, with examples.\nshell completion (needs argcomplete): {COMPLETION}",
    )
    parser.add_argument("--version", action="version", version=f"gaik {__version__}")
    adder = parser.add_subparsers(dest="command", metavar="COMMAND", title="commands")
    for name, command in commands.items():
        examples = "".join(f"\n  {line}" for line in command.examples)
        sub = adder.add_parser(
            name,
            help=command.summary,
            description=command.summary,
            epilog=f"examples:{examples}" if examples else None,
        )
        command.configure(sub)
    return parser


def complete(parser: ArgumentParser) -> None:
    """Answer the shell and leave, where argcomplete is installed."""
    try:
        import argcomplete
    except ImportError:
        return
    argcomplete.autocomplete(parser)
