"""Robot files: YAML, one chain each, in SI units and radians.

    name: touch
    description: one line
    origin: [0, 0.025, -0.17]        # where the first axis stands (m)
    orientation: [1, 0, 0, 0]        # of the tip frame at zero (w, x, y, z)
    joints:                          # from the base to the tip, as they stand when every angle is zero
      - name: elbow
        type: revolute               # or prismatic
        axis: [-1, 0, 0]             # direction in the base frame
        link: [0, -0.135, 0]         # to the next axis, or to the tip (m)
        coupling: {shoulder: -1}     # the axis turns by its own angle plus these multiples of others
        passive: false               # true: it has no angle of its own
        offset: 0                    # added to the angle about the axis
        limits: [-0.81, 3.0]         # of the joint's own value
        axis_limits: [-0.81, 1.25]   # of the angle about the axis
        home: 0.5                    # where a solve starts

Only `joints`, and of each `name` and `axis`, must be there.
"""

from __future__ import annotations

import math
import re
from importlib.resources import files
from pathlib import Path
from reprlib import repr as shortened
from typing import Any

import yaml

from gaik_core.chain import KinematicChain
from gaik_core.checks import is_number
from gaik_core.errors import RobotFileError, UnknownRobotError
from gaik_core.joint import KINDS, Joint

CHAIN_KEYS = ("name", "description", "origin", "orientation", "joints")
JOINT_KEYS = (
    "name",
    "type",
    "axis",
    "link",
    "coupling",
    "passive",
    "offset",
    "limits",
    "axis_limits",
    "home",
)


def robot_names() -> list[str]:
    """The robots shipped with gaik_core."""
    folder = files("gaik_core") / "robots"
    return sorted(
        entry.name.removesuffix(".yaml") for entry in folder.iterdir() if entry.name.endswith(".yaml")
    )


def load_robot(robot: str | Path) -> KinematicChain:
    """A shipped robot by its name, or a robot file by its path; see `KinematicChain.load`."""
    if not isinstance(robot, str | Path):
        raise UnknownRobotError("robot", robot, [*robot_names(), "or the path of a YAML file"])
    if robot in robot_names():
        text = (files("gaik_core") / "robots" / f"{robot}.yaml").read_text(encoding="utf-8")
        return parse_robot(text, f"{robot}.yaml")
    path = Path(robot)
    if path.suffix == ".urdf":
        raise RobotFileError(f"{path}: is a URDF; KinematicChain.from_urdf reads those")
    if path.suffix not in (".yaml", ".yml") and not path.is_file():
        raise UnknownRobotError("robot", str(robot), [*robot_names(), "or the path of a YAML file"])
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
        raise RobotFileError(f"{path}: cannot be read: {reason}") from None
    return parse_robot(text, str(path))


def parse_robot(text: str, source: str = "robot file") -> KinematicChain:
    """A chain from the text of a robot file; `source` begins its error messages.

    Raises:
        RobotFileError: the message names the key, what it was and what it may be.
    """
    try:
        data = yaml.load(text, _Loader)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f" line {mark.line + 1}" if mark else ""
        raise RobotFileError(f"{source}:{place} not YAML: {getattr(error, 'problem', error)}") from None
    top = _Table(data, source, "", CHAIN_KEYS)
    entries = top.get("joints")
    if not isinstance(entries, list) or not entries:
        raise top.error("joints", entries, "a list of at least one joint")
    try:
        return KinematicChain(
            [_joint(_Table(entry, source, f"joints[{i}].", JOINT_KEYS)) for i, entry in enumerate(entries)],
            name=top.text("name", Path(source).stem),
            description=top.text("description", ""),
            origin=top.numbers("origin", 3, (0.0, 0.0, 0.0)),
            orientation=top.numbers("orientation", 4, (1.0, 0.0, 0.0, 0.0), zero=False),
        )
    except RobotFileError:
        raise
    except ValueError as error:
        raise RobotFileError(f"{source}: {error}") from None


def _joint(table: _Table) -> Joint:
    kind = table.get("type", "revolute")
    if kind not in KINDS:
        raise table.error("type", kind, " or ".join(KINDS))
    lower, upper = table.interval("limits")
    axis_lower, axis_upper = table.interval("axis_limits")
    home = table.number("home", min(max(0.0, lower), upper))
    if not lower <= home <= upper:
        raise table.error("home", home, f"a number within limits [{lower:g}, {upper:g}]")
    return Joint(
        name=table.text("name"),
        kind=kind,
        axis=table.numbers("axis", 3, zero=False),
        link=table.numbers("link", 3, (0.0, 0.0, 0.0)),
        coupling=table.factors("coupling"),
        passive=table.flag("passive"),
        offset=table.number("offset", 0.0),
        lower=lower,
        upper=upper,
        axis_lower=axis_lower,
        axis_upper=axis_upper,
        home=home,
    )


class _Table:
    """One mapping of a robot file, read key by key with errors that name the key."""

    def __init__(self, data: Any, source: str, prefix: str, known: tuple[str, ...]) -> None:
        self.source, self.prefix = source, prefix
        if not isinstance(data, dict):
            where = f"{prefix.removesuffix('.')}: " if prefix else ""
            raise RobotFileError(
                f"{source}: {where}is {_shown(data)}; expected a mapping with the keys {', '.join(known)}"
            )
        self.data: dict[Any, Any] = data
        for key in data:
            if key not in known:
                raise RobotFileError(f"{source}: {prefix}{key}: unknown key; known: {', '.join(known)}")

    def error(self, key: str, value: Any, expected: str) -> RobotFileError:
        return RobotFileError(f"{self.source}: {self.prefix}{key}: is {_shown(value)}; expected {expected}")

    def get(self, key: str, default: Any = None) -> Any:
        return self.data.get(key, default)

    def text(self, key: str, default: str | None = None) -> str:
        value = self.get(key, default)
        if not isinstance(value, str) or (default is None and not value):
            raise self.error(key, value, "a text")
        return value

    def flag(self, key: str) -> bool:
        value = self.get(key, False)
        if not isinstance(value, bool):
            raise self.error(key, value, "true or false")
        return value

    def number(self, key: str, default: float) -> float:
        value = self.get(key, default)
        if not _is_finite(value):
            raise self.error(key, value, "a finite number")
        return float(value)

    def numbers(
        self, key: str, length: int, default: tuple[float, ...] | None = None, zero: bool = True
    ) -> Any:
        value = self.get(key, default)
        expected = f"{length} finite numbers" + ("" if zero else ", not all zero")
        if not isinstance(value, list | tuple) or len(value) != length or not all(map(_is_finite, value)):
            raise self.error(key, value, expected)
        if not zero and not any(value):
            raise self.error(key, value, expected)
        return tuple(float(number) for number in value)

    def interval(self, key: str) -> tuple[float, float]:
        """Two numbers, the first not above the second; .inf stands for no limit."""
        value = self.get(key, (-math.inf, math.inf))
        if (
            not isinstance(value, list | tuple)
            or len(value) != 2
            or not all(map(is_number, value))
            or not value[0] <= value[1]
            or value[0] == math.inf
            or value[1] == -math.inf
        ):
            raise self.error(key, value, "two numbers [lower, upper], the first not above the second")
        return float(value[0]), float(value[1])

    def factors(self, key: str) -> dict[str, float]:
        value = self.get(key, {})
        if not isinstance(value, dict) or not all(
            isinstance(name, str) and _is_finite(factor) for name, factor in value.items()
        ):
            raise self.error(key, value, "a mapping from joint names to finite factors")
        return {name: float(factor) for name, factor in value.items()}


def _is_finite(value: Any) -> bool:
    return is_number(value) and math.isfinite(value)


class _Loader(yaml.SafeLoader):
    """PyYAML follows YAML 1.1, which takes 1e-3 for a text; this one takes it for a number, and no key twice."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
        keys = [key.value for key, _ in node.value]
        for place, key in enumerate(keys):
            if key in keys[:place]:
                raise yaml.constructor.ConstructorError(
                    None, None, f"the key {key!r} stands there twice", node.value[place][0].start_mark
                )
        return super().construct_mapping(node, deep)


_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float", re.compile(r"^[-+]?[0-9]+(\.[0-9]*)?[eE][-+]?[0-9]+$"), list("-+0123456789")
)


def _shown(value: Any) -> str:
    return "missing" if value is None else shortened(value)
