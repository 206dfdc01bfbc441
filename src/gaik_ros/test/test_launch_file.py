"""The launch file, as far as it can be looked at without launch: its nodes and files exist."""

import ast
from pathlib import Path

PACKAGE = Path(__file__).parents[1]
LAUNCH = PACKAGE / "launch" / "touch_device.launch.py"


def calls(name):
    tree = ast.parse(LAUNCH.read_text())
    return [n for n in ast.walk(tree) if isinstance(n, ast.Call) and getattr(n.func, "id", "") == name]


def test_it_starts_the_nodes_of_this_package_and_no_twin():
    started = [call.args[0].value for call in calls("_node")]
    assert sorted(started) == ["ik_node", "pid_controller", "trajectory_publisher"]
    assert all((PACKAGE / "scripts" / name).is_file() for name in started)


def test_it_has_the_arguments_and_the_parameter_file_it_speaks_of():
    assert {call.args[0].value for call in calls("DeclareLaunchArgument")} == {
        "namespace",
        "params_file",
        "autostart",
    }
    path = calls("PathJoinSubstitution")[0].args[0].elts[1:]
    assert (PACKAGE / Path(*(part.value for part in path))).is_file()
