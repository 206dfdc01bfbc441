"""`gaik bench`: the repository's benchmark against other packages."""

from __future__ import annotations

import subprocess
import sys
from argparse import ArgumentParser, Namespace
from pathlib import Path

from gaik_core.cli.command import Command
from gaik_core.errors import GaikError

SCRIPT = Path("benchmark") / "run.py"


def configure(parser: ArgumentParser) -> None:
    """Its arguments: the script's own."""
    parser.add_argument("--quick", action="store_true", help="few targets and rounds; nothing is written")
    parser.add_argument("--tasks", nargs="+", metavar="TASK", help="T1, T2, …; all by default")
    parser.add_argument(
        "--peers", nargs="+", metavar="NAME", help="only peers whose name contains one of these"
    )
    parser.add_argument("--rounds", type=int, metavar="N", help="rounds of each task")
    parser.add_argument("--budget", type=float, metavar="S", help="seconds a solver may take a round")
    parser.add_argument("--batch", type=int, metavar="N", help="targets of the batch task")
    written = parser.add_mutually_exclusive_group()
    written.add_argument("--output", metavar="DIR", help="folder of the page and its pictures")
    written.add_argument("--no-write", action="store_true", help="print the page only")


def run(arguments: Namespace) -> int:
    """Run the script with what was given; its exit code is ours."""
    return subprocess.call([sys.executable, str(script()), *passed_on(arguments)])


def passed_on(arguments: Namespace) -> list[str]:
    """The script's arguments."""
    words = []
    for name in ("tasks", "peers", "rounds", "budget", "batch", "output"):
        value = getattr(arguments, name)
        if value is not None:
            words += [f"--{name}", *map(str, value if isinstance(value, list) else [value])]
    return words + [
        f"--{name.replace('_', '-')}" for name in ("quick", "no_write") if getattr(arguments, name)
    ]


def script() -> Path:
    """The benchmark of the repository around the working directory, or of the one that this file stands in."""
    here = Path.cwd()
    for folder in (here, *here.parents, *Path(__file__).resolve().parents):
        if (folder / SCRIPT).is_file() and (folder / "src" / "gaik_core").is_dir():
            return folder / SCRIPT
    raise GaikError(f"bench needs {SCRIPT} of gaik's repository, which is not here; run it in a clone of it")


COMMAND = Command(
    "run the benchmark against other packages, in a clone of the repository",
    ("gaik bench --quick --tasks T1", "gaik bench --rounds 3 --peers pinocchio --no-write"),
    configure,
    run,
)
