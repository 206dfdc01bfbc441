"""Subcommands that this package adds to the `gaik` command."""
