"""What demo, view and soak share of a command line.

It needs nothing but Python, so that a missing module can be said in one line;
`gaik_core.cli.parser` is its like for commands that may import gaik_core.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable, Collection, Mapping, Sequence
from difflib import get_close_matches
from itertools import pairwise
from typing import NoReturn

BAD_OPTION, FAILED, INTERRUPTED = 2, 1, 130

_FROM_SOURCE = "-e src/gaik_core -e src/gaik_ros -e src/touch_sim"
INSTALL: Mapping[str, str] = {  # module -> what pip installs it by
    "rclpy": "'ros-jazzy-rclpy[fastrtps]' ros-jazzy-common-interfaces",
    "geometry_msgs": "ros-jazzy-common-interfaces",
    "sensor_msgs": "ros-jazzy-common-interfaces",
    "diagnostic_msgs": "ros-jazzy-common-interfaces",
    "std_srvs": "ros-jazzy-common-interfaces",
    "rcl_interfaces": "ros-jazzy-common-interfaces",
    "yaml": "PyYAML",
    "mpl_toolkits": "matplotlib",
    "viser": "'viser>=1.1,<2'",
    "rich": "'viser>=1.1,<2'",
    "gaik_core": _FROM_SOURCE,
    "gaik_ros": _FROM_SOURCE,
    "touch_sim": _FROM_SOURCE,
}


class Parser(argparse.ArgumentParser):
    """Says what is wrong in one line, without the usage before it."""

    def __init__(self, prog: str, description: str, epilog: str) -> None:
        super().__init__(
            prog=prog,
            description=description,
            epilog=epilog,
            formatter_class=argparse.RawDescriptionHelpFormatter,
            allow_abbrev=False,
        )

    def error(self, message: str) -> NoReturn:
        """Leave with exit code 2."""
        self.exit(BAD_OPTION, f"{self.prog}: {message} (--help lists the options)\n")


def within(number: Callable[[str], float], low: float, high: float) -> Callable[[str], float]:
    """A reader, for `type=`, of numbers from `low` to `high`; `number` is int or float."""
    kind = "a whole number" if number is int else "a number"

    def read(text: str) -> float:
        try:
            value = number(text)
        except ValueError:
            value = math.nan
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"{text!r}; expected {kind} from {low:g} to {high:g}")
        return value

    return read


def split_ros_arguments(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """The program's own arguments, and --ros-args with all that follows."""
    cut = arguments.index("--ros-args") if "--ros-args" in arguments else len(arguments)
    return list(arguments[:cut]), list(arguments[cut:])


def check_parameters(ros_arguments: Sequence[str], given: Mapping[str, Collection[str]]) -> None:
    """Raise ValueError for a `-p NODE:NAME:=VALUE` or `-p NAME:=VALUE` that would be ignored in silence.

    `given` has the parameters that the program itself sets, by the node's name: none of another node, none of these.
    """
    for option, rule in pairwise(ros_arguments):
        if option not in ("-p", "--param"):
            continue
        node, colon, name = rule.split(":=")[0].rpartition(":")
        if colon and node not in given:
            near = get_close_matches(node, given, n=1)
            hint = f"; did you mean {near[0]!r}?" if near else ""
            raise ValueError(f"-p {rule}: no node {node!r} here, but {', '.join(given)}{hint}")
        if any(name in given[each] for each in ([node] if colon else given)):
            raise ValueError(f"-p {rule}: {name} is set by the options here, see --help")


def complain(program: str, message: str, code: int) -> int:
    """Say one line on standard error; returns `code`."""
    print(f"{program}: {' '.join(message.split())}", file=sys.stderr)
    return code


def complain_of_missing(program: str, missing: ModuleNotFoundError) -> int:
    """Say which module is missing and how to install it; returns the exit code."""
    name = (missing.name or "").split(".")[0]
    command = f"{sys.executable} -m pip install {INSTALL.get(name, name)}"
    return complain(program, f"Python module {name} is missing; install it with: {command}", FAILED)
