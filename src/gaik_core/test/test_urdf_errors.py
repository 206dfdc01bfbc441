"""What no chain can be made of is refused with one line that names the culprit."""

import pytest
from urdf_texts import EVERY_KIND, GRIPPER, joint, limits, mimic, robot

from gaik_core.errors import GaikError, UrdfError
from gaik_core.urdf import chain_from_urdf

ONE = joint("a", "s", "t")
PAIR = (joint("a", "s", "m"), joint("b", "m", "t"))


def follower(name="b", parent="m", child="t", **how):
    return joint(name, parent, child, more=mimic(**how))


REFUSED = {
    "empty": ("<", "not XML"),
    "cut off": (robot(ONE)[:-9], "not XML"),
    "other format": ("<sdf version='1.9'><model/></sdf>", "the root element is <sdf>; a URDF's is <robot>"),
    "xacro without a namespace": ("<robot name='r'><xacro:include filename='x'/></robot>", "is xacro"),
    "xacro": ("<robot name='r' xmlns:xacro='http://wiki.ros.org/xacro'><xacro:arm/></robot>", "is xacro"),
    "no name": (robot(ONE).replace(' name="test"', ""), "name"),
    "no links": ("<robot name='r'/>", "has no link"),
    "two links": (robot(ONE, links=["s", "t", "t"]), "two links are called 't'"),
    "two joints": (robot(ONE, joint("a", "t", "u")), "two joints are called 'a'"),
    "parent": (robot(ONE, links=["t"]), "joint 'a': parent: no link 's'"),
    "child": (robot(ONE, links=["s", "tt"]), "joint 'a': child: no link 't' (did you mean 'tt'?)"),
    "no parent": (robot(ONE).replace('<parent link="s"/>', ""), "parent"),
    "parent without link": (
        robot(ONE).replace('parent link="s"', "parent"),
        "<parent> has no attribute 'link'",
    ),
    "two parents": (robot(ONE, joint("b", "s", "t")), "link 't' is the child of two joints, 'a' and 'b'"),
    "all in a circle": (robot(ONE, joint("b", "t", "s")), "circle"),
    "a circle apart": (robot(ONE, joint("b", "x", "y"), joint("c", "y", "x")), "circle through"),
    "disconnected": (robot(ONE, links=["s", "t", "u"]), "disconnected: the links s, u have no parent"),
    "leaves": (robot(ONE, joint("b", "s", "u")), "below 's' 2 links have no children; name one of t, u"),
    "fixed only": (robot(joint("a", "s", "t", "fixed")), "no joint between 's' and 't' can move"),
    "planar": (
        robot(joint("a", "s", "t", "planar")),
        "joint 'a' is of type 'planar'; between base and tip it may be fixed, revo",
    ),
    "floating": (robot(joint("a", "s", "t", "floating")), "is of type 'floating'"),
    "no such type": (robot(joint("a", "s", "t", "spherical")), "spherical"),
    "zero axis": (
        robot(joint("a", "s", "t", axis="0 0 0")),
        "joint 'a': axis is [0.0, 0.0, 0.0]; expected a direction",
    ),
    "axis of two": (
        robot(joint("a", "s", "t", axis="0 1")),
        "joint 'a': axis is '0 1'; expected three numbers",
    ),
    "no number": (
        robot(joint("a", "s", "t", origin="0 0 ${x}")),
        "origin[@xyz]: could not convert string to float: '${x}'",
    ),
    "NaN": (robot(joint("a", "s", "t", rpy="0 nan 0")), "joint 'a': origin rpy is"),
    "limits": (
        robot(joint("a", "s", "t", limit=limits(2, 1))),
        "joint 'a': limits are [2, 1]; the lower must not be above",
    ),
    "limit NaN": (robot(joint("a", "s", "t", limit=limits("nan", 1))), "limits are [nan, 1]"),
    "no limit": (
        robot(joint("a", "s", "t", limit="")),
        "revolute without <limit>; give it one, or the type continuous",
    ),
    "no travel": (
        robot(joint("a", "s", "t", "prismatic", limit="")),
        "prismatic without <limit>; give it one",
    ),
    "mimic of none": (
        robot(ONE, follower(parent="t", child="u", leader="x")),
        "joint 'b' mimics joint 'x'; there is none",
    ),
    "mimic of fixed": (
        robot(joint("a", "s", "m", "fixed"), follower(leader="a")),
        "joint 'b' mimics joint 'a'; which is fixed",
    ),
    "mimic of itself": (robot(PAIR[0], follower(leader="b")), "which itself mimics 'b'"),
    "mimic of a mimic": (
        robot(joint("a", "s", "m"), follower(leader="a"), follower("c", "t", "u", leader="b")),
        "'b', which itself mimics 'a'",
    ),
    "mimic circle": (robot(joint("a", "s", "m", more=mimic("b")), follower(leader="a")), "itself mimics"),
    "mimic without joint": (
        robot(PAIR[0], joint("b", "m", "t", more="<mimic/>")),
        "<mimic> has no attribute 'joint'",
    ),
    "mimic NaN": (robot(PAIR[0], follower(leader="a", multiplier="inf")), "joint 'b': mimic is [inf, 0.0]"),
    "mimic out of limits": (
        robot(joint("a", "s", "m"), joint("b", "m", "t", limit=limits(5, 6), more=mimic("a"))),
        "'a' and the joints that mimic it have no value within the limits of all",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_refused_in_one_line(case):
    text, message = REFUSED[case]
    with pytest.raises(UrdfError) as caught:
        chain_from_urdf(text)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
    assert isinstance(caught.value, GaikError)


@pytest.mark.parametrize(
    ("links", "message"),
    [
        ({"base": "palms"}, "base: no link 'palms' (did you mean 'palm'"),
        ({"tip": "thumb"}, "tip: no link 'thumb'; links: left_finger, pad, palm, palm_mount, right_finger"),
        ({"base": "pad", "tip": "palm"}, "tip 'palm' is not below base 'pad', but above it: exchange them"),
        ({"base": "left_finger", "tip": "pad"}, "tip 'pad' is not below base 'left_finger'"),
        ({"base": "palm", "tip": "palm"}, "base and tip are the same link 'palm'"),
        ({"base": "nowhere"}, "base: no link 'nowhere'"),
    ],
)
def test_links_that_span_no_chain(links, message):
    with pytest.raises(UrdfError) as caught:
        chain_from_urdf(GRIPPER, **links)
    assert message in str(caught.value)


@pytest.mark.parametrize("path", ["nowhere/robot.urdf", "", "a" * 5000, "with\0nul"])
def test_a_path_that_is_no_file(path):
    with pytest.raises(UrdfError, match="is neither a URDF text nor a file"):
        chain_from_urdf(path)


def test_something_else_than_a_text_or_a_path():
    with pytest.raises(UrdfError, match="URDF is a NoneType; expected its text or the path of a file"):
        chain_from_urdf(None)


def test_a_files_errors_begin_with_its_path(tmp_path):
    path = tmp_path / "broken.urdf"
    path.write_text(EVERY_KIND.replace('type="prismatic"', 'type="planar"'))
    with pytest.raises(UrdfError, match=r"^\S+broken.urdf: joint 'slide'"):
        chain_from_urdf(path)


def test_a_joint_off_the_chain_may_be_of_any_kind():
    text = robot(joint("a", "s", "t"), joint("b", "s", "u", "floating"))
    assert chain_from_urdf(text, tip="t").joint_names == ("a",)
