"""What a fault changes in a user's suite is taken back, whatever ends it."""

import signal
import subprocess
import sys

import pytest
from rclpy.node import Node
from rclpy.parameter import Parameter
from spin_all_nodes import ros_context, suites, wait_until

from gaik_ros.faults.borrowed import changed
from gaik_ros.faults.remote import Remote
from gaik_ros.parameters import Parameter as Row
from gaik_ros.parameters import ParameterTable
from gaik_ros.run import running
from touch_sim.suite import SuiteOptions

INJECT = [sys.executable, "-m", "gaik_ros.faults.inject"]
PATIENCE = 240.0  # s


def test_a_fault_leaves_the_parameters_as_they_were():
    with suites(SuiteOptions(namespace="kept", rate=200.0)) as (user,):
        node = user.suite.controller
        command = [*INJECT, "good_parameters", "--namespace", "kept"]
        played = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=False)
        assert node.get_parameter("gains.waist.p").value is None
        assert node.values["gains.waist.p"] is None
        assert node.get_parameter("gains.p").value == 3.1
    assert played.returncode == 0, played.stdout + played.stderr
    assert not played.stderr


def gains(suite):
    return [suite.controller.values[name] for name in ("gains.p", "gains.d")]


def clocks(suite):
    nodes = (suite.twin, suite.controller, suite.ik)
    return [node.get_parameter("use_sim_time").value for node in nodes]


@pytest.mark.parametrize(
    ("fault", "look", "during"),
    [
        ("enable_in_motion", lambda suite: suite.controller._control.enabled, False),
        ("gains_under_load", gains, [1.0, 0.1]),
        ("clock_steps", clocks, [True, True, True]),
    ],
)
def test_a_fault_that_is_interrupted_leaves_the_suite_as_it_was(fault, look, during):
    with suites(SuiteOptions(namespace="stopped", rate=200.0)) as (user,):
        user.suite.ik.set_parameters([Parameter("use_sim_time", value=True)])
        before = look(user.suite)
        command = [*INJECT, fault, "--namespace", "stopped"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as player:
            try:
                wait_until(lambda: look(user.suite) == during, f"{fault} does not begin")
                player.send_signal(signal.SIGINT)
                said = player.communicate(timeout=PATIENCE)
            finally:
                player.kill()
        assert (player.returncode, *said) == (130, "", "")
        assert look(user.suite) == before


def test_a_node_that_does_not_take_its_parameters_back_is_told_of(capfd):
    def only_up(values):
        if values.level < node.values.level:
            raise ValueError("the level goes up only")

    with ros_context() as context:
        node, asking = Node("one_way", context=context), Node("asking", context=context)
        node.values = ParameterTable("one_way", (Row("level", 1.0, "", "a level"),)).declare(node, only_up)
        with running([node, asking], context), changed(Remote(asking), "one_way", {"level": 2.0}) as answer:
            assert answer == (True, "")
    said = capfd.readouterr().err
    assert "inject: one_way does not take back what it had (level: 1.0): the level goes up only\n" in said
