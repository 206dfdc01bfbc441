"""Robot files: what they say is what the chain is, and what is wrong in them is named."""

import numpy as np
import pytest
from chains import ROBOTS

from gaik_core import KinematicChain
from gaik_core.errors import RobotFileError, UnknownRobotError
from gaik_core.robot_file import parse_robot

GOOD = """
name: crane
description: two turns and a slide
origin: [0.1, 0.2, 1e-1]
orientation: [0, 1, 0, 0]
joints:
  - {name: slew, axis: [0, 0, 2], limits: [-1, .inf], home: 0.5}
  - {name: luff, axis: [0, 1, 0], link: [1, 0, 0], coupling: {slew: -1}, axis_limits: [-0.5, 0.5], offset: 0.1}
  - {name: boom, type: prismatic, axis: [1, 0, 0], link: [0.2, 0, 0]}
  - {name: hook, axis: [0, 1, 0], passive: true, coupling: {luff: 1}}
"""


def test_every_key_arrives():
    chain = parse_robot(GOOD)
    assert (chain.name, chain.description) == ("crane", "two turns and a slide")
    assert chain.joint_names == ("slew", "luff", "boom")
    assert chain.axis_names == ("slew", "luff", "boom", "hook")
    assert chain.lower[0] == -1 and np.isinf(chain.upper[0])
    assert np.array_equal(chain.home, [0.5, 0, 0])
    assert np.array_equal(chain.axis_angles([0.3, 0.4, 0.7]), np.array([0.3, 0.4 - 0.3 + 0.1, 0.7, 0.4]))
    assert (chain.axis_lower[1], chain.axis_upper[1]) == (-0.5, 0.5)
    position, orientation = chain.pose([0, -0.1, 0.3])
    assert np.allclose(position, [0.1 + 1 + 0.3 + 0.2, 0.2, 0.1])
    half = -0.05  # the hook's axis turns by luff
    assert np.allclose(np.abs(orientation), np.abs([0, np.cos(half), 0, np.sin(half)]), atol=1e-12)


@pytest.mark.parametrize("name", ROBOTS)
def test_shipped_robots_load_by_name_and_are_named_so(name):
    chain = KinematicChain.load(name)
    assert chain.name == name
    assert chain.description


def test_a_path_loads_and_gives_its_name_to_a_nameless_robot(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("joints: [{name: a, axis: [0, 0, 1], link: [1, 0, 0]}]")
    assert KinematicChain.load(path).name == "mine"
    assert KinematicChain.load(str(path)).dof == 1


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is missing; expected a mapping with the keys name"),
        ("3", "is 3; expected a mapping"),
        ("a: [", r"line \d.*not YAML"),
        ("name: x\nname: y", "line 2.*the key 'name' stands there twice"),
        (
            "joints: [{name: a, axis: [0, 0, 1]}, "
            "{name: p, axis: [0, 0, 1], passive: true, coupling: {a: 1}, limits: [-1, 1]}]",
            r"joint 'p': limits are \[-1, 1\]; a passive joint has no value",
        ),
        ("joints: []", r"joints: is \[\]; expected a list of at least one joint"),
        ("joints: 3", "joints: is 3; expected a list"),
        ("name: x", "joints: is missing"),
        ("robot: x", "robot: unknown key; known: name, description"),
        ("joints: [4]", r"joints\[0\]: is 4; expected a mapping"),
        ("joints: [{axis: [0, 0, 1]}]", r"joints\[0\].name: is missing"),
        ("joints: [{name: a}]", r"joints\[0\].axis: is missing; expected 3 finite numbers"),
        ("joints: [{name: a, axis: [0, 0, 0]}]", r"axis: is \[0, 0, 0\]; .*not all zero"),
        ("joints: [{name: a, axis: [0, 1]}]", r"axis: is \[0, 1\]; expected 3 finite numbers"),
        ("joints: [{name: a, axis: [0, 0, .nan]}]", "axis: is"),
        (
            "joints: [{name: a, axis: [0, 0, 1], typ: prismatic}]",
            r"joints\[0\].typ: unknown key; known: name, type",
        ),
        (
            "joints: [{name: a, axis: [0, 0, 1], type: ball}]",
            "type: is 'ball'; expected revolute or prismatic",
        ),
        (
            "joints: [{name: a, axis: [0, 0, 1], limits: [2, 1]}]",
            r"limits: is \[2, 1\]; expected two numbers",
        ),
        ("joints: [{name: a, axis: [0, 0, 1], limits: [.nan, 1]}]", "limits: is"),
        ("joints: [{name: a, axis: [0, 0, 1], home: 3, limits: [0, 1]}]", r"home: is 3.0; .*\[0, 1\]"),
        ("joints: [{name: a, axis: [0, 0, 1], coupling: {b: 1}}]", "'b'; known: a"),
        ("joints: [{name: a, axis: [0, 0, 1], coupling: [1]}]", "coupling: is"),
        (
            "joints: [{name: a, axis: [0, 0, 1], passive: maybe}]",
            "passive: is 'maybe'; expected true or false",
        ),
        ("joints: [{name: a, axis: [0, 0, 1]}]\norigin: [0, x, 0]", "origin: is .*expected 3 finite numbers"),
        ("joints: [{name: a, axis: [0, 0, 1]}]\norientation: [0, 0, 0, 0]", "orientation: is .*not all zero"),
    ],
)
def test_what_is_wrong_is_named(text, message):
    with pytest.raises(RobotFileError, match=message) as caught:
        parse_robot(text, "mine.yaml")
    assert str(caught.value).startswith("mine.yaml")
    assert "\n" not in str(caught.value)


def test_a_missing_file_and_one_that_is_no_text(tmp_path):
    with pytest.raises(RobotFileError, match="cannot be read: No such file"):
        KinematicChain.load(tmp_path / "none.yaml")
    with pytest.raises(UnknownRobotError, match="known: arm3"):
        KinematicChain.load(tmp_path / "none")
    (tmp_path / "picture.yaml").write_bytes(b"\xff\xfe\x00\x81")
    with pytest.raises(RobotFileError, match=r"picture.yaml: "):
        KinematicChain.load(tmp_path / "picture.yaml")
