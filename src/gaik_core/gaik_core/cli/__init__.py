"""The `gaik` command: `main` finds the subcommands, each stands in a file of its own.

Another package adds a subcommand by an entry point in the group `gaik.commands` that names a `Command`.
"""

from gaik_core.cli.command import Command

__all__ = ["Command"]
