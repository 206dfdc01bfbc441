"""What can be checked of the launch file where `launch` itself cannot be installed."""

import ast
from pathlib import Path

import pytest

SOURCES = Path(__file__).parents[2]
FILE = SOURCES / "touch_sim" / "launch" / "touch.launch.py"


@pytest.fixture(scope="module")
def tree():
    return ast.parse(FILE.read_text(encoding="utf-8"), filename=FILE.name)


def calls(tree, name):
    return [n for n in ast.walk(tree) if isinstance(n, ast.Call) and getattr(n.func, "id", "") == name]


def test_it_defines_what_ros2_launch_calls(tree):
    compile(tree, FILE.name, "exec")
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
    assert "generate_launch_description" in [function.name for function in functions]


def test_its_arguments_are_declared_and_used(tree):
    declared = {call.args[0].value for call in calls(tree, "DeclareLaunchArgument")}
    used = {call.args[0].value for call in calls(tree, "LaunchConfiguration")}
    assert declared == used == {"namespace", "params_file"}


def test_every_node_it_starts_is_an_executable_of_its_package(tree):
    (nodes,) = [
        ast.literal_eval(node.value)
        for node in tree.body
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "NODES"
    ]
    assert len(nodes) == 4
    for package, executable in nodes:
        assert (SOURCES / package / "scripts" / executable).is_file()
        assert f'"{executable} = ' in (SOURCES / package / "setup.py").read_text(encoding="utf-8")


def test_its_parameter_file_is_one_of_the_shipped(tree):
    (join,) = calls(tree, "PathJoinSubstitution")
    *folders, name = [part.value for part in join.args[0].elts if isinstance(part, ast.Constant)]
    assert folders == ["config"]
    assert (SOURCES.parent / "config" / name).is_file()
