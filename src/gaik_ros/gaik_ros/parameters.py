"""Parameters of a node, declared in one table: type, default, unit, description and range of each.

rclpy's own declarations refuse an integer for a float, and take each parameter of a change by itself. Here an
integer is taken, and a change is checked as a whole: it comes into force whole or not at all.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter as RosParameter

Value = bool | int | float | str | tuple[float, ...] | tuple[str, ...] | None

JOINT = "<joint>"
"""Stands in a parameter's name for the name of each joint."""


class ParameterError(ValueError):
    """A parameter's value is refused; the message is one line for the user."""


@dataclass(frozen=True)
class Parameter:
    """One parameter. Its type is that of `default`; a tuple of floats also takes one float for all joints.

    A `default` of None is a float that may be left unset, and be unset again.
    """

    name: str
    default: Value
    unit: str
    description: str
    lower: float | None = None
    upper: float | None = None
    choices: tuple[str, ...] | None = None
    read_only: bool = False
    check: Callable[[Any], None] | None = None  # raises ValueError with the reason
    per_joint: bool = False  # a float that may be a list, one value for each joint

    @property
    def type_name(self) -> str:
        """The type as the reference page has it."""
        if self.per_joint:
            return "double or double[]"
        if isinstance(self.default, tuple):
            return "string[]" if self.default and isinstance(self.default[0], str) else "double[]"
        names = {bool: "bool", int: "int", float: "double", str: "string", type(None): "double"}
        return names[type(self.default)]

    @property
    def range_text(self) -> str:
        """What the value may be, for people; empty where there is no bound."""
        unit = f" {self.unit}" if self.unit else ""
        if self.choices is not None:
            return "one of " + ", ".join(self.choices)
        if self.lower is not None and self.upper is not None:
            return f"from {self.lower:g} to {self.upper:g}{unit}"
        if self.lower is not None:
            return f"at least {self.lower:g}{unit}"
        if self.upper is not None:
            return f"at most {self.upper:g}{unit}"
        return ""

    def convert(self, value: Any) -> Value:
        """`value` as this parameter's own type; ParameterError says what it was and what it may be."""
        converted = self._converted(value)
        for number in converted if isinstance(converted, tuple) else (converted,):
            if isinstance(number, int | float) and not isinstance(number, bool):
                self._check_number(number)
        if self.choices is not None and converted not in self.choices:
            raise self._error(value, f"it may be {self.range_text}")
        if self.check is not None:
            try:
                self.check(converted)
            except ValueError as reason:
                raise self._error(value, str(reason)) from reason
        return converted

    def _converted(self, value: Any) -> Value:
        if isinstance(self.default, bool):
            if isinstance(value, bool):
                return value
            raise self._error(value, "it may be true or false")
        if isinstance(self.default, str):
            if isinstance(value, str):
                return value
            raise self._error(value, f"it may be {self.range_text or 'a string'}")
        if isinstance(self.default, tuple) and self.default and isinstance(self.default[0], str):
            if _is_sequence(value) and all(isinstance(item, str) for item in value):
                return tuple(value)
            raise self._error(value, "it may be a list of strings")
        if isinstance(self.default, tuple) or (self.per_joint and _is_sequence(value)):
            if _is_sequence(value) and len(value) > 0 and all(_is_number(item) for item in value):
                return tuple(float(item) for item in value)
            raise self._error(value, "it may be a list of numbers")
        if value is None and self.default is None:
            return None
        if not _is_number(value):
            raise self._error(
                value, "it may be a number" + (f" {self.range_text}" if self.range_text else "")
            )
        if isinstance(self.default, int):
            if not math.isfinite(value) or value != math.floor(value):
                raise self._error(value, "it may be a whole number")
            return int(value)
        return float(value)

    def _check_number(self, number: float) -> None:
        if not math.isfinite(number):
            bounds = f" {self.range_text}" if self.range_text else ""
            raise self._error(number, f"it may be a finite number{bounds}")
        if self.lower is not None and number < self.lower:
            raise self._error(number, f"it may be {self.range_text}")
        if self.upper is not None and number > self.upper:
            raise self._error(number, f"it may be {self.range_text}")

    def _error(self, value: object, reason: str) -> ParameterError:
        return ParameterError(f"parameter '{self.name}' is {_shown(value)}: {reason}")

    def descriptor(self) -> ParameterDescriptor:
        """What `ros2 param describe` shows. Typing is dynamic so that an integer may stand for a float."""
        unit = f" [{self.unit}]" if self.unit else ""
        return ParameterDescriptor(
            name=self.name,
            description=self.description + unit,
            additional_constraints=self.range_text,
            read_only=self.read_only,
            dynamic_typing=True,
        )


class ParameterSet(Mapping[str, Any]):
    """The values in force, read as `values.rate` or `values["gains.p"]`.

    A change replaces all values at once, so a reader on another thread sees the old set or the new one.
    """

    def __init__(self, values: Mapping[str, Value]) -> None:
        self._values = dict(values)

    def __getitem__(self, name: str) -> Any:
        return self._values[name]

    def __getattr__(self, name: str) -> Any:
        try:
            return self.__dict__["_values"][name]
        except KeyError:
            raise AttributeError(f"no parameter '{name}'") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def per_joint(self, name: str, joints: Sequence[str]) -> tuple[float, ...]:
        """One float for each of `joints` from a scalar or a list of that length, else ParameterError."""
        value = self[name]
        if not isinstance(value, tuple):
            return (float(value),) * len(joints)
        if len(value) != len(joints):
            raise ParameterError(
                f"parameter '{name}' has {len(value)} values: it may have one, "
                f"or {len(joints)} ({', '.join(joints)})"
            )
        return value


@dataclass(frozen=True)
class ParameterTable:
    """All parameters of one node."""

    node: str
    parameters: tuple[Parameter, ...]

    def for_joints(self, joints: Sequence[str]) -> ParameterTable:
        """The table with every `<joint>` row written out for each of `joints`."""
        rows: list[Parameter] = []
        for row in self.parameters:
            if JOINT in row.name:
                rows.extend(replace(row, name=row.name.replace(JOINT, joint)) for joint in joints)
            else:
                rows.append(row)
        return ParameterTable(self.node, tuple(rows))

    def help(self) -> str:
        """What --help prints: how parameters are given, and each with its default."""
        lines = [f"usage: {self.node} [--ros-args -p NAME:=VALUE ... --params-file FILE -r FROM:=TO ...]", ""]
        for row in self.parameters:
            default = "not set" if row.default is None else _shown(row.default)
            notes = [row.range_text] if row.range_text else []
            notes += [f"default {default}"] + ([row.unit] if row.unit and not row.range_text else [])
            lines.append(f"  {row.name}\n      {row.description} ({', '.join(notes)})")
        return "\n".join(lines)

    def defaults(self) -> ParameterSet:
        """The values of a node that is given none."""
        return ParameterSet({row.name: row.default for row in self.parameters})

    def declare(self, node: Node, on_change: Callable[[ParameterSet], None] | None = None) -> ParameterSet:
        """Declare all parameters on `node` and follow their changes.

        `on_change` gets the whole new set after each value was checked, before it comes into force; a
        ValueError from it refuses the change. Raises ParameterError for a bad value at the start.
        """
        values = ParameterSet({row.name: _declared(node, row) for row in self.parameters})
        self._warn_of_unknown(node)
        rows = {row.name: row for row in self.parameters}

        def on_set(changes: Sequence[RosParameter]) -> SetParametersResult:
            try:
                changed = {p.name: rows[p.name].convert(p.value) for p in changes if p.name in rows}
                if changed.items() <= values.items():
                    return SetParametersResult(successful=True)
                candidate = ParameterSet({**values, **changed})
                if on_change is not None:
                    on_change(candidate)
            except ValueError as reason:
                node.get_logger().warning(f"refused, the old values stay in force: {reason}")
                return SetParametersResult(successful=False, reason=str(reason))
            values._values = candidate._values
            return SetParametersResult(successful=True)

        def declare_unset(changes: Sequence[RosParameter]) -> None:
            """To unset a parameter is, to rclpy, to delete it: it could not be set any more."""
            for name in (change.name for change in changes):
                if name in rows and not node.has_parameter(name):
                    node.declare_parameter(name, None, rows[name].descriptor(), ignore_override=True)

        node.add_on_set_parameters_callback(on_set)
        node.add_post_set_parameters_callback(declare_unset)
        return values

    def declare_first(self, node: Node, name: str) -> Any:
        """Declare one parameter, which the others depend on, before the rest, and give its value."""
        return _declared(node, next(row for row in self.parameters if row.name == name))

    def _warn_of_unknown(self, node: Node) -> None:
        """Say which parameters were given that this node does not have: a misspelt one would do nothing."""
        for name in node._parameter_overrides:  # rclpy has no public way to see them
            if not node.has_parameter(name) and not name.startswith("qos_overrides."):
                near = get_close_matches(name, [row.name for row in self.parameters], n=1)
                hint = f"; did you mean '{near[0]}'?" if near else ""
                node.get_logger().warning(f"there is no parameter '{name}' here{hint}")


def _declared(node: Node, row: Parameter) -> Value:
    """The value of one parameter, declared if it is not yet."""
    default = list(row.default) if isinstance(row.default, tuple) else row.default
    if not node.has_parameter(row.name):
        node.declare_parameter(row.name, default, row.descriptor())
    return row.convert(node.get_parameter(row.name).value)


def check_joint_names(names: Sequence[str]) -> None:
    """For a parameter's `check`: ValueError where two joints have one name, or one has none."""
    if len(set(names)) != len(names) or not all(names):
        raise ValueError("every joint needs a name of its own")


def _is_sequence(value: object) -> bool:
    return not isinstance(value, str | bytes) and hasattr(value, "__len__") and hasattr(value, "__iter__")


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _shown(value: Any) -> str:
    if value is None:
        return "not set"
    return repr(list(value)) if _is_sequence(value) else repr(value)
