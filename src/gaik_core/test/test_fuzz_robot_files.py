"""Whatever stands in a robot file: a chain that works, or one clear error.

GAIK_NIGHTLY=1 tries a hundred times as much.
"""

import copy
import os
import xml.etree.ElementTree as ElementTree
from importlib.resources import files

import numpy as np
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gaik_core import KinematicChain, solve
from gaik_core.errors import GaikError, RobotFileError
from gaik_core.robot_file import CHAIN_KEYS, JOINT_KEYS, parse_robot

EXAMPLES = 100 * (100 if os.environ.get("GAIK_NIGHTLY") == "1" else 1)
fuzz = settings(
    max_examples=EXAMPLES, deadline=None, suppress_health_check=[HealthCheck.too_slow], print_blob=True
)

TEXTS = {
    name: (files("gaik_core") / "robots" / f"{name}.yaml").read_text() for name in KinematicChain.names()
}
REASONABLE = 1e6  # m or rad: beyond it lengths overflow when they are squared

scalars = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.floats(-2.0, 2.0),
    st.text(max_size=6),
    st.sampled_from(["waist", "elbow", "revolute", "prismatic", ".inf", "1e3"]),
)
values = st.recursive(
    scalars,
    lambda inner: st.one_of(
        st.lists(inner, max_size=4), st.dictionaries(st.text(max_size=5), inner, max_size=3)
    ),
    max_leaves=6,
)
keys = st.one_of(st.sampled_from([*CHAIN_KEYS, *JOINT_KEYS]), st.text(max_size=5))


def check(text):
    """A chain or one line; the chain solves."""
    try:
        chain = parse_robot(text, "fuzz.yaml")
    except RobotFileError as error:
        assert str(error).startswith("fuzz.yaml")
        assert "\n" not in str(error)
        return
    works(chain)


def works(chain):
    sizes = [chain.frames(chain.home), chain.home, chain.coupling, chain.offset]
    if max(float(np.abs(size).max(initial=0.0)) for size in sizes) > REASONABLE:
        return
    tip = chain.forward(chain.home)
    assert np.isfinite(tip).all()
    solution = solve(chain, tip + 0.01, max_iterations=20)
    assert np.isfinite(solution.angles).all()
    if chain.limited:
        assert (solution.angles >= chain.lower - 1e-9).all()
        assert (solution.angles <= chain.upper + 1e-9).all()


@fuzz
@given(text=st.one_of(st.text(), st.text("[]{}:-&*!|>#%@,'\" \n\tab01.")))
def test_any_text_is_a_chain_or_one_line(text):
    check(text)


@fuzz
@given(data=values)
def test_any_yaml_is_a_chain_or_one_line(data):
    check(yaml.safe_dump(data, allow_unicode=True))


@fuzz
@given(name=st.sampled_from(sorted(TEXTS)), data=st.data())
def test_a_shipped_file_with_other_values_is_a_chain_or_one_line(name, data):
    robot = copy.deepcopy(yaml.safe_load(TEXTS[name]))
    for _ in range(data.draw(st.integers(1, 3))):
        joints = robot.get("joints")
        tables = [robot, *([j for j in joints if isinstance(j, dict)] if isinstance(joints, list) else [])]
        table = data.draw(st.sampled_from(tables))
        key = data.draw(st.one_of(st.sampled_from(sorted(map(str, table)) or ["name"]), keys))
        if data.draw(st.booleans()):
            table[key] = data.draw(values)
        else:
            table.pop(key, None)
    check(yaml.safe_dump(robot, allow_unicode=True))


@fuzz
@given(name=st.sampled_from(sorted(TEXTS)), data=st.data())
def test_a_shipped_file_with_other_characters_is_a_chain_or_one_line(name, data):
    text = TEXTS[name]
    for _ in range(data.draw(st.integers(1, 4))):
        start = data.draw(st.integers(0, len(text)))
        end = min(len(text), start + data.draw(st.integers(0, 12)))
        text = text[:start] + data.draw(st.text(max_size=6)) + text[end:]
    check(text)


URDF = """
<robot name="two">
  <link name="base"/><link name="arm"/><link name="tool0"/>
  <joint name="a" type="revolute"><parent link="base"/><child link="arm"/><origin xyz="0 0 0.1" rpy="0 0.2 0"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="b" type="continuous"><parent link="arm"/><child link="tool0"/><origin xyz="0.2 0 0"/>
    <axis xyz="0 1 0"/><mimic joint="a" multiplier="0.5" offset="0.1"/></joint>
</robot>
"""


@fuzz
@given(data=st.data())
def test_a_urdf_with_other_values_is_a_chain_or_an_error_of_ours(data):
    tree = ElementTree.fromstring(URDF)
    for _ in range(data.draw(st.integers(1, 3))):
        element = data.draw(st.sampled_from(list(tree.iter())))
        if element.attrib and data.draw(st.booleans()):
            key = data.draw(st.sampled_from(sorted(element.attrib)))
            element.set(
                key, data.draw(st.one_of(st.text("0123456789.-+e abz", max_size=12), st.just("nan nan nan")))
            )
        elif len(element):
            element.remove(data.draw(st.sampled_from(list(element))))
    try:
        chain = KinematicChain.from_urdf(
            ElementTree.tostring(tree, encoding="unicode"), base="base", tip="tool0"
        )
    except GaikError as error:
        assert "\n" not in str(error)
        return
    works(chain)
