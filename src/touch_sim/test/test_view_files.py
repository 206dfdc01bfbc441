"""What a ROS desktop shows the suite with, as far as it can be looked at without one: names that must agree."""

import ast
import json
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
import yaml

from gaik_core import KinematicChain
from gaik_ros import path_markers, touch_adapter
from gaik_ros.record import SUITE
from touch_sim.description import ORIGIN_FRAME, touch_urdf

SOURCES = Path(__file__).parents[2]
PACKAGE = SOURCES / "touch_sim"
LAUNCH = PACKAGE / "launch" / "view.launch.py"
JOINTS = KinematicChain.load("touch_device").joint_names
POSITION = {"Point": "{}", "PointStamped": "point.{}"}
ELSEWHERE = {"robot_state_publisher", "rviz2"}  # packages of the desktop


@pytest.fixture(scope="module")
def tree():
    return ast.parse(LAUNCH.read_text(encoding="utf-8"), filename=LAUNCH.name)


def calls(tree, name):
    return [n for n in ast.walk(tree) if isinstance(n, ast.Call) and getattr(n.func, "id", "") == name]


def test_the_launch_file_has_the_arguments_it_uses(tree):
    compile(tree, LAUNCH.name, "exec")
    declared = {call.args[0].value for call in calls(tree, "DeclareLaunchArgument")}
    used = {
        call.args[0].value
        for name in ("LaunchConfiguration", "_value")
        for call in calls(tree, name)
        if isinstance(call.args[0], ast.Constant)
    }
    assert declared == used
    assert declared >= {"use_sim", "rviz", "record", "namespace", "params_file"}


def test_every_node_it_starts_is_there_and_only_the_twin_needs_use_sim(tree):
    started = [tuple(argument.value for argument in call.args[:2]) for call in calls(tree, "_node")]
    assert {name for _, name in started} == {
        *("touch_sim", "touch_adapter", "pid_controller", "ik_node", "trajectory_publisher"),
        *("path_markers", "record", "robot_state_publisher", "rviz2"),
    }
    for package, executable in started:
        if package not in ELSEWHERE:
            assert (SOURCES / package / "scripts" / executable).is_file()
    needed = (PACKAGE / "package.xml").read_text(encoding="utf-8")
    for package in ELSEWHERE:
        assert f"<exec_depend>{package}</exec_depend>" in needed


def test_it_sets_parameters_that_the_nodes_have(tree):
    names = {row.name for row in touch_adapter.TABLE.parameters} | {"bag", "autostart", "robot_description"}
    given = {key.value for node in ast.walk(tree) if isinstance(node, ast.Dict) for key in node.keys}
    assert given <= names | {"publish_frequency"}


def test_the_files_it_names_are_installed(tree):
    setup = (PACKAGE / "setup.py").read_text(encoding="utf-8")
    for join in calls(tree, "PathJoinSubstitution"):
        folder, name = [part.value for part in join.args[0].elts if isinstance(part, ast.Constant)]
        home = SOURCES.parent if folder == "config" else PACKAGE
        assert (home / folder / name).is_file()
    for tool in ("rviz", "plotjuggler", "foxglove"):
        assert f'"{tool}"' in setup
        assert len(list((PACKAGE / tool).glob("touch.*"))) == 1


def test_markers_and_forces_are_in_a_frame_of_the_urdf():
    links = {link.get("name") for link in ElementTree.fromstring(touch_urdf()).iter("link")}
    assert ORIGIN_FRAME in links
    for table in (path_markers.TABLE, touch_adapter.TABLE):
        assert next(row.default for row in table.parameters if row.name == "frame_id") == ORIGIN_FRAME


def test_rviz_shows_topics_that_the_launch_file_maps(tree):
    config = yaml.safe_load((PACKAGE / "rviz" / "touch.rviz").read_text(encoding="utf-8"))
    displays = config["Visualization Manager"]["Displays"]
    shown = {
        display[key]["Value"]
        for display in displays
        for key in ("Topic", "Description Topic")
        if key in display
    }
    (mapped,) = [
        node.generators[0].iter
        for node in ast.walk(tree)
        if isinstance(node, ast.ListComp) and "robot_description" in ast.unparse(node)
    ]
    assert shown == {f"/{topic}" for topic in ast.literal_eval(mapped)}
    assert {topic.lstrip("/") for topic in shown} <= set(SUITE)
    links = {link.get("name") for link in ElementTree.fromstring(touch_urdf()).iter("link")}
    assert config["Visualization Manager"]["Global Options"]["Fixed Frame"] in links
    (markers,) = [d for d in displays if d["Class"] == "rviz_default_plugins/MarkerArray"]
    assert set(markers["Namespaces"]) == {"desired", "desired_now", "followed", "followed_now"}


def series():
    """What PlotJuggler calls the series of a suite: topic, joint and field, or topic and field."""
    names = set()
    for topic, type_name in SUITE.items():
        kind = type_name.rsplit("/", 1)[-1]
        if kind == "JointState":
            names |= {f"/{topic}/{j}/{f}" for j in JOINTS for f in ("position", "velocity", "effort")}
        elif kind in POSITION:
            names |= {f"/{topic}/{POSITION[kind].format(axis).replace('.', '/')}" for axis in "xyz"}
    return names


def test_plotjuggler_draws_series_that_there_are():
    root = ElementTree.parse(PACKAGE / "plotjuggler" / "touch.xml").getroot()
    curves = [curve.get("name") for curve in root.iter("curve")]
    assert len(curves) == len(set(curves)) >= 12
    health = re.compile(
        r"/diagnostics/(touch_sim|pid_controller|ik_node|trajectory_publisher): loop/(period_p99_s|reached_hz)"
    )
    assert [name for name in curves if name not in series() and not health.fullmatch(name)] == []
    for splitter in root.iter("DockSplitter"):
        assert len(list(splitter)) == int(splitter.get("count")) == len(splitter.get("sizes").split(";"))


def test_foxglove_shows_panels_and_messages_that_there_are():
    layout = json.loads((PACKAGE / "foxglove" / "touch.json").read_text(encoding="utf-8"))
    panels = layout["configById"]

    def placed(node):
        return [node] if isinstance(node, str) else placed(node["first"]) + placed(node["second"])

    assert sorted(placed(layout["layout"])) == sorted(panels)
    paths = [path["value"] for panel in panels.values() for path in panel.get("paths", ())]
    known = {f"/{topic}.position[{k}]" for topic in ("joint_reference", "joint_states") for k in range(3)}
    known |= {f"/setpoint.{axis}" for axis in "xyz"} | {f"/tip.point.{axis}" for axis in "xyz"}
    assert set(paths) == known
    assert set(panels["3D!touch"]["topics"]) <= {f"/{topic}" for topic in SUITE}
    assert panels["3D!touch"]["layers"]["touch"]["topic"] == "/robot_description"
