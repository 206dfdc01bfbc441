"""Whatever is commanded, the twin stays inside its limits and says so in finite numbers.

The node's callbacks are called directly. GAIK_NIGHTLY=1 makes a hundred times as many examples.
"""

import os

import numpy as np
import pytest
import rclpy
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from touch_sim.joint_limits import JointLimits
from touch_sim.touch_sim_node import TouchSim

EXAMPLES = 100 * (100 if os.environ.get("GAIK_NIGHTLY") == "1" else 1)
fuzz = settings(
    max_examples=EXAMPLES, deadline=None, suppress_health_check=[HealthCheck.too_slow], print_blob=True
)
NAMES = ["waist", "shoulder", "elbow"]
ODD = [float("nan"), float("inf"), -float("inf"), 1e308, -1e308, 1e-320, -0.0, 1.0, -1.0]
numbers = st.one_of(st.sampled_from(ODD), st.floats(), st.floats(-2.0, 2.0))
commands = st.builds(
    JointState,
    name=st.one_of(
        st.just(NAMES), st.permutations(NAMES), st.lists(st.sampled_from([*NAMES, "gripper"]), max_size=5)
    ),
    effort=st.one_of(st.lists(numbers, min_size=3, max_size=3), st.lists(numbers, max_size=5)),
)
events = st.lists(
    st.one_of(
        st.tuples(st.just("command"), commands),
        st.tuples(st.just("tick"), st.floats(0.0, 1.0)),
        st.tuples(st.just("reset"), st.none()),
    ),
    max_size=12,
)


@pytest.fixture(scope="module")
def twin():
    context = rclpy.Context()
    rclpy.init(context=context)
    node = TouchSim(context=context)
    yield node
    node.destroy_node()
    rclpy.try_shutdown(context=context)


def is_sound(twin):
    for field in ("position", "velocity", "effort"):
        assert np.isfinite(getattr(twin._state, field)).all()
    JointLimits.of_chain(twin.chain).check(np.array(twin._state.position))
    assert np.abs(twin._state.effort).max() <= np.max(twin.dynamics.effort_limit)
    assert np.isfinite([twin._tip.point.x, twin._tip.point.y, twin._tip.point.z]).all()


@fuzz
@given(events)
def test_the_twin_stays_inside_its_limits_whatever_is_commanded(twin, played):
    for what, value in [*played, ("tick", 1e-3)]:
        if what == "command":
            twin._on_command(value)
        elif what == "reset":
            assert twin._on_reset(Trigger.Request(), Trigger.Response()).success
        else:
            twin._tick(value)
            is_sound(twin)
    twin.health.report()


values = st.one_of(
    st.none(), st.booleans(), st.integers(-9, 9), numbers, st.lists(numbers, max_size=4), st.text("ab")
)


@fuzz
@given(data=st.data())
def test_its_parameters_change_whole_or_not_at_all(twin, data):
    wanted = data.draw(st.dictionaries(st.sampled_from(sorted(twin.values)), values, min_size=1, max_size=3))
    before = dict(twin.values)
    result = twin.set_parameters_atomically([Parameter(name, value=value) for name, value in wanted.items()])
    if not result.successful:
        assert result.reason
        assert "\n" not in result.reason
        assert dict(twin.values) == before
    twin._on_command(JointState(name=NAMES, effort=[1.0, -1.0, 0.5]))
    twin._tick(1e-3)
    is_sound(twin)
