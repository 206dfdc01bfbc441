"""The URDF against the robot file: limits, and the tip by a walk over homogeneous matrices that shares no code."""

import numpy as np
import pytest
from urdf_parser_py.urdf import URDF

from gaik_core import KinematicChain
from touch_sim.description import ORIGIN_FRAME, touch_urdf


@pytest.fixture(scope="module")
def robot():
    # As bytes: the parser refuses a str with an encoding declaration.
    return URDF.from_xml_string(touch_urdf().encode())


def turn(axis, angle):
    """Rodrigues' formula, (3, 3)."""
    x, y, z = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def origin_matrix(origin):
    """The homogeneous matrix (4, 4) of a URDF origin: fixed axes roll, pitch, yaw."""
    matrix = np.eye(4)
    if origin is not None:
        roll, pitch, yaw = origin.rpy or (0, 0, 0)
        matrix[:3, :3] = turn([0, 0, 1], yaw) @ turn([0, 1, 0], pitch) @ turn([1, 0, 0], roll)
        matrix[:3, 3] = origin.xyz or (0, 0, 0)
    return matrix


def pose(robot, link, angles):
    """The pose (4, 4) of a link in base_link, mimic joints included."""
    matrix = np.eye(4)
    for name in robot.get_chain(robot.get_root(), link, links=False):
        joint = robot.joint_map[name]
        matrix = matrix @ origin_matrix(joint.origin)
        if joint.type == "revolute":
            mimic = joint.mimic
            angle = (
                angles[name]
                if mimic is None
                else (mimic.multiplier or 1.0) * angles[mimic.joint] + (mimic.offset or 0)
            )
            rotation = np.eye(4)
            rotation[:3, :3] = turn(joint.axis, angle)
            matrix = matrix @ rotation
    return matrix


def test_the_tip_is_that_of_eq_78_after_the_turn_to_rep_103(robot):
    touch, random = KinematicChain.load("touch"), np.random.default_rng(78)
    for angles in random.uniform(-np.pi, np.pi, (200, 3)):
        x, y, z = touch.forward(angles)
        tip = pose(robot, "tip", dict(zip(touch.joint_names, angles, strict=True)))[:3, 3]
        # REP-103: x forward (toward the user, the paper's z), y left (his right, the paper's x), z up (its y).
        origin = pose(robot, ORIGIN_FRAME, {})[:3, 3]
        np.testing.assert_allclose(tip - origin, [z, x, y], rtol=0, atol=1e-12)


def test_the_frame_of_the_tip_is_the_papers(robot):
    touch, random = KinematicChain.load("touch"), np.random.default_rng(79)
    frame = np.linalg.inv(pose(robot, ORIGIN_FRAME, {}))
    for angles in random.uniform(-np.pi, np.pi, (50, 3)):
        tip = pose(robot, "tip", dict(zip(touch.joint_names, angles, strict=True)))
        np.testing.assert_allclose((frame @ tip)[:3, 3], touch.forward(angles), rtol=0, atol=1e-12)


def test_the_base_is_upright_on_its_table(robot):
    shoulder = pose(robot, "turret", {"waist": 0.0})
    np.testing.assert_allclose(shoulder[:2, 3], 0.0, atol=1e-12)
    assert shoulder[2, 3] > 0.1
    assert robot.joint_map["waist"].axis == [0, 0, -1]


def test_the_forearm_does_not_turn_with_the_shoulder(robot):
    before, after = (
        pose(robot, "forearm", {"waist": 0.3, "shoulder": shoulder, "elbow": 0.7}) for shoulder in (0.1, 1.2)
    )
    np.testing.assert_allclose(before[:3, :3], after[:3, :3], atol=1e-12)


def test_the_limits_are_the_devices(robot):
    device = KinematicChain.load("touch_device")
    for joint in ("waist", "shoulder"):
        index = device.joint_names.index(joint)
        limit = robot.joint_map[joint].limit
        assert (limit.lower, limit.upper) == (device.lower[index], device.upper[index])
    # The elbow's are what the stop between the arms leaves over the shoulder's range.
    axis, shoulder = device.axis_names.index("elbow"), device.joint_names.index("shoulder")
    limit = robot.joint_map["elbow"].limit
    assert limit.lower == pytest.approx(device.axis_lower[axis] + device.lower[shoulder])
    assert limit.upper == pytest.approx(device.axis_upper[axis] + device.upper[shoulder])


def test_every_moving_link_can_be_seen_and_hit(robot):
    for link in robot.links:
        if link.name != ORIGIN_FRAME:
            assert link.visual is not None, link.name
            assert link.collision is not None, link.name


def test_joints_that_are_driven_are_those_of_the_robot_file(robot):
    driven = [joint.name for joint in robot.joints if joint.type != "fixed" and joint.mimic is None]
    assert tuple(driven) == KinematicChain.load("touch_device").joint_names
