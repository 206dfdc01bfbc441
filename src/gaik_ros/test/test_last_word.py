"""The end of the nodes that move a device, as the device hears it."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest
import rclpy
from rclpy.qos import QoSProfile, ReliabilityPolicy
from ros_bench import NAMES, wait_until
from sensor_msgs.msg import JointState

from gaik_ros.conversions import joint_state, stamp_now
from gaik_ros.last_word import say_last
from gaik_ros.pid_controller import PidController
from gaik_ros.run import running

pytestmark = pytest.mark.slow
SCRIPTS = Path(__file__).parents[1] / "scripts"
PATIENCE = 60.0
STATES = joint_state(NAMES, position=[0.1, 0.7, 0.8])
REFERENCE = joint_state(NAMES, position=[0.5, 1.1, 1.2])
EFFORTS = joint_state(NAMES, effort=[0.02, -0.03, 0.01])
ENDING = {  # arguments; what the node is told, by topic; where it commands
    "pid_controller": ((), {"joint_states": STATES, "joint_reference": REFERENCE}, "joint_command"),
    "touch_adapter": (
        ("--ros-args", "-p", "driver:=own"),
        {"driver/joint_states": STATES, "joint_command": EFFORTS},
        "driver/joint_command",
    ),
}
DEAF = """
import os, signal, sys
import rclpy
from sensor_msgs.msg import JointState
rclpy.init()
node = rclpy.create_node("deaf")
node.create_subscription(JointState, sys.argv[1], print, 10)
while node.count_publishers(sys.argv[1]) == 0:
    rclpy.spin_once(node, timeout_sec=0.1)
print("stops", flush=True)
os.kill(os.getpid(), signal.SIGSTOP)
"""


@pytest.fixture
def beside(context):
    """Starts a program beside a device that hears its commands; returns both."""
    blocks, processes = [], []

    def begin(name, reliability=ReliabilityPolicy.RELIABLE):
        arguments, told, topic = ENDING[name]
        node, commands = rclpy.create_node("device", context=context), []
        profile = QoSProfile(depth=100, reliability=reliability)
        node.create_subscription(JointState, topic, commands.append, profile)
        publishers = {there: node.create_publisher(JointState, there, 10) for there in told}

        def tell():
            for there, message in told.items():
                stamp_now(message.header.stamp, node.get_clock())
                publishers[there].publish(message)

        node.create_timer(0.005, tell)
        command = [sys.executable, str(SCRIPTS / name), *arguments]
        processes.append(subprocess.Popen(command, stderr=subprocess.PIPE, text=True))
        block = running([node], context)
        block.__enter__()
        blocks.append(block)
        wait_until(lambda: commands and any(commands[-1].effort), "the device is not moved")
        return processes[-1], commands

    yield begin
    for process in processes:
        process.kill()
        process.communicate()
    for block in blocks:
        block.__exit__(None, None, None)


def end(process):
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=PATIENCE)
    assert "Traceback" not in errors  # a busy machine may make it say that it heard nothing for a while
    return process.returncode


@pytest.mark.parametrize(
    "reliability",
    [ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT],
    ids=["reliable", "best effort"],
)
@pytest.mark.parametrize("name", ENDING)
def test_the_device_is_told_zero_more_than_once_at_the_end(beside, name, reliability):
    process, commands = beside(name, reliability)
    assert end(process) == 0
    # One alone was lost in one end of ten.
    wait_until(
        lambda: len(commands) > 2 and not any(any(message.effort) for message in commands[-2:]),
        "the device is left with its last effort",
    )


@pytest.mark.parametrize("name", ENDING)
def test_one_that_hangs_does_not_hold_up_the_end(beside, name):
    process, _ = beside(name)
    deaf = subprocess.Popen([sys.executable, "-c", DEAF, ENDING[name][2]], stdout=subprocess.PIPE, text=True)
    try:
        assert any(line == "stops\n" for line in deaf.stdout)
        assert end(process) == 0
    finally:
        deaf.kill()
        deaf.communicate()


def test_nothing_is_said_once_the_context_is_down(context):
    node = PidController(context=context)
    publisher, said = node.create_publisher(JointState, "said", 1), []
    say_last(publisher, lambda: said.append(1), context)
    assert said
    rclpy.try_shutdown(context=context)
    said.clear()
    say_last(publisher, lambda: said.append(1), context)
    assert not said
    node.destroy_node()  # quietly
