"""The recorder beside real nodes, and as a program that is stopped."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from rclpy.node import Node
from ros_bench import Bench, overrides, wait_until
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from gaik_core import KinematicChain
from gaik_ros.bag_reader import read_bag
from gaik_ros.conversions import joint_state
from gaik_ros.ik_node import IkNode
from gaik_ros.record import Record
from gaik_ros.run import running

SCRIPT = Path(__file__).parents[1] / "scripts" / "record"
CHAIN = KinematicChain.load("touch_device")


def test_what_is_said_is_in_the_bag_to_the_last_bit(context, tmp_path):
    bench, heard = Bench(context), []
    record = Record(
        context=context, parameter_overrides=overrides(bag=str(tmp_path / "run"), topics=["talk"])
    )
    talk = bench.create_publisher(String, "talk", 10)
    with running([bench, IkNode(context=context), record], context):
        wait_until(
            lambda: bench.setpoint.get_subscription_count() == 3 and talk.get_subscription_count() == 1
        )
        bench.publishing = True
        wait_until(lambda: record.counts.get("/joint_states", 0) > 20)
        sent = CHAIN.forward(bench.angles) + np.outer(np.linspace(0.0, 1.0, 20), [0.01, 0.005, 0.0])
        for setpoint in sent:
            bench.send(setpoint)
            talk.publish(String(data="hello"))
            time.sleep(0.01)
        wait_until(lambda: len(bench.verdicts) and bench.verdict()["sequence"] == "20")
        wait_until(lambda: record.counts.get("/talk") == 20)
        wait_until(lambda: record.counts.get("/setpoint") == 20)
        heard = list(bench.verdicts)
        wait_until(lambda: record.counts.get("/ik_node/status") == len(heard))
    recording = read_bag(tmp_path / "run")
    assert (recording.setpoints().values == sent).all()
    assert recording.verdicts() == [{pair.key: pair.value for pair in v.values} for v in heard]
    states = recording.joints("joint_states", CHAIN.joint_names)
    assert (states.values == bench.angles).all()
    assert np.diff(recording.setpoints().time).min() > 0.0
    assert recording.joint_names("joint_reference") == CHAIN.joint_names


def test_only_the_suite_of_its_namespace_is_recorded(context, tmp_path):
    record = Record(
        context=context, namespace="/left", parameter_overrides=overrides(bag=str(tmp_path / "run"))
    )
    other, bench = Bench(context), Node("device", context=context, namespace="/left")
    other.publishing = True
    states = bench.create_publisher(JointState, "joint_states", 10)

    def told():
        states.publish(joint_state(CHAIN.joint_names, position=[0.1, 0.2, 0.3]))
        return record.counts.get("/left/joint_states", 0) > 5

    with running([other, bench, record], context):
        wait_until(told)
    assert "/joint_states" not in record.counts


def start(tmp_path, *arguments):
    command = [sys.executable, str(SCRIPT), "--ros-args", "-p", f"bag:={tmp_path / 'run'}", *arguments]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


@pytest.fixture
def talking(context):
    """A bench that publishes joint states, heard by `count` others."""
    bench = Bench(context)
    bench.publishing = True
    with running([bench], context):
        yield bench


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=["SIGINT", "SIGTERM"])
def test_a_signal_completes_the_bag(talking, tmp_path, number):
    process = start(tmp_path)
    try:
        wait_until(lambda: talking.states.get_subscription_count() == 1)
        talking.send([0.0, 0.0, 0.0])
        time.sleep(1.0)
        process.send_signal(number)
        _, said = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == 0
    assert "Traceback" not in said
    assert "messages of" in said
    recording = read_bag(tmp_path / "run")
    assert len(recording.messages("joint_states")) > 50
    assert recording.setpoints().values.tolist() == [[0.0, 0.0, 0.0]]


def test_it_ends_by_itself_after_the_duration(talking, tmp_path):
    process = start(tmp_path, "-p", "duration:=4")  # longer than discovery can take
    try:
        while process.poll() is None:
            talking.send([0.0, 0.0, 0.0])
            time.sleep(0.1)
        _, said = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == 0
    assert "Traceback" not in said
    times = read_bag(tmp_path / "run").setpoints().time
    assert times.size > 0
    assert np.ptp(times) < 4.0


def test_an_end_while_a_look_is_due_is_quiet(context, tmp_path):
    record = Record(
        context=context,
        parameter_overrides=overrides(bag=str(tmp_path / "run"), topics=["all"], duration=0.1),
    )
    time.sleep(1.5)  # the write that ends it and the first look are both due in the first round
    with running([record], context):
        wait_until(lambda: not context.ok())
    assert (tmp_path / "run" / "metadata.yaml").is_file()


def test_a_wanted_topic_that_nobody_spoke_on_is_named_at_the_end(talking, tmp_path):
    talk = talking.create_publisher(String, "talk", 10)
    process = start(tmp_path, "-p", "topics:=[talk, camera/inof, all]")
    try:
        wait_until(lambda: talk.get_subscription_count() == 1)
        for _ in range(10):
            talk.publish(String(data="hello"))
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == 0
    (line,) = (line for line in said.splitlines() if "nothing was heard" in line)
    assert "WARN" in line and line.endswith("nothing was heard on /camera/inof")


def test_a_bag_that_is_there_is_refused_in_one_line(tmp_path):
    (tmp_path / "run").mkdir()
    process = start(tmp_path)
    out, said = process.communicate(timeout=60)
    assert process.returncode == 2
    assert not out
    assert said.count("\n") == 1
    assert "exists already" in said


def test_a_topic_that_cannot_be_leaves_no_folder_in_the_way_of_the_next_try(context, tmp_path):
    with pytest.raises(ValueError, match="'two words' is no name of a topic"):
        Record(
            context=context, parameter_overrides=overrides(bag=str(tmp_path / "run"), topics=["two words"])
        )
    assert not list(tmp_path.iterdir())


def test_what_cannot_be_written_is_named(tmp_path):
    (tmp_path / "run").write_text("a file")
    process = start(tmp_path / "run")
    _, said = process.communicate(timeout=60)
    assert process.returncode == 2
    assert said.count("\n") == 1
