"""Small URDFs for the tests, put together from joints written in one line each."""

LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def joint(
    name, parent, child, kind="revolute", origin="0 0 0", rpy="0 0 0", axis="0 0 1", limit=LIMIT, more=""
):
    """One joint element; the limit is left out for kinds that have none."""
    held = limit if kind in ("revolute", "prismatic") else ""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{origin}" rpy="{rpy}"/><axis xyz="{axis}"/>{held}{more}</joint>'
    )


def robot(*joints, links=None, more=""):
    """A robot of these joints, with a link for every letter that a joint names as its parent or child."""
    names = (
        links
        if links is not None
        else sorted({part.split('"')[0] for j in joints for part in j.split('link="')[1:]})
    )
    return f'<robot name="test">{"".join(f"<link name={name!r}/>" for name in names)}{"".join(joints)}{more}</robot>'


def limits(lower, upper):
    """A limit element."""
    return f'<limit lower="{lower}" upper="{upper}" effort="1" velocity="1"/>'


def mimic(leader, multiplier=None, offset=None):
    """A mimic element."""
    multiplied = "" if multiplier is None else f' multiplier="{multiplier}"'
    shifted = "" if offset is None else f' offset="{offset}"'
    return f'<mimic joint="{leader}"{multiplied}{shifted}/>'


EVERY_KIND = robot(
    joint("mount", "world", "a", "fixed", "0.1 0.2 0.3", "0.4 -0.5 0.6"),
    joint("turn", "a", "b", "revolute", "0.1 0 0.2", "0 0.3 0", "0 2 0", limits(-2, 2)),
    joint("spin", "b", "c", "continuous", "0 0.2 0", "-0.7 0 0", "1 0 1"),
    joint("slide", "c", "d", "prismatic", "0 0 0.3", "0 0 1.1", "0 0.6 0.8", limits(0.1, 0.4)),
    joint(
        "follow", "d", "e", "revolute", "0.2 0 0", "0 1 0", "0 0 -1", limits(-3, 3), mimic("turn", -1.5, 0.2)
    ),
    joint(
        "push", "e", "f", "prismatic", "0 0.1 0", "1 2 3", "1 0 0", limits(-1, 1), mimic("slide", 0.5, -0.1)
    ),
    joint("tool", "f", "tip", "fixed", "0.05 0.06 0.07", "0.3 0.2 0.1"),
)
"""Every kind of joint that a chain can have, none of them along an axis of its neighbour's frame."""

GRIPPER = robot(
    joint("wrist", "palm_mount", "palm", "revolute", limit=limits(-1, 1)),
    joint("left", "palm", "left_finger", "prismatic", "0 0.1 0", axis="0 1 0", limit=limits(0, 0.04)),
    joint(
        "right",
        "palm",
        "right_finger",
        "prismatic",
        "0 -0.1 0",
        axis="0 -1 0",
        limit=limits(0, 0.03),
        more=mimic("left", 2, 0.01),
    ),
    joint(
        "knuckle", "right_finger", "pad", "revolute", "0 0 0.1", limit=limits(-1, 1), more=mimic("left", 10)
    ),
)
"""A gripper whose right finger follows the left one."""
