"""Chains read from URDF: each kind of joint, frames, limits, mimic joints, and which links a chain runs between."""

import numpy as np
import pytest
from urdf_texts import EVERY_KIND, GRIPPER, joint, limits, mimic, robot

from gaik_core import KinematicChain
from gaik_core.urdf import chain_from_urdf


def homogeneous(position, rpy):
    """The matrix of a URDF origin, by its definition: R = Rz(yaw) Ry(pitch) Rx(roll)."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(rpy), np.sin(rpy)
    matrix = np.eye(4)
    matrix[:3, :3] = (
        np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
        @ np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
        @ np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    )
    matrix[:3, 3] = position
    return matrix


def turned(axis, angle):
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    matrix = np.eye(4)
    matrix[:3, :3] = np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k
    return matrix


def moved(axis, travel):
    return homogeneous(travel * np.array(axis), [0, 0, 0])


def every_kind_by_matrices(turn, spin, slide):
    """The tip of EVERY_KIND, written out by hand."""
    return (
        homogeneous([0.1, 0.2, 0.3], [0.4, -0.5, 0.6])
        @ homogeneous([0.1, 0, 0.2], [0, 0.3, 0]) @ turned([0, 1, 0], turn)
        @ homogeneous([0, 0.2, 0], [-0.7, 0, 0]) @ turned([1, 0, 1], spin)
        @ homogeneous([0, 0, 0.3], [0, 0, 1.1]) @ moved([0, 0.6, 0.8], slide)
        @ homogeneous([0.2, 0, 0], [0, 1, 0]) @ turned([0, 0, -1], -1.5 * turn + 0.2)
        @ homogeneous([0, 0.1, 0], [1, 2, 3]) @ moved([1, 0, 0], 0.5 * slide - 0.1)
        @ homogeneous([0.05, 0.06, 0.07], [0.3, 0.2, 0.1])
    )  # fmt: skip


def rotation(quaternion):
    w, x, y, z = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


@pytest.mark.parametrize("algebra", ["quaternion", "conformal"])
def test_every_kind_of_joint_moves_the_tip_as_matrices_do(algebra):
    chain = chain_from_urdf(EVERY_KIND)
    assert chain.joint_names == ("turn", "spin", "slide")
    assert chain.axis_names == ("turn", "spin", "slide", "follow", "push")
    for angles in np.random.default_rng(0).uniform([-2, -9, 0.1], [2, 9, 0.4], (20, 3)):
        wanted = every_kind_by_matrices(*angles)
        position, orientation = chain.pose(angles, algebra)
        assert np.allclose(position, wanted[:3, 3], atol=1e-12)
        assert np.allclose(rotation(orientation), wanted[:3, :3], atol=1e-12)


def test_limits_and_home():
    chain = chain_from_urdf(EVERY_KIND)
    assert np.array_equal(chain.lower, [-2, -np.inf, 0.1])
    assert np.array_equal(chain.upper, [2, np.inf, 0.4])
    assert np.array_equal(chain.axis_lower[3:], [-3, -1])
    assert np.array_equal(chain.axis_upper[3:], [3, 1])
    assert np.array_equal(chain.home, [0, 0, 0.1])  # zero, moved onto the slide's limit


def test_home_lies_within_the_limits_of_a_mimic_joint_too():
    follower = joint("b", "m", "t", limit=limits(0.5, 2), more=mimic("a", -1, 0.2))
    chain = chain_from_urdf(robot(joint("a", "s", "m"), follower))
    assert chain.home == pytest.approx([-0.3])
    assert chain.axis_angles(chain.home)[1] == pytest.approx(0.5)


def test_a_mimic_joint_whose_leader_is_elsewhere_brings_the_leaders_value_along():
    chain = chain_from_urdf(GRIPPER, tip="pad")
    assert chain.joint_names == ("wrist", "left")
    assert (chain.lower[1], chain.upper[1]) == (0, 0.04)
    assert np.allclose(chain.axis_angles([0.3, 0.02]), [0.3, 2 * 0.02 + 0.01, 10 * 0.02])
    assert np.allclose(chain.forward([0, 0.02]), [0, -0.1 - 0.05, 0.1])
    assert chain.axis_upper[1] == 0.03  # the right finger's own limit
    assert np.allclose(chain_from_urdf(GRIPPER, tip="left_finger").forward([0, 0.02]), [0, 0.12, 0])


def test_a_mimic_joint_with_multiplier_zero_stands_still_at_its_offset():
    still = joint("b", "m", "n", axis="1 0 0", more=mimic("a", 0, np.pi / 2))
    slid = joint("c", "n", "t", "prismatic", axis="0 1 0", more=mimic("a", 0, 0.3))
    chain = chain_from_urdf(robot(joint("a", "s", "m"), still, slid))
    assert chain.axis_names == ("a",)
    assert np.allclose(chain.forward([0]), [0, 0, 0.3])


def test_base_and_tip_by_name_default_or_keyword():
    text = robot(
        joint("a", "s", "m", origin="1 0 0"),
        joint("b", "m", "n", origin="0 2 0"),
        joint("c", "n", "t", origin="0 0 3"),
    )
    assert chain_from_urdf(text).joint_names == ("a", "b", "c")
    assert chain_from_urdf(text, base="m").joint_names == ("b", "c")
    assert chain_from_urdf(text, tip="n").joint_names == ("a", "b")
    middle = KinematicChain.from_urdf(text, base="m", tip="n", name="middle")
    assert (middle.name, middle.joint_names) == ("middle", ("b",))
    assert np.allclose(middle.forward([0.7]), [0, 2, 0])  # in the frame of link m
    assert chain_from_urdf(text).name == "test"


def test_text_and_files_in_any_encoding_give_the_same(tmp_path):
    path = tmp_path / "robot.urdf"
    path.write_text(EVERY_KIND)
    named = tmp_path / "latin.urdf"
    named.write_bytes(
        ('<?xml version="1.0" encoding="latin-1"?><!-- Gelenk ä -->' + EVERY_KIND).encode("latin-1")
    )
    wanted = chain_from_urdf(EVERY_KIND).forward([0.1, 0.2, 0.3])
    for source in (path, str(path), named, '<?xml version="1.0" encoding="utf-8"?>' + EVERY_KIND):
        assert np.array_equal(chain_from_urdf(source).forward([0.1, 0.2, 0.3]), wanted)


def test_what_is_no_kinematics_is_passed_over_in_silence(capfd):
    odd = (
        "<link name='z'><visual><geometry/></visual><unheard_of/></link>"
        "<joint name='zz' type='fixed'><parent link='t' made='up'/><child link='z'/><strange/></joint>"
        "<transmission name='broken'/><gazebo reference='t'><x/></gazebo><ros2_control name='r' type='system'/>"
    )
    chain = chain_from_urdf(robot(joint("a", "s", "t", origin="0 0 1"), more=odd), tip="t")
    assert np.allclose(chain.forward([0.5]), [0, 0, 1])
    assert capfd.readouterr() == ("", "")


def test_defaults_of_the_format():
    text = (
        "<robot name='r'><link name='s'/><link name='t'/><joint name='a' type='revolute'>"
        "<parent link='s'/><child link='t'/><limit upper='1'/></joint></robot>"
    )
    chain = chain_from_urdf(text)
    assert chain.joints[0].axis == (1, 0, 0)
    assert (chain.lower[0], chain.upper[0]) == (0, 1)
    assert np.array_equal(chain.forward([0.5]), [0, 0, 0])
