"""The page and the parameter files are what the tables say."""

from pathlib import Path

import pytest
import yaml
from rclpy.node import Node

from gaik_ros import ik_node, pid_controller, trajectory_publisher
from gaik_ros.parameters import JOINT
from gaik_ros.reference_page import OWN, main, section, table, topics

ROOT = Path(__file__).parents[3]
TABLES = {module.TABLE.node: module.TABLE for module in (ik_node, pid_controller, trajectory_publisher)}
FILES = sorted((ROOT / "config").glob("*.yaml"))


@pytest.mark.parametrize("node", TABLES)
def test_the_page_is_up_to_date(node):
    assert section(TABLES[node]) in (ROOT / "docs" / "nodes.md").read_text()


def test_the_page_has_the_topics():
    assert topics() in (ROOT / "docs" / "nodes.md").read_text()


def test_the_command_prints_every_parameter(capsys):
    assert main([]) == 0
    printed = capsys.readouterr().out
    for row in (row for module in OWN for row in table(module).parameters):
        assert f"`{row.name.replace(JOINT, 'JOINT')}`" in printed


def test_there_are_parameter_files():
    assert {"touch.yaml", "two_devices.yaml"} <= {file.name for file in FILES}


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_a_parameter_file_is_complete_and_has_nothing_unknown(file):
    content = yaml.safe_load(file.read_text())
    for node, table_ in TABLES.items():
        given = content[f"/**/{node}"]["ros__parameters"]
        expected = {row.name for row in table_.parameters if row.default is not None}
        assert set(given) == expected
    for section_name, body in content.items():
        node = section_name.rsplit("/", 1)[-1]
        for name, value in body["ros__parameters"].items():
            if node in TABLES:
                row = next(row for row in TABLES[node].parameters if row.name == name)
                row.convert(float(value) if isinstance(row.default, float) else value)


@pytest.mark.parametrize("node", TABLES)
def test_ros_reads_the_defaults_from_the_file_as_they_are(context, node):
    arguments = ["--ros-args", "--params-file", str(ROOT / "config" / "touch.yaml")]
    made = Node(node, context=context, namespace="/somewhere", cli_args=arguments)
    assert len(made._parameter_overrides) == sum(row.default is not None for row in TABLES[node].parameters)
    assert dict(TABLES[node].declare(made)) == dict(TABLES[node].defaults())
    made.destroy_node()
