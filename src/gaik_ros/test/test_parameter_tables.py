"""Parameter tables on a real node: types, ranges, and changes that come into force whole or not at all."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rclpy.node import Node
from rclpy.parameter import Parameter as RosParameter

from gaik_ros.parameters import Parameter, ParameterError, ParameterTable

TABLE = ParameterTable(
    "tabled",
    (
        Parameter("rate", 100.0, "Hz", "how often", 1.0, 1000.0),
        Parameter("count", 3, "", "how many", 0, 10),
        Parameter("on", True, "", "whether"),
        Parameter("mode", "a", "", "which", choices=("a", "b")),
        Parameter("gains.p", 2.0, "", "a gain", 0.0, per_joint=True),
        Parameter("gains.<joint>.p", None, "", "a gain of one joint", 0.0),
        Parameter("names", ("left", "right"), "", "names"),
        Parameter("fixed", 1.0, "", "never changed", read_only=True),
    ),
).for_joints(("left", "right"))


@pytest.fixture
def make(context):
    made = []

    def build(table=TABLE, on_change=None, **overrides):
        node = Node(
            "tabled",
            context=context,
            parameter_overrides=[RosParameter(name, value=value) for name, value in overrides.items()],
        )
        made.append(node)
        return node, table.declare(node, on_change)

    yield build
    for node in made:
        node.destroy_node()


def change(node, **values):
    return node.set_parameters_atomically([RosParameter(n, value=v) for n, v in values.items()])


def test_defaults_have_their_own_types(make):
    _, values = make()
    assert (values.rate, values.count, values.on, values.mode) == (100.0, 3, True, "a")
    assert values["gains.p"] == 2.0
    assert values["gains.left.p"] is None
    assert values.names == ("left", "right")
    assert dict(values) == dict(TABLE.defaults())


def test_an_integer_is_taken_for_a_float_at_the_start_and_later(make):
    node, values = make(rate=50)
    assert values.rate == 50.0
    assert isinstance(values.rate, float)
    assert change(node, rate=20).successful
    assert values.rate == 20.0
    assert change(node, **{"gains.p": [1, 2]}).successful
    assert values["gains.p"] == (1.0, 2.0)
    assert change(node, **{"gains.left.p": 4}).successful
    assert values["gains.left.p"] == 4.0


@pytest.mark.parametrize(
    ("name", "value", "complaint"),
    [
        ("rate", 0.5, "'rate' is 0.5: it may be from 1 to 1000 Hz"),
        ("rate", math.nan, "'rate' is nan"),
        ("rate", math.inf, "'rate' is inf"),
        ("rate", "fast", "'rate' is 'fast': it may be a number"),
        ("rate", True, "'rate' is True: it may be a number"),
        ("rate", [1.0], "it may be a number"),
        ("count", 2.5, "a whole number"),
        ("count", 11, "from 0 to 10"),
        ("on", 1, "true or false"),
        ("mode", "c", "one of a, b"),
        ("mode", 3, "one of a, b"),
        ("gains.p", [1.0, -2.0], "at least 0"),
        ("gains.p", [1.0, math.nan], "'gains.p' is nan"),
        ("gains.left.p", -1, "'gains.left.p' is -1.0: it may be at least 0"),
        ("names", [1, 2], "a list of strings"),
    ],
)
def test_a_bad_value_is_refused_at_the_start_and_later(make, name, value, complaint):
    with pytest.raises(ParameterError, match=complaint.replace("'", "['\"]")) as refusal:
        make(**{name: value})
    assert "\n" not in str(refusal.value)
    node, values = make()
    before = dict(values)
    result = change(node, **{name: value})
    assert not result.successful
    assert name in result.reason
    assert dict(values) == before


def test_a_change_comes_into_force_whole_or_not_at_all(make):
    node, values = make()
    assert not change(node, rate=10.0, count=99).successful
    assert (values.rate, values.count) == (100.0, 3)
    assert node.get_parameter("rate").value == 100.0
    assert change(node, rate=10.0, count=9).successful
    assert (values.rate, values.count) == (10.0, 9)


def test_the_node_may_refuse_a_set_that_does_not_fit_together(make):
    seen = []

    def check(values):
        seen.append((values.rate, values.count))
        if values.rate > 10.0 * values.count:
            raise ValueError("too fast for so few")

    node, values = make(on_change=check)
    result = change(node, rate=500.0)
    assert (result.successful, result.reason) == (False, "too fast for so few")
    assert values.rate == 100.0
    assert change(node, rate=80.0, count=8).successful
    assert seen == [(500.0, 3), (80.0, 8)]


def test_read_only_and_deletion_are_refused(make):
    node, values = make()
    assert not change(node, fixed=2.0).successful
    result = node.set_parameters_atomically([RosParameter("rate", RosParameter.Type.NOT_SET)])
    assert not result.successful
    assert (values.fixed, values.rate) == (1.0, 100.0)
    assert node.get_parameter("rate").value == 100.0


def test_what_may_be_unset_can_be_unset_again_and_set_once_more(make):
    node, values = make(**{"gains.left.p": 1.5})
    assert change(node, **{"gains.left.p": None, "rate": 20.0}).successful
    assert (values["gains.left.p"], values.rate) == (None, 20.0)
    assert node.get_parameter("gains.left.p").value is None
    assert change(node, **{"gains.left.p": None}).successful
    assert not change(node, **{"gains.left.p": -1.0}).successful
    assert change(node, **{"gains.left.p": 4}).successful
    assert values["gains.left.p"] == 4.0
    assert node.describe_parameter("gains.left.p").description == "a gain of one joint"


def test_other_parameters_of_the_node_are_left_alone(make):
    node, _ = make(on_change=lambda values: pytest.fail("nothing of ours has changed"))
    node.declare_parameter("other", 1)
    assert change(node, other=2).successful


def test_a_list_has_one_value_or_one_for_each_joint(make):
    _, values = make(**{"gains.p": [1.0, 2.0, 3.0]})
    assert values.per_joint("gains.p", "abc") == (1.0, 2.0, 3.0)
    assert values.per_joint("rate", "ab") == (100.0, 100.0)
    with pytest.raises(ParameterError, match="has 3 values: it may have one, or 2"):
        values.per_joint("gains.p", "ab")


def test_it_can_be_described_to_a_user(make):
    node, _ = make()
    described = node.describe_parameter("rate")
    assert described.description == "how often [Hz]"
    assert described.additional_constraints == "from 1 to 1000 Hz"
    assert node.describe_parameter("fixed").read_only


anything = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(2**63), 2**63 - 1),
    st.floats(),
    st.text(max_size=5),
    st.lists(st.floats(), max_size=3),
    st.lists(st.text(max_size=3), max_size=3),
    st.binary(max_size=3),
)


@given(st.sampled_from(TABLE.parameters), anything)
def test_whatever_is_given_is_converted_or_refused_in_one_line(row, value):
    try:
        converted = row.convert(value)
    except ParameterError as refusal:
        assert row.name in str(refusal)
        assert "\n" not in str(refusal)
    else:
        assert row.convert(list(converted) if isinstance(converted, tuple) else converted) == converted
