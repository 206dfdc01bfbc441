"""pid_controller as its neighbours see it, over real rclpy."""

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from ros_bench import NAMES, Bench, overrides, wait_until
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool, Trigger

from gaik_ros.conversions import joint_state
from gaik_ros.pid_controller import PidController
from gaik_ros.run import running


@pytest.fixture
def start(context):
    """Starts a controller at a moderate rate and the bench beside it."""
    blocks = []

    def build(publishing=True, wait=True, **values):
        bench = Bench(context)
        bench.publishing = bench.moving = publishing
        node = PidController(context=context, parameter_overrides=overrides(**{"rate": 200.0, **values}))
        block = running([bench, node], context)
        block.__enter__()
        blocks.append(block)
        wait_until(lambda: bench.states.get_subscription_count() and bench.count_publishers("joint_command"))
        wait_until(lambda: len(bench.commands) > 5)
        if publishing and wait:
            wait_until(lambda: node._control.mode == "holding")
        return bench, node

    yield build
    for block in blocks:
        block.__exit__(None, None, None)


def efforts(bench, since=0):
    return np.array([m.effort for m in bench.commands[since:]])


def test_it_starts_enabled_and_holds_where_the_device_is(start):
    bench, _ = start()
    before = bench.angles.copy()
    count = len(bench.commands)
    wait_until(lambda: len(bench.commands) > count + 50)
    assert tuple(bench.commands[-1].name) == NAMES
    np.testing.assert_array_equal(efforts(bench), 0.0)
    bench.angles = bench.angles + np.array([0.1, -0.1, 0.05])
    wait_until(lambda: np.abs(efforts(bench)[-1]).max() > 0.05)
    wait_until(lambda: np.abs(bench.angles - before).max() < 0.005)


def test_it_follows_a_reference_and_holds_when_it_falls_silent(start):
    bench, node = start(reference_timeout=0.3)
    goal = bench.angles + np.array([0.3, -0.2, 0.1])
    bench.referring = goal
    wait_until(lambda: np.abs(bench.angles - goal).max() < 0.01)
    assert node._control.mode == "following"
    bench.referring = None
    wait_until(lambda: node._control.mode == "holding")
    count = len(bench.commands)
    wait_until(lambda: len(bench.commands) > count + 50)
    assert np.abs(bench.angles - goal).max() < 0.01
    wait_until(lambda: bench.level("pid_controller: control") == b"\x01")


def test_lost_states_are_zero_effort_and_an_error_until_they_return(start):
    bench, node = start(state_timeout=0.2)
    bench.referring = bench.angles + 0.4
    wait_until(lambda: np.abs(efforts(bench)[-1]).max() > 0.01)
    bench.publishing = bench.moving = False
    wait_until(lambda: node._control.mode == "state_lost")
    count = len(bench.commands)
    wait_until(lambda: len(bench.commands) > count + 20)
    np.testing.assert_array_equal(efforts(bench, count + 1), 0.0)
    wait_until(lambda: bench.level("pid_controller: control") == b"\x02")
    bench.publishing = bench.moving = True
    wait_until(lambda: np.abs(bench.angles - bench.referring).max() < 0.01)


def test_states_that_only_repeat_an_old_stamp_are_lost_states(start):
    bench, node = start(state_timeout=0.2)
    bench.stamp = Time(sec=1)
    wait_until(lambda: node._control.mode == "state_lost")
    bench.stamp = None
    wait_until(lambda: node._control.mode == "holding")


def test_states_under_a_paused_clock_are_not_lost(start):
    bench, node = start(publishing=False, state_timeout=1.0, use_sim_time=True)
    clock = bench.create_publisher(Clock, "/clock", 10)
    wait_until(lambda: clock.get_subscription_count() > 0)

    def tick():
        clock.publish(Clock(clock=Time(sec=7)))
        return node.get_clock().now().nanoseconds == 7_000_000_000

    wait_until(tick)
    bench.stamp = Time(sec=7)
    bench.publishing = True
    wait_until(lambda: node._control.mode == "holding")
    modes = set()
    count = len(bench.commands)
    wait_until(lambda: modes.add(node._control.mode) or len(bench.commands) > count + 500)
    assert modes == {"holding"}


def test_what_is_missing_of_the_states_is_said(start, capfd):
    bench, node = start(state_timeout=0.2)
    bench.stamp = Time(sec=1)
    wait_until(lambda: node._control.mode == "state_lost")
    wait_until(lambda: "no news in joint_states" in capfd.readouterr().err)


@pytest.mark.parametrize(
    "bad",
    [
        joint_state(NAMES, position=[np.nan, 1.0, 1.0]),
        joint_state(NAMES[:2], position=[1.0, 1.0]),
        joint_state((), position=[]),
        joint_state((*NAMES, "waist"), position=[1.0] * 4),
        joint_state(("a", "b", "c"), position=[1.0] * 3),
        joint_state(NAMES, position=[1.0, 1.0]),
        joint_state(NAMES, position=[1.0] * 3, velocity=[np.inf] * 3),
    ],
    ids=["nan", "short", "empty", "duplicate", "foreign", "few values", "infinite velocity"],
)
def test_a_bad_reference_is_refused_and_the_device_stays(start, bad):
    bench, node = start()
    before = bench.angles.copy()
    bench.reference.publish(bad)
    wait_until(lambda: node._watch.refused.get("joint_reference") == 1)
    assert node._control.mode == "holding"
    np.testing.assert_allclose(bench.angles, before, atol=1e-9)


def test_bad_states_do_not_count_as_states(start):
    bench, node = start(publishing=False, state_timeout=0.3)
    wait_until(lambda: bench.states.get_subscription_count() > 0)
    bad = (joint_state(NAMES, position=[np.nan] * 3), joint_state(NAMES[1:], position=[0.0] * 2))
    for count, message in enumerate(bad, start=1):
        bench.states.publish(message)
        wait_until(lambda count=count: node._watch.refused.get("joint_states") == count)
    assert node._control.mode == "waiting"
    bench.states.publish(joint_state((*NAMES[::-1], "other"), [3.0, 2.0, 1.0, 9.0], velocity=[np.nan] * 4))
    wait_until(lambda: node._control.mode == "holding")
    assert node._control.held.tolist() == [1.0, 2.0, 3.0]


def test_disable_lets_go_and_enable_takes_hold_without_a_jump(start):
    bench, _ = start()
    bench.referring = bench.angles.copy()
    assert bench.call("pid_controller/enable", SetBool.Request(data=False)).success
    bench.angles = bench.angles + 0.5
    count = len(bench.commands)
    wait_until(lambda: len(bench.commands) > count + 20)
    np.testing.assert_array_equal(efforts(bench, count + 2), 0.0)
    enabled = len(bench.commands)
    assert bench.call("pid_controller/enable", SetBool.Request(data=True)).success
    wait_until(lambda: np.abs(bench.angles - bench.referring).max() < 0.01)
    # A jump to the reference would be the full effort of 1 at once; at 200 Hz the approach begins with 0.1.
    assert np.abs(np.diff(efforts(bench, enabled), axis=0)).max() < 0.4


def test_reset_is_answered(start):
    bench, _ = start()
    assert bench.call("pid_controller/reset", Trigger.Request()).success


def test_gains_change_whole_or_not_at_all(start):
    bench, node = start()
    refused = bench.change("pid_controller", gains__p=5.0, gains__d=float("nan"))
    assert not refused.successful
    assert "gains.d" in refused.reason
    assert not bench.change("pid_controller", gains__p=-1.0).successful
    assert not bench.change("pid_controller", gains__p=[1.0, 2.0]).successful
    assert node._control.pid.gains.p.tolist() == [3.1] * 3
    assert bench.change("pid_controller", gains__p=4, gains__shoulder__p=6, gains__i=[0, 1, 2]).successful
    assert node._control.pid.gains.p.tolist() == [4.0, 6.0, 4.0]
    assert node._control.pid.gains.i.tolist() == [0.0, 1.0, 2.0]
    assert not bench.change("pid_controller", rate=500.0).successful  # read-only


def test_it_lets_go_when_it_ends(context):
    bench = Bench(context)
    bench.publishing = True
    with running([bench], context):
        with running([PidController(context=context, parameter_overrides=overrides(rate=200.0))], context):
            wait_until(
                lambda: bench.states.get_subscription_count() and bench.count_publishers("joint_command")
            )
            bench.referring = bench.angles + 1.0
            wait_until(lambda: bench.commands and np.abs(bench.commands[-1].effort).max() > 0.05)
        wait_until(lambda: not np.abs(bench.commands[-1].effort).any())


def test_a_subscriber_that_cannot_hear_is_told_of(start, context):
    bench, _ = start()
    quiet = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    bench.create_publisher(JointState, "joint_reference", quiet)
    wait_until(
        lambda: "does not fit" in getattr(bench.reported("pid_controller: topics"), "message", ""),
        "the mismatch was not reported",
    )
    assert bench.reported("pid_controller: topics").level == b"\x01"


@pytest.mark.slow
def test_a_stranger_whose_qos_does_not_fit_is_forgotten_once_it_is_gone(start):
    bench, _ = start()
    unreliable = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    lasting = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)

    def said():
        return getattr(bench.reported("pid_controller: topics"), "message", "")

    for _ in range(2):
        publisher = bench.create_publisher(JointState, "joint_reference", unreliable)
        subscription = bench.create_subscription(JointState, "joint_command", bench.commands.append, lasting)
        wait_until(lambda: "RELIABILITY on /joint_reference" in said(), "the publisher was not reported")
        wait_until(lambda: "DURABILITY on /joint_command" in said(), "the subscription was not reported")
        count = len(bench.diagnostics)
        wait_until(lambda count=count: len(bench.diagnostics) > count + 4)
        assert "RELIABILITY on /joint_reference" in said()  # it stays as long as they do
        bench.destroy_publisher(publisher)
        bench.destroy_subscription(subscription)
        wait_until(lambda: said() and "does not fit" not in said(), "they are still reported")
