"""ik_node as its neighbours see it: setpoints in, references and verdicts out, over real rclpy."""

import math
import re
import time

import numpy as np
import pytest
from ros_bench import NAMES, Bench, overrides, wait_until
from std_srvs.srv import Trigger

from gaik_core import KinematicChain
from gaik_core.paths import Circle
from gaik_ros.ik_node import IkNode
from gaik_ros.run import running

CHAIN = KinematicChain.load("touch_device")
NEAR, FAR = [0.0, 0.02, 0.01], [0.05, 0.05, 0.0]


@pytest.fixture
def start(context):
    """Starts an ik_node and the bench beside it; the device stands still and publishes."""
    blocks = []

    def build(publishing=True, **values):
        bench = Bench(context)
        bench.publishing = publishing
        node = IkNode(context=context, parameter_overrides=overrides(**values))
        block = running([bench, node], context)
        block.__enter__()
        blocks.append(block)
        wait_until(
            lambda: bench.setpoint.get_subscription_count() >= 2 and bench.states.get_subscription_count()
        )
        wait_until(lambda: bench.count_publishers("joint_reference") >= 2)
        if publishing:
            wait_until(lambda: node._raw_state is not None)
        return bench, node

    yield build
    for block in blocks:
        block.__exit__(None, None, None)


def tip(message):
    return CHAIN.forward(np.array(message.position))


def seconds(message):
    return message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec


def test_one_setpoint_goes_all_the_way_under_the_speed_limit_and_the_reference_goes_on(start):
    bench, _ = start(max_joint_speed=1.0)
    bench.send(FAR)
    wait_until(lambda: bench.references and np.linalg.norm(tip(bench.references[-1]) - FAR) < 1e-6)
    assert bench.results() == ["reached"]
    assert float(bench.verdict()["error_m"]) < 1e-6
    positions = np.array([m.position for m in bench.references])
    stamps = np.array([seconds(m) for m in bench.references])
    steps = np.abs(np.diff(positions, axis=0)).max(axis=1)
    # The stamp is taken a moment after the reference is advanced: a thread may be held up between the two.
    assert (np.cumsum(steps) <= 1.0 * (stamps[1:] - stamps[0]) + 0.05).all()
    assert steps.max() <= 1.0 * 0.02 + 1e-9  # two periods at most, whatever stalls
    assert np.abs(positions[0] - bench.angles).max() < 0.05
    assert all(tuple(m.name) == NAMES for m in bench.references)
    assert np.abs([m.velocity for m in bench.references]).max() <= 1.0 + 1e-9
    count = len(bench.references)
    wait_until(lambda: len(bench.references) > count + 50, "the heartbeat stopped")
    assert list(bench.references[-1].position) == list(positions[-1])
    assert list(bench.references[-1].velocity) == [0.0, 0.0, 0.0]


def test_a_setpoint_before_the_first_state_waits_and_says_so(start):
    bench, _ = start(publishing=False)
    bench.send(NEAR)
    wait_until(lambda: bench.results() == ["waiting"])
    assert not bench.references
    bench.publishing = True
    wait_until(lambda: bench.results() == ["waiting", "reached"])
    assert bench.verdict(0)["sequence"] == bench.verdict(1)["sequence"] == "1"


def test_a_setpoint_that_waits_too_long_for_a_state_is_refused_and_moves_nothing_later(start):
    bench, node = start(publishing=False)
    bench.send(FAR)
    wait_until(lambda: bench.results() == ["waiting", "refused"])
    assert bench.verdict()["sequence"] == "1"
    assert re.fullmatch(
        r"refused, waited \d+\.\d s for joint_states to start from", bench.verdicts[-1].message
    )
    bench.publishing = True
    wait_until(lambda: node._raw_state is not None)
    bench.send(NEAR)
    wait_until(lambda: bench.results()[2:] == ["reached"])
    wait_until(lambda: bench.references and np.linalg.norm(tip(bench.references[-1]) - NEAR) < 1e-6)
    assert bench.results() == ["waiting", "refused", "reached"]


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 1e308, 11.0])
def test_absurd_setpoints_are_refused_and_the_last_good_reference_stands(start, bad):
    bench, _ = start()
    bench.send(NEAR)
    wait_until(lambda: bench.references and np.linalg.norm(tip(bench.references[-1]) - NEAR) < 1e-6)
    for axis in range(3):
        bench.send(np.where(np.arange(3) == axis, bad, NEAR))
    wait_until(lambda: bench.results() == ["reached", "refused", "refused", "refused"])
    count = len(bench.references)
    wait_until(lambda: len(bench.references) > count + 10)
    assert np.linalg.norm(tip(bench.references[-1]) - NEAR) < 1e-6
    bench.send(FAR)
    wait_until(lambda: bench.results()[-1] == "reached")


def test_the_smallest_numbers_are_setpoints_too(start):
    bench, _ = start()
    bench.send([1e-320, -5e-324, 1e-300])
    wait_until(lambda: bench.results() == ["reached"])


def test_an_unreachable_setpoint_is_answered_with_the_nearest_point(start):
    bench, _ = start(max_joint_speed=20.0)
    for target, result in (([0.0, 0.0, 5.0], "unreachable"), ([0.0, -0.02, -0.17], "limited")):
        count = len(bench.verdicts)
        bench.send(target)
        wait_until(lambda count=count: len(bench.verdicts) > count)
        verdict = bench.verdict()
        nearest = np.array([float(verdict[f"nearest_{axis}"]) for axis in "xyz"])
        assert verdict["result"] == result
        assert float(verdict["error_m"]) == pytest.approx(np.linalg.norm(nearest - target), rel=1e-6)
        wait_until(lambda nearest=nearest: np.linalg.norm(tip(bench.references[-1]) - nearest) < 1e-6)
    assert "joint" in bench.verdict()


def test_of_a_burst_the_newest_wins_and_the_others_are_counted(start):
    bench, node = start()
    for k in range(300):
        bench.send([0.0001 * k, 0.02, 0.01])
    wait_until(lambda: bench.verdicts and float(bench.verdict()["x"]) == 0.0001 * 299)
    verdicts = [bench.verdict(k) for k in range(len(bench.verdicts))]
    sequences = [int(v["sequence"]) for v in verdicts]
    assert sequences == sorted(set(sequences))
    assert len(verdicts) + sum(int(v["superseded"]) for v in verdicts) == sequences[-1] == node._received
    wait_until(lambda: np.linalg.norm(tip(bench.references[-1]) - [0.0299, 0.02, 0.01]) < 1e-6)


@pytest.mark.parametrize("algebra", ["quaternion", "conformal"])
def test_a_stream_is_answered_one_by_one_with_the_velocity_of_its_motion(start, algebra):
    bench, _ = start(algebra=algebra, max_joint_speed=20.0)
    circle, rate, lap = Circle(), 100.0, 6.3
    began = time.monotonic()
    for k in range(250):
        time.sleep(max(0.0, began + k / rate - time.monotonic()))
        bench.send(circle.position(2 * np.pi * k / rate / lap))
    wait_until(
        lambda: (
            len(bench.verdicts) + sum(int(bench.verdict(k)["superseded"]) for k in range(len(bench.verdicts)))
            == 250
        )
    )
    assert set(bench.results()) == {"reached"}
    worst = []
    for message in bench.references[100:]:
        velocity = np.array(message.velocity)
        if velocity.any():
            phase = np.arctan2(tip(message)[1] / math.cos(circle.tilt), tip(message)[0])
            exact = 2 * np.pi / lap * circle.derivative(phase)
            felt = CHAIN.jacobian(np.array(message.position)) @ velocity
            worst.append(np.linalg.norm(felt - exact) / np.linalg.norm(exact))
    assert len(worst) > 50
    assert np.median(worst) < 0.1
    wait_until(lambda: not np.array(bench.references[-1].velocity).any(), "the velocity outlived the stream")


def test_a_dead_stream_stops_the_arm_in_stream_mode_only(start):
    bench, _ = start(setpoint_mode="stream", setpoint_timeout=0.1, max_joint_speed=0.2)
    bench.send(FAR)
    wait_until(lambda: len(bench.references) > 60)
    positions = np.array([m.position for m in bench.references])
    np.testing.assert_array_equal(positions[-1], positions[-10])
    travelled = np.abs(positions[-1] - positions[0]).max()
    assert travelled <= 0.2 * (0.1 + 0.01) + 0.02  # the timeout and a period, and room for a late tick
    assert np.linalg.norm(tip(bench.references[-1]) - FAR) > 0.01
    bench.send(FAR)
    moved = len(bench.references)
    wait_until(lambda: np.abs(np.array(bench.references[-1].position) - positions[-1]).max() > 0.005)
    assert len(bench.references) > moved


def test_solve_from_here_starts_where_the_device_has_been_moved_to(start):
    bench, node = start(max_joint_speed=20.0)
    bench.send(NEAR)
    wait_until(lambda: bench.results() == ["reached"])
    bench.angles = np.array([-0.5, 0.3, 0.4])
    wait_until(lambda: node._measured() is not None and abs(node._measured()[0] + 0.5) < 1e-9)
    assert bench.call("ik_node/solve_from_here", Trigger.Request()).success
    wait_until(lambda: bench.results() == ["reached", "reached"])
    wait_until(lambda: np.linalg.norm(tip(bench.references[-1]) - NEAR) < 1e-6)


def test_solve_from_here_without_a_state_says_no(start):
    bench, _ = start(publishing=False)
    answer = bench.call("ik_node/solve_from_here", Trigger.Request())
    assert not answer.success
    assert "joint_states" in answer.message


def test_parameters_change_in_motion_good_and_bad(start):
    bench, node = start(max_joint_speed=0.2)
    bench.send(FAR)
    wait_until(lambda: len(bench.references) > 5)
    refused = bench.change("ik_node", max_joint_speed=-1.0, tolerance=1e-4)
    assert not refused.successful
    assert "max_joint_speed" in refused.reason
    assert node.values.tolerance == 1e-6
    assert not bench.change("ik_node", rule="adam", learning_rate=math.nan).successful
    assert bench.change("ik_node", max_joint_speed=[3, 3, 3], rule="adam", learning_rate=0.01).successful
    wait_until(lambda: np.linalg.norm(tip(bench.references[-1]) - FAR) < 1e-6)


def test_health_is_reported_and_a_second_publisher_is_noticed(start):
    bench, _ = start()
    for k in range(20):
        bench.send([0.001 * k, 0.02, 0.01])
        time.sleep(0.01)
    bench.send([math.nan, 0.0, 0.0])
    wait_until(lambda: bench.results()[-1:] == ["refused"])
    bench.diagnostics.clear()
    wait_until(lambda: bench.reported("ik_node: topics"))
    loop = {pair.key: pair.value for pair in bench.reported("ik_node: loop").values}
    assert float(loop["rate_hz"]) == 100.0
    assert {"period_p50_s", "period_p99_s", "period_max_s", "overruns"} <= set(loop)
    figures = {pair.key: pair.value for pair in bench.reported("ik_node: setpoints").values}
    assert int(figures["received"]) == 21
    topics = bench.reported("ik_node: topics")
    assert {pair.key: pair.value for pair in topics.values}["refused_setpoint"] == "1"
    # The bench has a publisher on joint_reference too.
    assert topics.level == b"\x01"
    assert "2 publishers on /joint_reference" in topics.message
