"""The markers of a path that is sent and of a device that is played."""

import numpy as np
import pytest
from rclpy.serialization import serialize_message
from ros_bench import NAMES, Bench, overrides, wait_until
from visualization_msgs.msg import Marker, MarkerArray

from gaik_core import KinematicChain
from gaik_ros.conversions import joint_state
from gaik_ros.path_markers import PathMarkers, Trail
from gaik_ros.run import running

CHAIN = KinematicChain.load("touch_device")


@pytest.fixture
def seen(context):
    """A bench, what it sees of the markers, and the node."""
    bench, arrays = Bench(context), []
    bench.create_subscription(MarkerArray, "path_markers/markers", arrays.append, 10)
    node = PathMarkers(context=context, parameter_overrides=overrides(rate=20.0, length=60.0))
    with running([bench, node], context):
        wait_until(lambda: bench.setpoint.get_subscription_count() and bench.states.get_subscription_count())
        yield bench, arrays


def marker(arrays, name):
    return next(m for m in arrays[-1].markers if m.ns == name)


def points(found):
    return np.array([(p.x, p.y, p.z) for p in found.points])


def test_the_desired_path_is_that_of_the_setpoints_and_the_followed_one_that_of_the_tip(seen):
    bench, arrays = seen
    wait_until(lambda: arrays)
    assert {m.action for m in arrays[-1].markers} == {Marker.DELETE}  # nothing to draw yet
    sent = np.array([[0.01 * k, 0.0, 0.001 * k] for k in range(5)])
    for point in sent:
        bench.send(point)
    bench.send([float("nan"), 0.0, 0.0])
    bench.publishing = True
    tips = [CHAIN.forward(bench.angles)]
    wait_until(lambda: len(marker(arrays, "followed_now").points) == 1)
    bench.angles = bench.angles + 0.1
    tips.append(CHAIN.forward(bench.angles))
    wait_until(lambda: len(marker(arrays, "followed").points) == 2)
    wait_until(lambda: len(marker(arrays, "desired").points) == 5)
    np.testing.assert_allclose(points(marker(arrays, "desired")), sent)
    np.testing.assert_allclose(points(marker(arrays, "followed")), tips, atol=1e-12)
    np.testing.assert_allclose(points(marker(arrays, "desired_now")), sent[-1:])


def test_rviz_can_draw_them(seen):
    bench, arrays = seen
    bench.send([0.0, 0.0, 0.0])
    bench.send([0.1, 0.0, 0.0])
    wait_until(lambda: arrays and len(marker(arrays, "desired").points) == 2)
    identities = [(m.ns, m.id) for m in arrays[-1].markers]
    assert len(set(identities)) == len(identities) == 4
    for found in arrays[-1].markers:
        assert found.header.frame_id == "touch_origin"
        assert found.header.stamp.sec > 1_600_000_000
        assert found.pose.orientation.w == 1.0
        assert found.scale.x > 0.0
        assert found.color.a == 1.0
    assert marker(arrays, "desired").type == Marker.LINE_STRIP


def test_a_state_that_is_cut_is_refused_and_the_next_good_one_drawn(context):
    bench, arrays = Bench(context), []
    bench.create_subscription(MarkerArray, "path_markers/markers", arrays.append, 10)
    node = PathMarkers(context=context, parameter_overrides=overrides(rate=20.0))
    cut = serialize_message(joint_state(NAMES, position=bench.angles))[:-10]
    with running([bench, node], context):

        def is_refused():
            bench.states.publish(cut)
            return node._watch.refused.get("joint_states", 0) > 0

        wait_until(is_refused, "a cut state is taken")
        bench.publishing = True
        wait_until(lambda: arrays and len(marker(arrays, "followed_now").points) == 1, "it draws no more")


def test_a_trail_forgets_what_is_old_and_does_not_repeat_what_stands_still():
    trail = Trail(3)
    for x in (0.0, 1.0, 1.0, 2.0, np.inf, 3.0):
        trail.add(np.array([x, 0.0, 0.0]))
    assert [p.x for p in trail.points] == [1.0, 2.0, 3.0]
