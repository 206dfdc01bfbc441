"""Messages to arrays and back, and JointStates that are not what they should be."""

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from hypothesis import given
from hypothesis import strategies as st
from rclpy.clock import Clock
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import JointState

from gaik_ros.conversions import (
    JointMessageError,
    array_to_point,
    fill,
    joint_state,
    joint_values,
    point_to_array,
    raw_joint_values,
    stamp_now,
)

NAMES = ("waist", "shoulder", "elbow")
finite = st.floats(allow_nan=False, allow_infinity=False)
three = st.lists(finite, min_size=3, max_size=3)
measured = st.lists(st.floats(-1e12, 1e12), min_size=3, max_size=3)


@given(three)
def test_a_point_comes_back_as_it_was(values):
    np.testing.assert_array_equal(point_to_array(array_to_point(values)), values)


@pytest.mark.parametrize("values", [[1, 2, 3], np.float32([1, 2, 3]), np.arange(1, 4), (1.0, 2, np.int8(3))])
def test_any_kind_of_number_is_sent_as_a_float(values):
    sent = deserialize_message(serialize_message(array_to_point(values)), type(array_to_point(values)))
    assert (sent.x, sent.y, sent.z) == (1.0, 2.0, 3.0)


@given(measured, measured, measured, st.permutations(range(3)))
def test_a_joint_state_is_read_by_name_whatever_the_order(position, velocity, effort, order):
    message = joint_state(
        [NAMES[k] for k in order],
        position=np.array(position)[order],
        velocity=np.array(velocity)[order],
        effort=np.array(effort)[order],
    )
    message = deserialize_message(serialize_message(message), JointState)
    for field, values in (("position", position), ("velocity", velocity), ("effort", effort)):
        np.testing.assert_array_equal(joint_values(message, NAMES, field), values)


def test_a_joint_state_is_read_from_the_wire_and_refused_where_it_is_cut():
    raw = serialize_message(joint_state(NAMES, position=[1, 2, 3], effort=[4, 5, 6]))
    np.testing.assert_array_equal(raw_joint_values(raw, NAMES), [1.0, 2.0, 3.0])
    np.testing.assert_array_equal(raw_joint_values(raw, NAMES, "effort"), [4.0, 5.0, 6.0])
    with pytest.raises(JointMessageError, match=r"^its 40 bytes are no JointState$"):
        raw_joint_values(raw[:40], NAMES)


def test_foreign_joints_are_passed_over():
    message = joint_state(("gripper", *NAMES, "wrist"), position=[9, 1, 2, 3, 8])
    np.testing.assert_array_equal(joint_values(message, NAMES), [1.0, 2.0, 3.0])


@pytest.mark.parametrize(
    ("names", "position", "complaint"),
    [
        ((), [], "waist is missing"),
        (("waist", "elbow"), [1, 2], "shoulder is missing"),
        ((*NAMES, "waist"), [1, 2, 3, 4], "waist stands there 2 times"),
        (NAMES, [1, 2], "3 joint names but 2 values"),
        (NAMES, [], "3 joint names but 0 values"),
        (NAMES, [1, np.nan, 3], "position of shoulder is not finite"),
        (NAMES, [1, 2, -1e308], "position of elbow is -1e\\+308, beyond 1e\\+12"),
        (NAMES[::-1], [1, np.inf, np.nan], "position of waist is not finite"),
    ],
)
def test_a_joint_state_that_will_not_do_is_refused_with_the_reason(names, position, complaint):
    with pytest.raises(JointMessageError, match=complaint):
        joint_values(joint_state(names, position=position), NAMES)


def test_only_the_field_that_is_read_has_to_be_there():
    message = joint_state(NAMES, position=[1, 2, 3], velocity=[np.nan] * 3)
    np.testing.assert_array_equal(joint_values(message, NAMES), [1.0, 2.0, 3.0])


def test_a_message_is_filled_anew_without_keeping_the_array():
    message, values = joint_state(NAMES, position=[0, 0, 0]), np.array([1.0, 2.0, 3.0])
    fill(message, "position", values)
    values[0] = 7.0
    assert list(message.position) == [1.0, 2.0, 3.0]


def test_a_stamp_is_set_in_place():
    stamp, clock = Time(), Clock()
    before = clock.now().nanoseconds
    stamp_now(stamp, clock)
    assert before <= stamp.sec * 10**9 + stamp.nanosec <= clock.now().nanoseconds
