"""The adapter between the real nodes and drivers that are played as the known ones are."""

import time

import numpy as np
import pytest
from geometry_msgs.msg import PointStamped, Wrench, WrenchStamped
from rclpy.node import Node
from ros_bench import Bench, overrides, wait_until
from sensor_msgs.msg import JointState

from gaik_core import KinematicChain
from gaik_ros.conversions import joint_state, stamp_now
from gaik_ros.deadline_loop import DeadlineLoop
from gaik_ros.health import ERROR, OK
from gaik_ros.ik_node import IkNode
from gaik_ros.pid_controller import PidController
from gaik_ros.run import running
from gaik_ros.touch_adapter import TouchAdapter

CHAIN = KinematicChain.load("touch_device")
DAMPING = 0.05  # N·m·s/rad


class PlayedDriver(Node):
    """A viscous Touch behind a driver as AleBarte/Geomagic_Touch_ROS2_Drivers is: six joints, the waist's sign turned,
    the elbow from the upper arm, no velocity; a force with x to the right, y away from the user, z up, held.
    """

    def __init__(self, context, rate=500.0):
        super().__init__("played_driver", context=context)
        self.angles = np.array([0.1, 0.7, 0.8])  # ours, as HDAPI has them
        self.force = np.zeros(3)  # in HDAPI's axes, which are ours
        self.heard = []
        self.publishing = True
        self.states = self.create_publisher(JointState, "touch/joint_states", 10)
        self.create_subscription(WrenchStamped, "touch/force_feedback", self._on_force, 10)
        self.loop = DeadlineLoop(rate, self._tick)

    def _on_force(self, message):
        force = message.wrench.force
        self.force = np.array([force.x, force.z, -force.y])
        self.heard.append(self.force)

    def _tick(self, dt):
        effort = CHAIN.jacobian(self.angles).T @ self.force
        self.angles = self.angles + dt / DAMPING * effort
        if self.publishing:
            waist, shoulder, elbow = self.angles.tolist()
            names = ("waist", "shoulder", "elbow", "yaw", "pitch", "roll")
            message = joint_state(names, position=[-waist, shoulder, elbow - shoulder, 0.1, 0.2, 0.3])
            stamp_now(message.header.stamp, self.get_clock())
            self.states.publish(message)


@pytest.fixture
def start(context):
    """Runs nodes together until the test is over."""
    stack = []

    def run(*nodes):
        manager = running(nodes, context)
        manager.__enter__()
        stack.append(manager)

    yield run
    for manager in stack:
        manager.__exit__(None, None, None)


def adapter(context, driver="geomagic_touch_ros2_drivers", **values):
    return TouchAdapter(context=context, parameter_overrides=overrides(driver=driver, **values))


def test_the_suite_moves_a_driver_s_device_to_its_setpoints(context, start):
    device, bench = PlayedDriver(context), Bench(context)
    tips = []
    bench.create_subscription(PointStamped, "tip", tips.append, 10)
    start(device, bench, adapter(context), IkNode(context=context), PidController(context=context))
    wait_until(lambda: tips, "no tip")
    bench.publishing = False
    for target in ([0.05, 0.03, 0.0], [-0.04, 0.05, 0.03], [0.0, 0.0, 0.0]):
        end = time.monotonic() + 20.0
        while np.linalg.norm(CHAIN.forward(device.angles) - target) > 2e-3:
            assert time.monotonic() < end, f"{target} was not reached"
            bench.send(target)
            time.sleep(0.2)
        point = tips[-1].point
        assert np.linalg.norm([point.x, point.y, point.z] - CHAIN.forward(device.angles)) < 0.01
    assert tips[-1].header.frame_id == "touch_origin"
    assert max(np.linalg.norm(force) for force in device.heard) <= 2.0 + 1e-9
    assert set(bench.results()) == {"reached"}


class Wires(Node):
    """Both ends of an adapter, held by the test."""

    def __init__(self, context, command=Wrench, states="driver/joint_states", commands="driver/force"):
        super().__init__("wires", context=context)
        self.states, self.commands = [], []
        self.create_subscription(JointState, "joint_states", self.states.append, 100)
        self.create_subscription(command, commands, self.commands.append, 100)
        self.driver = self.create_publisher(JointState, states, 10)
        self.controller = self.create_publisher(JointState, "joint_command", 10)

    def connected(self, others=0):
        return self.driver.get_subscription_count() and self.controller.get_subscription_count() > others

    def send(self, angles, efforts, names=CHAIN.joint_names, velocity=None):
        message = joint_state(names, position=angles, velocity=velocity)
        stamp_now(message.header.stamp, self.get_clock())
        self.driver.publish(message)
        time.sleep(0.02)
        self.controller.publish(joint_state(CHAIN.joint_names, effort=efforts))

    def force(self):
        message = self.commands[-1]
        force = getattr(message, "wrench", message).force
        return np.array([force.x, force.y, force.z])


def pushed(wires, angles, efforts):
    """Send until the driver is pushed; return the force."""

    def tried():
        wires.send(angles, efforts)
        time.sleep(0.02)
        return wires.commands and wires.force().any()

    wait_until(tried, "the driver was not pushed")
    return wires.force()


def test_the_force_is_that_of_the_efforts_and_ends_with_the_commands(context, start):
    wires = Wires(context)
    start(wires, adapter(context, "openhaptics", max_force=50.0))
    wait_until(wires.connected)
    angles, efforts = [0.2, 0.7, 0.9], [0.02, -0.05, 0.03]
    force = pushed(wires, angles, efforts)
    np.testing.assert_allclose(CHAIN.jacobian(angles).T @ force, efforts, atol=1e-9)
    wait_until(lambda: not wires.force().any(), "the driver holds the last force")


def test_the_force_ends_with_the_driver_s_states(context, start):
    wires, bench = Wires(context), Bench(context)
    start(wires, bench, adapter(context, "openhaptics"))
    wait_until(lambda: wires.connected(others=1))

    def told_all_is_well():
        pushed(wires, [0.2, 0.7, 0.9], [0.02, -0.05, 0.03])
        return bench.level("touch_adapter: driver") == OK

    wait_until(told_all_is_well)

    def commanded_without_states():
        wires.controller.publish(joint_state(CHAIN.joint_names, effort=[0.02, -0.05, 0.03]))
        time.sleep(0.02)
        return not wires.force().any()

    wait_until(commanded_without_states, "the driver is pushed from a state that is too old")
    wait_until(lambda: bench.level("touch_adapter: driver") == ERROR)
    before = len(wires.commands)
    for _ in range(10):
        commanded_without_states()
    assert all(not c.force.x and not c.force.y and not c.force.z for c in wires.commands[before:])


def test_the_force_ends_with_the_adapter(context):
    wires = Wires(context)
    with running([wires], context):
        with running([adapter(context, "openhaptics", command_timeout=30.0, state_timeout=30.0)], context):
            wait_until(wires.connected)
            pushed(wires, [0.2, 0.7, 0.9], [0.02, -0.05, 0.03])
        wait_until(lambda: not wires.force().any(), "the driver was left with a force")


def test_efforts_are_passed_to_a_driver_that_takes_them(context, start):
    wires = Wires(context, JointState, commands="driver/joint_command")
    start(wires, adapter(context, "own", relative=True, joint_signs=[-1, 1, 1], max_force=50.0))
    wait_until(wires.connected)

    def sent():
        wires.send([0.0, 0.5, 0.1], [0.1, 0.2, 0.3], velocity=[1.0, 2.0, 3.0])
        time.sleep(0.02)
        return wires.commands and any(wires.commands[-1].effort)

    wait_until(sent)
    # The elbow's motor sits on the upper arm, so that the shoulder's has to do its share too.
    np.testing.assert_allclose(wires.commands[-1].effort, [-0.1, 0.5, 0.3], atol=1e-12)
    np.testing.assert_allclose(wires.states[-1].position, [0.0, 0.5, 0.6], atol=1e-12)
    np.testing.assert_allclose(wires.states[-1].velocity, [-1.0, 2.0, 5.0], atol=1e-12)


@pytest.mark.parametrize("max_force", [0.0, 0.5])
def test_the_limit_holds_for_a_driver_that_takes_efforts_too(context, start, max_force):
    wires = Wires(context, JointState, commands="driver/joint_command")
    start(wires, adapter(context, "own", max_force=max_force))
    wait_until(wires.connected)
    angles, efforts = np.array([0.2, 0.7, 0.9]), np.array([0.9, 0.9, 0.9])

    def sent():
        wires.send(angles, efforts)
        time.sleep(0.02)
        return len(wires.commands) > 5

    wait_until(sent)
    wires.commands.clear()
    wait_until(sent)
    for message in wires.commands:
        force = np.linalg.solve(CHAIN.jacobian(angles).T, message.effort)
        assert np.linalg.norm(force) <= max_force + 1e-9
    if max_force:
        wait_until(lambda: sent() and any(wires.commands[-1].effort))
        np.testing.assert_allclose(np.cross(wires.commands[-1].effort, efforts), 0.0, atol=1e-9)


def test_a_limit_where_no_force_can_be_known_is_refused(context, start):
    arm = KinematicChain.load("arm5")
    own = {"robot": "arm5", "joint_names": list(arm.joint_names), "joint_signs": [1.0] * 5}
    with pytest.raises(ValueError, match=r"^parameter 'max_force' is 0.0: .* arm5 do not$"):
        adapter(context, "own", **own, max_force=0.0)
    with pytest.raises(ValueError, match=r"^parameter 'command_type' is .* arm5 do not$"):
        adapter(context, "openhaptics", **own)
    bench = Bench(context)
    start(bench, adapter(context, "own", **own))
    answer = bench.change("touch_adapter", max_force=1.0)
    assert not answer.successful
    assert "'max_force' is 1.0" in answer.reason


def test_bad_messages_are_refused_and_nothing_is_pushed(context, start):
    wires, bench = Wires(context), Bench(context)
    start(wires, bench, adapter(context, "openhaptics"))
    wait_until(lambda: wires.connected(others=1))
    wires.send([0.1, 0.2], [0.0, 0.0, 0.0], names=("waist", "elbow"))
    wires.send([0.1, float("nan"), 0.3], [0.1, 0.1, 0.1])
    wires.controller.publish(joint_state(CHAIN.joint_names, effort=[float("inf"), 0.0, 0.0]))
    wait_until(lambda: bench.reported("touch_adapter: topics") is not None)

    def refused():
        values = {v.key: v.value for v in bench.reported("touch_adapter: topics").values}
        return values.get("refused_driver/joint_states") == "2" and values.get("refused_joint_command") == "1"

    wait_until(refused)
    assert not wires.states
    assert all(not c.force.x and not c.force.y and not c.force.z for c in wires.commands)


def test_a_velocity_is_passed_on_with_its_own_state_only(context, start):
    wires = Wires(context)
    start(wires, adapter(context, "openhaptics"))
    wait_until(wires.connected)

    def told(velocity, expected):
        wires.send([0.1, 0.7, 0.8], [0.0] * 3, velocity=velocity)
        return wires.states and list(wires.states[-1].velocity) == expected

    wait_until(lambda: told([1.0, 2.0, 3.0], [1.0, 2.0, 3.0]), "no velocity is passed on")
    wait_until(lambda: told(None, []), "a velocity of before is passed on with a state that has none")


@pytest.mark.parametrize("velocity", [[float("nan"), 0.0, 0.0], [1.0, 2.0]], ids=["nan", "too few"])
def test_a_bad_velocity_costs_the_velocity_and_not_the_position(context, start, velocity):
    wires, bench = Wires(context), Bench(context)
    start(wires, bench, adapter(context, "openhaptics"))
    wait_until(lambda: wires.connected(others=1))

    def told(heard=5):
        wires.send([0.1, 0.7, 0.8], [0.02, -0.05, 0.03], velocity=velocity)
        return len(wires.states) > heard and wires.commands and wires.force().any()

    wait_until(told, "the states, or the force, are lost")
    for state in wires.states:
        np.testing.assert_allclose(state.position, [0.1, 0.7, 0.8], atol=1e-12)
        assert not state.velocity

    def counted():
        told()
        status = bench.reported("touch_adapter: topics")
        return status and any(v.key == "refused_velocity on driver/joint_states" for v in status.values)

    wait_until(counted, "the refusal is not told")


def test_the_names_that_a_driver_uses_are_parameters(context, start):
    wires = Wires(context, states="geomagic_touch_x/joint_states", commands="geomagic_touch_x/command/wrench")
    start(wires, adapter(context, "geomagic_touch_x_ros2", joint_offsets=[0.1, 0.0, -0.2]))
    wait_until(wires.connected)
    names = [f"{kind}_angle_{n}" for kind in ("joint", "gimbal") for n in (1, 2, 3)]

    def told():
        wires.send([0.3, 0.7, 0.6, 0.0, 0.0, 0.0], [0.0] * 3, names=names, velocity=[9.0] * 6)
        time.sleep(0.02)
        return wires.states

    wait_until(told)
    assert wires.states[-1].name == list(CHAIN.joint_names)
    np.testing.assert_allclose(wires.states[-1].position, [0.2, 0.7, 0.8], atol=1e-12)
    assert not wires.states[-1].velocity  # that driver's velocities are not rates


def test_a_driver_whose_messages_are_not_installed_is_refused_in_one_line(context):
    with pytest.raises(ValueError, match=r"omni_msgs/msg/OmniFeedback.*is omni_msgs installed"):
        adapter(context, "geomagic_touch_ros2")
