"""The reference page of the nodes, and a parameter file with every default, from the parameter tables.

python -m gaik_ros.reference_page touch_sim.touch_sim_node > docs/nodes.md
python -m gaik_ros.reference_page --parameter-file touch_sim.touch_sim_node > config/touch.yaml

The modules named are added to gaik_ros's own; each must have a TABLE.
"""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Sequence

from rclpy.qos import QoSProfile

from gaik_ros.parameters import JOINT, Parameter, ParameterTable, Value
from gaik_ros.qos import TOPICS, Topic

OWN = ("gaik_ros.trajectory_publisher", "gaik_ros.ik_node", "gaik_ros.pid_controller")

BESIDE = ("gaik_ros.path_markers", "gaik_ros.record", "gaik_ros.touch_adapter", "gaik_ros.viewer.node")
"""Nodes beside a suite: on the page, but not in the parameter file, where they would pin what depends on the use."""

INTRODUCTION = """\
# Parameters of the nodes

Made from the tables in the code by `python -m gaik_ros.reference_page touch_sim.touch_sim_node > docs/nodes.md`.

An integer is taken where a double is wanted. A bad value at the start ends the node with one line and the exit code
2; a bad change of a running node is refused, and the old value stays in force. Of several that are set at once,
atomically, none is taken where one is bad. "One for each joint" takes one number, or a list in the order of the joints.
Read-only parameters are set at the start. What is not set by default, `ros2 param delete` unsets again.
"""

FILE_INTRODUCTION = """\
# Every parameter of every node with its default. `/**/` lets the file serve a node in any namespace.
# Made by `python -m gaik_ros.reference_page --parameter-file touch_sim.touch_sim_node`.
"""


def table(module: str) -> ParameterTable:
    """The TABLE of a module. ImportError, AttributeError: there is none."""
    found: ParameterTable = importlib.import_module(module).TABLE
    return found


def section(node: ParameterTable) -> str:
    """The part of the page about one node."""
    lines = [f"## {node.node}", ""]
    lines += ["| parameter | type | default | unit | range | |", "| --- | --- | --- | --- | --- | --- |"]
    lines += [_row(row) for row in node.parameters]
    return "\n".join(lines) + "\n"


def _row(row: Parameter) -> str:
    note = row.description + (" (read-only)" if row.read_only else "")
    name = row.name.replace(JOINT, "JOINT")
    default = "not set" if row.default is None else f"`{_literal(row.default)}`"
    return f"| `{name}` | {row.type_name} | {default} | {row.unit} | {row.range_text} | {note} |"


def topics() -> str:
    """The part of the page about quality of service."""
    lines = ["## Topics", "", "All are volatile and keep the last messages only.", ""]
    lines += ["| topic | type | offered | asked for | why |", "| --- | --- | --- | --- | --- |"]
    lines += [_topic_row(topic) for topic in TOPICS]
    return "\n".join(lines) + "\n"


def _topic_row(topic: Topic) -> str:
    offered, asked = _profile(topic.offered), _profile(topic.asked)
    return f"| `{topic.name}` | {topic.message} | {offered} | {asked} | {topic.reason} |"


def _profile(profile: QoSProfile) -> str:
    return f"{profile.reliability.name.lower().replace('_', ' ')}, depth {profile.depth}"


def page(tables: Sequence[ParameterTable]) -> str:
    """The whole page."""
    return "\n".join([INTRODUCTION, *(section(node) for node in tables), topics()])


def parameter_file(tables: Sequence[ParameterTable]) -> str:
    """A parameter file with every default; parameters that are not set by default stand in comments."""
    lines = [FILE_INTRODUCTION]
    for node in tables:
        lines += [f"/**/{node.node}:", "  ros__parameters:"]
        lines += [_setting(row) for row in node.parameters]
        lines.append("")
    return "\n".join(lines)


def _setting(row: Parameter) -> str:
    unit = f" [{row.unit}]" if row.unit else ""
    if row.default is None:
        return f"    # {row.name.replace(JOINT, 'JOINT')}:  {row.description}{unit}"
    return f"    {row.name}: {_literal(row.default)}  # {row.description}{unit}"


def _literal(value: Value) -> str:
    """A value as YAML has it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, tuple):
        return "[" + ", ".join(_literal(item) for item in value) + "]"
    if isinstance(value, str):
        return value or '""'
    text = repr(value)
    return text.replace("e", ".0e") if "e" in text and "." not in text else text  # YAML wants 1.0e-06


def main(args: Sequence[str] | None = None) -> int:
    """Print the page or the file."""
    parser = argparse.ArgumentParser(prog="python -m gaik_ros.reference_page", description=__doc__)
    parser.add_argument(
        "--parameter-file", action="store_true", help="print a parameter file instead of the page"
    )
    parser.add_argument("modules", nargs="*", help="modules of further nodes")
    options = parser.parse_args(args)
    beside = () if options.parameter_file else BESIDE
    tables = [table(module) for module in (*OWN, *options.modules, *beside)]
    sys.stdout.write(parameter_file(tables) if options.parameter_file else page(tables))
    return 0


if __name__ == "__main__":
    sys.exit(main())
