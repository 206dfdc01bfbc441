"""A joint is what was written, or is refused by its name; it can be copied, compared and sent elsewhere."""

import copy
import pickle

import numpy as np
import pytest

from gaik_core import Joint, KinematicChain, LevenbergMarquardt, solve
from gaik_core.errors import GaikError

Z = (0.0, 0.0, 1.0)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"axis": (0, 0, 0)}, "axis is .*; expected anything but zero"),
        ({"axis": (0, np.nan, 1)}, "axis is .*; every element must be finite"),
        ({"axis": (0, 1)}, r"axis has shape \(2,\); expected \(3,\)"),
        ({"axis": "z"}, "axis is 'z'; expected an array of numbers"),
        ({"link": (np.inf, 0, 0)}, "link is .*; every element must be finite"),
        ({"link": (1, 0)}, r"link has shape \(2,\)"),
        ({"kind": "continuous"}, "kind is 'continuous'; expected revolute or prismatic"),
        ({"kind": "Revolute"}, "kind is 'Revolute'; expected revolute or prismatic"),
        ({"offset": np.nan}, "offset is nan; expected a finite number"),
        ({"home": np.inf}, "home is inf; expected a finite number"),
        ({"coupling": {"b": np.nan}}, "coupling to 'b' is nan; expected a finite number"),
        ({"lower": 1.0, "upper": -1.0}, "limits are"),
        ({"axis_lower": 1.0, "axis_upper": -1.0}, "axis_limits are"),
        ({"lower": np.nan}, "limits are"),
        ({"lower": None}, r"limits are \[None, inf\]; expected two numbers"),
        ({"coupling": None}, "coupling is None; expected factors by the names of joints"),
        ({"lower": 1.0, "upper": 2.0}, "home is 0; expected within its limits"),
        ({"passive": True, "coupling": {"b": 1.0}, "lower": -0.1}, "limits are .*; a passive joint has no value"),
    ],
)  # fmt: skip
def test_impossible_joints_are_named(fields, message):
    with pytest.raises(GaikError, match=f"joint 'a': {message}"):
        Joint("a", **{"axis": Z, **fields})


def test_one_joint_is_not_yet_a_sequence():
    with pytest.raises(GaikError, match="joints is the joint 'a' alone; expected a sequence of joints"):
        KinematicChain(Joint("a", Z))


def test_a_direction_of_any_size_is_made_a_unit_vector():
    for size in (1e-200, 1.0, 1e200):
        assert Joint("a", (0.0, 3.0 * size, 4.0 * size)).axis == pytest.approx((0.0, 0.6, 0.8))


@pytest.mark.parametrize("name", KinematicChain.names())
@pytest.mark.parametrize("copied", [copy.deepcopy, lambda chain: pickle.loads(pickle.dumps(chain))])
def test_chains_can_be_copied_and_sent_to_other_processes(name, copied):
    chain = KinematicChain.load(name)
    twin = copied(chain)
    assert twin.joints == chain.joints and hash(twin.joints) == hash(chain.joints)
    assert (twin.name, twin.description) == (chain.name, chain.description)
    angles = chain.home + 0.1
    assert np.allclose(np.hstack(twin.pose(angles)), np.hstack(chain.pose(angles)), rtol=0.0, atol=1e-15)
    target = chain.forward(chain.home)
    assert solve(twin, target, rule=LevenbergMarquardt()).status == solve(chain, target).status
