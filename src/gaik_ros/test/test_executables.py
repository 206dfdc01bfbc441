"""The programs as a shell starts them: quiet ends, one line for a mistake, found by pip and `ros2 run` alike."""

import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import rclpy
from ros_bench import wait_until

from gaik_ros.reference_page import table

PACKAGE = Path(__file__).parents[1]
NODES = ("ik_node", "pid_controller", "trajectory_publisher")
OWN_DRIVER = ("--ros-args", "-p", "driver:=own")  # the others bring their own messages
QUIET = [*((node, ()) for node in (*NODES, "path_markers")), ("touch_adapter", OWN_DRIVER)]
PATIENCE = 60.0


def start(node, *arguments, interpreter=()):
    command = [sys.executable, *interpreter, str(PACKAGE / "scripts" / node), *arguments]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


@pytest.fixture
def up(context):
    """Waits until a node can be seen by others."""
    watcher = rclpy.create_node("watcher", context=context)
    yield lambda name: wait_until(lambda: name in watcher.get_node_names(), f"{name} did not come up")
    watcher.destroy_node()


def end(process):
    try:
        output, errors = process.communicate(timeout=PATIENCE)
    finally:
        process.kill()
    return process.returncode, output, errors


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=["SIGINT", "SIGTERM"])
@pytest.mark.parametrize(("node", "arguments"), QUIET, ids=[node for node, _ in QUIET])
def test_a_signal_ends_a_node_quietly(up, node, arguments, number):
    process = start(node, *arguments)
    up(node)
    process.send_signal(number)
    assert end(process) == (0, "", "")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=["SIGINT", "SIGTERM"])
@pytest.mark.parametrize("module", ["numpy", "rclpy", "gaik_ros.run"])
def test_a_signal_while_a_node_imports_ends_it_quietly(module, number):
    process = start("ik_node", interpreter=["-X", "importtime"])
    imported = re.compile(rf"import time:.*\| +{re.escape(module)}\n")
    assert any(imported.fullmatch(line) for line in process.stderr), module
    process.send_signal(number)
    code, output, errors = end(process)
    said = [line for line in errors.splitlines() if not line.startswith("import time:")]
    assert (code, output, said) == (0, "", [])


@pytest.mark.parametrize(
    ("node", "arguments", "complaint"),
    [
        ("ik_node", ["-p", "robot:=tuch"], "unknown robot 'tuch'.*touch_device"),
        ("ik_node", ["-p", "robot:=/no/such.yaml"], "/no/such.yaml"),
        (
            "ik_node",
            ["-p", "algebra:=octonion"],
            "'algebra' is 'octonion': it may be one of quaternion, conformal",
        ),
        ("ik_node", ["-p", "rule:=newton"], "'rule' is 'newton': it may be one of .*gradient_descent"),
        ("ik_node", ["-p", "learning_rate:=-1.0"], "'learning_rate' is -1.0"),
        ("ik_node", ["-p", "max_joint_speed:=[1.0]"], "'max_joint_speed' has 1 values"),
        ("pid_controller", ["-p", "gains.p:=.nan"], "'gains.p' is nan"),
        ("pid_controller", ["-p", "rate:=0"], "'rate' is 0.0: it may be from 1 to 10000 Hz"),
        ("pid_controller", ["-p", "dof_names:=[a, a]"], "'dof_names'"),
        ("trajectory_publisher", ["-p", "path:=points", "-p", "file:=/no.csv"], "/no.csv cannot be read"),
        ("pid_controller", ["-p", "gains.p:=.inf"], "'gains.p' is inf: it may be a finite number at least 0"),
        ("ik_node", ["-p", "use_sim_time:=maybe"], "use_sim_time.*maybe"),
        ("trajectory_publisher", ["-p", "path:=points"], "'file' is '': the path points needs a CSV file"),
        ("record", ["-p", "topics:=['two words']"], "'topics' is .*: 'two words' is no name of a topic"),
        (
            "touch_adapter",
            ["-p", "driver:=own", "-p", "state_topic:=joint_states"],
            "'state_topic' is 'joint_states': it may be any topic but joint_states",
        ),
        (
            "touch_adapter",
            ["-p", "driver:=own", "-p", "command_topic:=/joint_command"],
            "'command_topic' is '/joint_command': it may be any topic but joint_command",
        ),
        (
            "touch_adapter",
            ["-p", "driver:=own", "-p", "joint_names:=[a, b, b]"],
            "'joint_names' is .*'b', 'b'.*: every joint needs a name of its own",
        ),
        ("touch_adapter", ["-p", "driver:=own", "-p", "joint_signs:=[1, 1]"], "joint_signs are .*3 numbers"),
        ("trajectory_publisher", ["-p", "path:=square"], "one of circle, lemniscate, points"),
    ],
)
def test_a_bad_parameter_ends_the_node_with_one_line(node, arguments, complaint):
    code, output, errors = end(start(node, "--ros-args", *arguments))
    assert (code, output) == (2, "")
    assert errors.count("\n") == 1
    assert re.search(f"^{node}: .*{complaint}", errors)


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["--fast"], "unknown argument --fast"),
        (["--ros-args", "--params-file", "/no.yaml"], "/no.yaml"),
        (["--ros-args", "-r", "__ns:=1bad"], "1bad"),
    ],
)
def test_bad_arguments_end_a_node_with_a_clear_line(arguments, complaint):
    code, _, errors = end(start("pid_controller", *arguments))
    assert code == 2
    assert complaint in errors
    assert "Traceback" not in errors


def test_a_misspelt_parameter_is_pointed_out(up):
    process = start("pid_controller", "--ros-args", "-p", "gains.pp:=1.0")
    up("pid_controller")
    process.send_signal(signal.SIGINT)
    code, _, errors = end(process)
    assert code == 0
    assert "no parameter 'gains.pp' here; did you mean 'gains.p'?" in errors


@pytest.mark.parametrize("node", NODES)
def test_help_names_every_parameter_and_starts_nothing(node):
    code, output, errors = end(start(node, "--help"))
    assert (code, errors) == (0, "")
    for row in table(f"gaik_ros.{node}").parameters:
        assert f"  {row.name}\n" in output


def test_every_console_script_has_its_executable_for_ros2_run():
    declared = re.findall(r'"(\w+) = gaik_ros\.executables:\1"', (PACKAGE / "setup.py").read_text())
    scripts = sorted((PACKAGE / "scripts").iterdir())
    assert sorted(declared) == [script.name for script in scripts]
    assert all(os.access(script, os.X_OK) for script in scripts)
