"""The robot that a command is asked about: one shipped, a robot file, or a URDF."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gaik_core.cli.command import robot_names
from gaik_core.errors import GaikError

if TYPE_CHECKING:
    from gaik_core.chain import KinematicChain


def add_robot(parser: ArgumentParser, optional: bool = False) -> None:
    """Its arguments."""
    what = "a robot's name (see gaik robots), a robot file, or a URDF (ends in .urdf)"
    robot: Any = (
        parser.add_argument("robot", nargs="?", help=f"{what}; all that are shipped by default")
        if optional
        else parser.add_argument("robot", help=what)
    )
    robot.completer = robot_names
    parser.add_argument("--base", metavar="LINK", help="of a URDF: where the arm begins (default: its root)")
    parser.add_argument("--tip", metavar="LINK", help="of a URDF: where it ends (default: its only leaf)")


def load_robot(arguments: Namespace) -> KinematicChain:
    """The arm asked for."""
    from gaik_core.chain import KinematicChain

    if str(arguments.robot).endswith(".urdf"):
        path = Path(arguments.robot)
        if not path.is_file():
            raise GaikError(f"{path}: there is no such file")
        return KinematicChain.from_urdf(path, arguments.base, arguments.tip)
    for option in ("base", "tip"):
        if getattr(arguments, option) is not None:
            raise GaikError(f"--{option} is for a URDF; {arguments.robot!r} is none")
    return KinematicChain.load(arguments.robot)
