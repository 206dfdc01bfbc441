"""Real robots' URDFs, read and compared with Pinocchio: pose and Jacobian of the tip, by both algebras."""

from typing import NamedTuple

import numpy as np
import pytest
from shipped_urdfs import urdf_of
from urdf_texts import EVERY_KIND, GRIPPER

from gaik_core.urdf import chain_from_urdf

pin = pytest.importorskip("pinocchio", reason="Pinocchio is not installed (pip install pin)")


class Robot(NamedTuple):
    package: str
    file: str
    base: str
    tip: str
    joints: int
    axes: int


ERD, RTB = "example-robot-data", "rtb-data"
ROBOTS = [
    Robot(ERD, "panda.urdf", "panda_link0", "panda_link8", 7, 7),
    Robot(ERD, "panda.urdf", "panda_link0", "panda_rightfinger", 8, 8),  # prismatic, mimics the left finger
    Robot(RTB, "lbr_iiwa_14_r820.urdf", "base_link", "tool0", 7, 7),
    Robot(ERD, "ur5_robot.urdf", "base_link", "tool0", 6, 6),
    Robot(ERD, "ur10_robot.urdf", "base_link", "tool0", 6, 6),
    Robot(ERD, "xarm7.urdf", "link_base", "link7", 7, 7),
    Robot(ERD, "tiago.urdf", "base_footprint", "arm_tool_link", 8, 8),  # the torso slides
    Robot(ERD, "pr2.urdf", "base_footprint", "r_gripper_l_finger_tip_link", 9, 10),  # slides, spins, mimics
    Robot(ERD, "baxter.urdf", "torso", "r_gripper_l_finger_tip", 8, 8),
    Robot(ERD, "talos_reduced.urdf", "torso_2_link", "gripper_left_fingertip_1_link", 7, 7),  # mimics by -1
    Robot(RTB, "puma560_robot.urdf", "link1", "link7", 6, 6),
]


def pinocchio_tip(model, base, tip, names, values):
    """Position, rotation and Jacobian (6, d) of the tip in the frame of `base`, which the joints named do not move."""
    data = model.createData()
    configuration, columns = pin.neutral(model), []
    for name, value in zip(names, values, strict=True):
        joint = model.joints[model.getJointId(name)]
        continuous = joint.nq == 2  # which Pinocchio stores as cosine and sine
        configuration[joint.idx_q : joint.idx_q + joint.nq] = (
            [np.cos(value), np.sin(value)] if continuous else value
        )
        columns.append(joint.idx_v)
    pin.computeJointJacobians(model, data, configuration)
    pin.updateFramePlacements(model, data)
    at_base, at_tip = (data.oMf[model.getFrameId(link)] for link in (base, tip))
    jacobian = pin.getFrameJacobian(model, data, model.getFrameId(tip), pin.LOCAL_WORLD_ALIGNED)[:, columns]
    placement, back = at_base.actInv(at_tip), at_base.rotation.T
    return placement.translation, placement.rotation, np.vstack([back @ jacobian[:3], back @ jacobian[3:]])


def assert_agree(chain, model, base, tip):
    low = np.where(np.isfinite(chain.lower), chain.lower, -np.pi)
    high = np.where(np.isfinite(chain.upper), chain.upper, np.pi)
    drawn = np.random.default_rng(0).uniform(low, high, (20, chain.dof))
    for values in [chain.home, *drawn]:
        position, rotation, jacobian = pinocchio_tip(model, base, tip, chain.joint_names, values)
        for algebra in ("quaternion", "conformal"):
            at, turn = chain.pose(values, algebra)
            matrix = pin.Quaternion(*turn).toRotationMatrix()
            assert np.allclose(at, position, rtol=0, atol=1e-9)
            assert np.allclose(matrix, rotation, rtol=0, atol=1e-9)
            assert np.allclose(chain.geometric_jacobian(values, algebra), jacobian, rtol=0, atol=1e-9)


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: f"{robot.file.split('.')[0]}-{robot.tip}")
def test_pose_and_jacobian_agree_with_pinocchio(robot):
    path = urdf_of(robot.package, robot.file)
    chain = chain_from_urdf(path, base=robot.base, tip=robot.tip)
    assert (chain.dof, len(chain.axis_names)) == (robot.joints, robot.axes)
    assert_agree(chain, pin.buildModelFromUrdf(path, mimic=True), robot.base, robot.tip)


@pytest.mark.parametrize(
    ("text", "base", "tip"), [(EVERY_KIND, "world", "tip"), (GRIPPER, "palm_mount", "pad")]
)
def test_mimic_joints_with_factors_and_offsets_agree_with_pinocchio(text, base, tip):
    assert_agree(chain_from_urdf(text, base, tip), pin.buildModelFromXML(text, mimic=True), base, tip)


def test_limits_are_those_pinocchio_reads():
    path = urdf_of(ERD, "panda.urdf")
    chain, model = chain_from_urdf(path, tip="panda_link8"), pin.buildModelFromUrdf(path)
    assert np.array_equal(chain.lower, model.lowerPositionLimit[:7])
    assert np.array_equal(chain.upper, model.upperPositionLimit[:7])
    assert ((chain.lower <= chain.home) & (chain.home <= chain.upper)).all()
