"""Whatever arrives, in whatever order: no callback raises, and what is published stays finite and bounded.

The callbacks of real nodes are called directly, so that thousands of messages take seconds. GAIK_NIGHTLY=1 makes a
hundred times as many.
"""

import os

import numpy as np
import pytest
import rclpy
from geometry_msgs.msg import Point
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rclpy.parameter import Parameter
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool, Trigger

from gaik_core import KinematicChain
from gaik_ros.ik_node import IkNode
from gaik_ros.pid_controller import PidController
from gaik_ros.trajectory_publisher import TrajectoryPublisher

NAMES = ["waist", "shoulder", "elbow"]
CHAIN = KinematicChain.load("touch_device")
EXAMPLES = 100 * (100 if os.environ.get("GAIK_NIGHTLY") == "1" else 1)
fuzz = settings(
    max_examples=EXAMPLES, deadline=None, suppress_health_check=[HealthCheck.too_slow], print_blob=True
)

ODD = [float("nan"), float("inf"), -float("inf"), 0.0, -0.0, 1e308, -1e308, 1e-320, 1.8e19, 0.5]
numbers = st.one_of(st.sampled_from(ODD), st.floats(), st.floats(-3.0, 3.0))
angles = st.one_of(numbers, st.floats(0.0, 1.0))
names = st.one_of(
    st.just(NAMES),
    st.permutations(NAMES),
    st.lists(st.sampled_from([*NAMES, "gripper", "Waist", ""]), max_size=6),
    st.lists(
        st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), max_size=5), max_size=4
    ),
)
values = st.one_of(
    st.lists(st.floats(0.0, 1.0), min_size=3, max_size=3),
    st.lists(angles, min_size=3, max_size=3),
    st.lists(angles, max_size=6),
)


@st.composite
def joint_states(draw):
    message = JointState(name=draw(names), position=draw(values), velocity=draw(values), effort=draw(values))
    message.header.stamp.sec = draw(st.integers(-(2**31), 2**31 - 1))
    return message


points = st.builds(Point, x=numbers, y=numbers, z=numbers)


@pytest.fixture(scope="module")
def made():
    """Makes nodes in a context of their own, where nobody listens."""
    context = rclpy.Context()
    rclpy.init(context=context)
    nodes = []

    def make(kind, **parameters):
        overrides = [Parameter(name, value=value) for name, value in parameters.items()]
        nodes.append(kind(context=context, parameter_overrides=overrides))
        return nodes[-1]

    yield make
    for node in nodes:
        node.destroy_node()
    rclpy.try_shutdown(context=context)


@pytest.fixture(scope="module")
def controller(made):
    return made(PidController)


@pytest.fixture(scope="module")
def ik(made):
    return made(IkNode)


@fuzz
@given(
    st.lists(
        st.one_of(
            st.tuples(st.just("state"), joint_states()),
            st.tuples(st.just("reference"), joint_states()),
            st.tuples(st.just("tick"), st.floats(0.0, 1.0)),
            st.tuples(st.just("enable"), st.booleans()),
            st.tuples(st.just("reset"), st.none()),
        ),
        max_size=12,
    )
)
def test_the_controller_bounds_the_effort_whatever_it_hears(controller, events):
    for what, value in [*events, ("tick", 1e-3), ("tick", 1e-3)]:
        if what == "state":
            controller._on_state(value)
        elif what == "reference":
            controller._on_reference(value)
        elif what == "enable":
            assert controller._on_enable(SetBool.Request(data=value), SetBool.Response()).success
        elif what == "reset":
            assert controller._on_reset(Trigger.Request(), Trigger.Response()).success
        else:
            controller._tick(value)
            assert len(controller._command.effort) == 3
            assert np.isfinite(controller._command.effort).all()
            assert np.abs(controller._command.effort).max() <= 1.0
    controller.health.report()


@fuzz
@given(good=st.lists(st.floats(0.1, 0.9), min_size=3, max_size=3), bad=st.lists(joint_states(), max_size=5))
def test_after_whatever_the_controller_serves_again(controller, good, bad):
    for message in bad:
        controller._on_reference(message)
        controller._on_state(message)
        controller._tick(1e-3)
    controller._on_enable(SetBool.Request(data=True), SetBool.Response())
    state = JointState(name=NAMES, position=good)
    for position in (good, good):
        controller._on_state(state)
        controller._on_reference(JointState(name=NAMES, position=position))
        controller._tick(1e-3)
    assert controller._control.mode in ("approaching", "following")


def reference_is_sound(node):
    position, velocity = np.array(node._message.position), np.array(node._message.velocity)
    axes = CHAIN.axis_angles(position)
    assert np.isfinite(position).all()
    assert np.isfinite(velocity).all()
    assert np.abs(velocity).max() <= 1.5 * (1.0 + 1e-9)
    assert ((position >= CHAIN.lower - 1e-9) & (position <= CHAIN.upper + 1e-9)).all()
    assert ((axes >= CHAIN.axis_lower - 1e-9) & (axes <= CHAIN.axis_upper + 1e-9)).all()


raw_states = st.one_of(joint_states().map(serialize_message), st.binary(max_size=80))


@fuzz
@given(
    st.lists(
        st.one_of(
            st.tuples(st.just("setpoint"), points),
            st.tuples(st.just("setpoint"), st.builds(Point, x=st.floats(-0.3, 0.3), y=st.floats(-0.3, 0.3))),
            st.tuples(st.just("state"), raw_states),
            st.tuples(st.just("tick"), st.floats(0.0, 1.0)),
            st.tuples(st.just("solve from here"), st.none()),
        ),
        max_size=10,
    )
)
def test_the_reference_keeps_its_limits_whatever_is_sent(ik, events):
    for what, value in [*events, ("setpoint", Point(x=0.01)), ("tick", 0.01)]:
        if what == "setpoint":
            ik._on_setpoint(value)
            ik._answer()
        elif what == "state":
            ik._on_state(value)
        elif what == "solve from here":
            ik._on_solve_from_here(Trigger.Request(), Trigger.Response())
        else:
            ik._tick(value)
        if ik._follower.started:
            reference_is_sound(ik)
    ik.health.report()


@fuzz
@given(message=joint_states(), target=points)
def test_an_ik_node_started_from_whatever_state_gives_a_sound_reference(ik, message, target):
    ik._follower.started = False
    ik._on_setpoint(target)
    ik._on_state(serialize_message(message))
    ik._answer()
    ik._tick(0.01)
    if ik._follower.started:
        reference_is_sound(ik)


ros_values = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(2**63), 2**63 - 1),
    numbers,
    st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), max_size=8),
    st.sampled_from(["conformal", "adam", "stream", "hold", "points", "lemniscate"]),
    st.lists(numbers, max_size=4),
    st.lists(st.text("abc", max_size=3), max_size=3),
    st.lists(st.booleans(), max_size=3),
    st.lists(st.integers(-5, 5), max_size=4),
)


def changes(table_names):
    return st.dictionaries(st.sampled_from(sorted(table_names)), ros_values, min_size=1, max_size=3)


@pytest.fixture(
    scope="module", params=[PidController, IkNode, TrajectoryPublisher], ids=lambda kind: kind.__name__
)
def node(request, made):
    return made(request.param)


@fuzz
@given(data=st.data())
def test_parameters_change_whole_or_not_at_all(node, data):
    wanted = data.draw(changes(node.values))
    before = dict(node.values)
    result = node.set_parameters_atomically([Parameter(name, value=value) for name, value in wanted.items()])
    if not result.successful:
        assert result.reason
        assert "\n" not in result.reason
        assert dict(node.values) == before
    for number in np.concatenate([np.ravel(value) for value in node.values.values() if _numeric(value)]):
        assert np.isfinite(number)
    node._tick(1e-3)
    node.health.report()


def _numeric(value):
    return isinstance(value, int | float) or (isinstance(value, tuple) and isinstance(value[0], float))
