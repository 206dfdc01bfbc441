"""The node as its neighbours see it: real messages over real rclpy."""

import subprocess
import sys
import time

import numpy as np
import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped
from rcl_interfaces.srv import SetParameters
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from gaik_core import KinematicChain
from gaik_ros.conversions import joint_state
from gaik_ros.run import running
from touch_sim.touch_sim_node import TABLE, TouchSim

NAMES = ("waist", "shoulder", "elbow")
START = [0.1, 0.5, 0.7]
PATIENCE = 20.0  # s; far beyond what anything here takes, for a busy machine


class Bench(Node):
    """Hears and commands one twin."""

    def __init__(self, context, namespace=""):
        super().__init__("bench", context=context, namespace=namespace)
        self.states, self.tips = [], []
        self.create_subscription(JointState, "joint_states", self.states.append, 10)
        self.create_subscription(PointStamped, "tip", self.tips.append, 10)
        self.command = self.create_publisher(JointState, "joint_command", 10)
        self.reset = self.create_client(Trigger, "touch_sim/reset")
        self.set_parameters_client = self.create_client(SetParameters, "touch_sim/set_parameters")

    def send(self, effort, names=NAMES):
        self.command.publish(joint_state(names, effort=effort))

    def positions(self):
        return np.array(self.states[-1].position)


def wait_until(condition):
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end, "it did not come about"
        time.sleep(0.005)


def call(client, request):
    wait_until(client.service_is_ready)
    future = client.call_async(request)
    wait_until(future.done)
    return future.result()


@pytest.fixture
def context():
    context = rclpy.Context()
    rclpy.init(context=context)
    yield context
    rclpy.try_shutdown(context=context)


@pytest.fixture
def make(context):
    """Run one twin with the given parameters, and a bench connected to it."""
    open_blocks = []

    def start(**parameters):
        overrides = [Parameter(name.replace("__", "."), value=value) for name, value in parameters.items()]
        twin = TouchSim(context=context, parameter_overrides=overrides)
        bench = Bench(context)
        block = running([twin, bench], context)
        block.__enter__()
        open_blocks.append(block)
        wait_until(lambda: bench.states and bench.tips and bench.command.get_subscription_count() == 1)
        return twin, bench

    yield start
    for block in open_blocks:
        block.__exit__(None, None, None)


def test_it_rests_at_its_start_and_says_so_with_names_and_stamps(make):
    _, bench = make(start=START, rate=200)
    wait_until(lambda: len(bench.states) > 20)
    state, tip = bench.states[-1], bench.tips[-1]
    assert tuple(state.name) == NAMES
    np.testing.assert_allclose(state.position, START, atol=1e-15)
    np.testing.assert_array_equal(state.velocity, 0.0)
    point = [tip.point.x, tip.point.y, tip.point.z]
    np.testing.assert_allclose(point, KinematicChain.load("touch_device").forward(START), atol=1e-12)
    assert tip.header.frame_id == "touch_origin"
    stamps = [s.header.stamp.sec + 1e-9 * s.header.stamp.nanosec for s in bench.states]
    assert stamps == sorted(stamps)
    assert abs(stamps[-1] - time.time()) < PATIENCE


def test_an_effort_moves_each_joint_at_the_speed_of_the_model(make):
    _, bench = make(start=START, rate=200, gain=[1.0, 2.0, 0.5], time_constant=0.1, command_timeout=60)
    bench.send([0.02, -0.01, 0.04])
    wait_until(lambda: any(bench.states[-1].velocity))
    np.testing.assert_allclose(bench.states[-1].velocity, [0.2, -0.2, 0.2], atol=1e-12)
    np.testing.assert_allclose(bench.states[-1].effort, [0.02, -0.01, 0.04], atol=1e-15)


def test_an_effort_is_read_by_name(make):
    _, bench = make(start=START, rate=200, command_timeout=60)
    bench.send([0.03, 9.9, 0.01], names=("elbow", "gripper", "waist"))
    bench.send([0.03, 9.9, 0.01, 0.02], names=("elbow", "gripper", "waist", "shoulder"))
    wait_until(lambda: any(bench.states[-1].effort))
    np.testing.assert_allclose(bench.states[-1].effort, [0.01, 0.02, 0.03], atol=1e-15)


def test_a_bad_effort_is_refused_whole_and_the_last_good_one_stands(make):
    _, bench = make(start=START, rate=200, command_timeout=60)
    bench.send([0.001, 0.002, 0.003])
    wait_until(lambda: any(bench.states[-1].effort))
    for bad in ([0.5, np.nan, 0.5], [np.inf, 0.0, 0.0], [0.5, 0.5]):
        bench.command.publish(JointState(name=list(NAMES), effort=bad))
    bench.command.publish(JointState(name=["waist", "waist", "elbow"], effort=[0.5, 0.5, 0.5]))
    heard = len(bench.states)
    wait_until(lambda: len(bench.states) > heard + 40)
    np.testing.assert_allclose(bench.states[-1].effort, [0.001, 0.002, 0.003], atol=1e-15)
    assert np.isfinite(bench.positions()).all()


def test_a_command_that_is_not_renewed_stops_the_arm(make):
    _, bench = make(start=START, rate=200, command_timeout=0.25)
    bench.send([0.01, 0.0, 0.0])
    wait_until(lambda: bench.states[-1].velocity[0] > 0.0)
    wait_until(lambda: bench.states[-1].velocity[0] == 0.0)
    rest = bench.positions()
    # A quarter of a second at 0.2 rad/s is 0.05 rad; the stop at 0.98 rad is far.
    assert 0.14 < rest[0] < 0.4
    heard = len(bench.states)
    wait_until(lambda: len(bench.states) > heard + 40)
    np.testing.assert_array_equal(bench.positions(), rest)
    bench.send([0.01, 0.0, 0.0])
    wait_until(lambda: bench.states[-1].velocity[0] > 0.0)


def test_limits_and_effort_limit_hold(make):
    _, bench = make(start=START, rate=200, command_timeout=60, time_constant=1e-3, effort_limit=0.5)
    bench.send([50.0, 0.0, 50.0])
    wait_until(lambda: bench.positions()[0] == 0.98)
    wait_until(lambda: not any(bench.states[-1].velocity))
    waist, shoulder, elbow = bench.positions()
    np.testing.assert_allclose(bench.states[-1].effort, [0.5, 0.0, 0.5])
    assert waist == 0.98
    # The elbow's stop against the upper arm took the shoulder to its own stop.
    assert shoulder == pytest.approx(1.75, abs=1e-9)
    assert elbow - shoulder == pytest.approx(1.25, abs=1e-9)


def test_reset_puts_it_back_at_rest(make):
    _, bench = make(start=START, rate=200, command_timeout=60)
    bench.send([0.01, 0.01, 0.01])
    wait_until(lambda: bench.positions()[0] > 0.12)
    assert call(bench.reset, Trigger.Request()).success
    heard = len(bench.states)
    wait_until(lambda: len(bench.states) > heard + 20)
    np.testing.assert_allclose(bench.positions(), START, atol=1e-15)


def test_a_second_device_beside_it_is_warned_about_until_it_is_gone(make):
    _, bench = make()
    heard = []
    bench.create_subscription(DiagnosticArray, "/diagnostics", heard.append, 10)

    def topics():
        """What the newest message of the twin says of its topics."""
        reports = [status for message in heard for status in message.status]
        told = [status for status in reports if status.name == "touch_sim: topics"]
        return (told[-1].level, told[-1].message) if told else None

    wait_until(lambda: topics() == (b"\x00", "ok"))
    second = bench.create_publisher(JointState, "joint_states", 10)
    wait_until(lambda: topics() == (b"\x01", "2 publishers on /joint_states"))
    bench.destroy_publisher(second)
    wait_until(lambda: topics() == (b"\x00", "ok"))


def test_constants_change_in_motion_good_and_bad(make):
    twin, bench = make(start=START, rate=200, command_timeout=60)
    bench.send([0.001, 0.0, 0.0])
    wait_until(lambda: bench.states[-1].velocity[0] == pytest.approx(0.02))

    def set_parameter(name, value):
        request = SetParameters.Request(parameters=[Parameter(name, value=value).to_parameter_msg()])
        return call(bench.set_parameters_client, request).results[0]

    assert set_parameter("gain", 2).successful  # an integer is taken
    wait_until(lambda: bench.states[-1].velocity[0] == pytest.approx(0.04))
    for name, value in (
        ("gain", -1.0),
        ("gain", [1.0, 2.0]),
        ("time_constant", float("nan")),
        ("start", [3.0, 0.5, 0.7]),
        ("rate", 500.0),
    ):
        result = set_parameter(name, value)
        assert not result.successful, name
        assert name in result.reason or "read" in result.reason
    assert twin.values.gain == 2.0
    heard = len(bench.states)
    wait_until(lambda: len(bench.states) > heard + 20)
    assert bench.states[-1].velocity[0] == pytest.approx(0.04)


def test_an_encoder_reads_whole_counts(make):
    _, bench = make(start=START, rate=200, encoder__resolution=0.01, encoder__noise=0.02, encoder__seed=3)
    wait_until(lambda: len(bench.states) > 100)
    positions = np.array([state.position for state in bench.states])
    np.testing.assert_allclose(positions / 0.01, np.round(positions / 0.01), atol=1e-9)
    assert positions.std(axis=0).min() > 0.01
    np.testing.assert_allclose(positions.mean(axis=0), START, atol=0.02)


@pytest.mark.parametrize(
    ("argument", "words"),
    [
        ("robot:=tuch", "unknown robot 'tuch'"),
        ("start:=[2.0,0.5,0.5]", "joint waist is at 2 rad"),
        ("start:=[1,2]", ": parameter 'start' has 2 values"),
        ("gain:=-1", "'gain' is -1"),
        ("encoder.noise:=.nan", "'encoder.noise' is nan"),
    ],
)
def test_a_mistake_is_one_line_and_exit_code_2(argument, words):
    command = [sys.executable, "-m", "touch_sim.touch_sim_node", "--ros-args", "-p", argument]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 2, done.stderr
    assert words in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1


def test_help_names_every_parameter():
    command = [sys.executable, "-m", "touch_sim.touch_sim_node", "--help"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert all(f"  {row.name}\n" in done.stdout for row in TABLE.parameters)
