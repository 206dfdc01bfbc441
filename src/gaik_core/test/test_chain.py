"""Forward kinematics and Jacobian: two algebras, matrices, finite differences and the paper's closed forms agree."""

import numpy as np
import pytest
from chains import ALGEBRAS, ROBOTS, matrix_walk, random_chain, rotation_matrix

from gaik_core import Joint, KinematicChain
from gaik_core.errors import GaikError, NotFiniteError, ShapeError, UnknownNameError, UnknownRobotError

rng = np.random.default_rng(20)


def all_chains():
    shipped = [KinematicChain.load(name) for name in ROBOTS]
    return shipped + [random_chain(rng, n, prismatic) for n in (1, 2, 7, 12) for prismatic in (False, True)]


@pytest.mark.parametrize("chain", all_chains(), ids=lambda c: f"{c.name}-{c.dof}")
class TestAnyChain:
    def test_both_algebras_agree_to_1e_12(self, chain):
        for angles in rng.uniform(-4, 4, (50, chain.dof)):
            for quantity in (chain.forward, chain.geometric_jacobian):
                by_quaternions, by_screw_rotors = (quantity(angles, algebra) for algebra in ALGEBRAS)
                size = max(1.0, np.abs(by_quaternions).max())
                assert np.abs(by_quaternions - by_screw_rotors).max() < 1e-12 * size

    def test_forward_is_what_matrices_give(self, chain):
        for angles in rng.uniform(-4, 4, (20, chain.dof)):
            position, rotation = matrix_walk(chain, angles)
            assert np.allclose(chain.forward(angles), position, atol=1e-12)
            found, quaternion = chain.pose(angles, "conformal")
            assert np.allclose(found, position, atol=1e-12)
            w, *v = quaternion
            assert np.allclose(rotation_matrix(v, 2 * np.arctan2(np.linalg.norm(v), w)), rotation, atol=1e-11)

    @pytest.mark.parametrize("algebra", ALGEBRAS)
    def test_jacobian_is_the_derivative_of_forward(self, chain, algebra):
        h = 1e-6
        for angles in rng.uniform(-3, 3, (10, chain.dof)):
            differences = [
                (chain.forward(angles + step) - chain.forward(angles - step)) / (2 * h)
                for step in h * np.eye(chain.dof)
            ]
            assert np.allclose(chain.jacobian(angles, algebra), np.transpose(differences), atol=1e-7)

    def test_many_angles_at_once_are_each_by_itself(self, chain):
        angles = rng.uniform(-3, 3, (6, chain.dof))
        assert np.array_equal(chain.forward(angles), [chain.forward(a) for a in angles])

    def test_frames_end_at_the_tip_and_keep_the_links_lengths(self, chain):
        angles = rng.uniform(-3, 3, chain.dof)
        points = chain.frames(angles)
        assert np.allclose(points[-1], chain.forward(angles), atol=1e-12)
        if all(joint.kind == "revolute" for joint in chain.joints):
            lengths = [np.linalg.norm(joint.link) for joint in chain.joints]
            assert np.allclose(np.linalg.norm(np.diff(points, axis=0), axis=1), lengths, atol=1e-12)


def test_touch_is_eq_78():
    touch = KinematicChain.load("touch")
    l1, l2, l3, l4 = 0.135, 0.135, 0.025, 0.17
    for t1, t2, t3 in rng.uniform(-3, 3, (50, 3)):
        reach = l1 * np.cos(t2) + l2 * np.sin(t3)
        eq78 = [
            -np.sin(t1) * reach,
            l3 + l1 * np.sin(t2) - l2 * np.cos(t3),
            -l4 + np.cos(t1) * reach,
        ]
        assert np.allclose(touch.forward([t1, t2, t3]), eq78, atol=1e-15)


def test_touch_forearm_keeps_its_direction_when_the_shoulder_turns():
    """The parallelogram: link 2 must not turn with θ2."""
    touch = KinematicChain.load("touch")
    before, after = touch.frames([0.3, 0.2, 0.7]), touch.frames([0.3, 1.1, 0.7])
    assert np.allclose(before[3] - before[2], after[3] - after[2], atol=1e-15)
    assert not np.allclose(before[2], after[2], atol=1e-3)


def test_touch_stands_where_the_paper_says_in_6_2():
    touch = KinematicChain.load("touch")
    start = touch.forward(np.radians([57.29, -57.29, 0.0]))
    assert np.allclose(start, [-0.0614, -0.2236, -0.1306], atol=5e-5)
    solution = touch.forward(np.radians([-16.39, 56.51, 49.54]))
    assert np.allclose(solution, [0.05, 0.05, 0.0], atol=1e-4)


def test_arm3_is_eq_63():
    arm = KinematicChain.load("arm3")
    l1 = l2 = 0.6
    for t1, t2, t3 in rng.uniform(-3, 3, (50, 3)):
        out = l1 * np.cos(t2) + l2 * np.sin(t2 + t3)
        eq63 = [np.cos(t1) * out, l1 * np.sin(t2) - l2 * np.cos(t2 + t3), np.sin(t1) * out]
        assert np.allclose(arm.forward([t1, t2, t3]), eq63, atol=1e-14)


def test_planar2_has_the_jacobian_of_eq_40():
    arm = KinematicChain.load("planar2")
    t1, t2 = 0.4, -1.3
    s1, c1, s12, c12 = np.sin(t1), np.cos(t1), np.sin(t1 + t2), np.cos(t1 + t2)
    eq40 = 0.1 * np.array([[-s1 - s12, -s12], [c1 + c12, c12], [0, 0]])
    for algebra in ALGEBRAS:
        assert np.allclose(arm.jacobian([t1, t2], algebra), eq40, atol=1e-15)


def test_touch_device_has_the_limits_of_the_drivers():
    device = KinematicChain.load("touch_device")
    assert device.joint_names == ("waist", "shoulder", "elbow")
    assert np.allclose(device.lower[:2], [-0.98, 0.0]) and np.allclose(device.upper[:2], [0.98, 1.75])
    assert np.isinf(device.lower[2]) and np.isinf(device.upper[2])
    assert (device.axis_lower[2], device.axis_upper[2]) == (-0.81, 1.25)
    assert np.allclose(device.axis_angles([0.1, 0.5, 0.7]), [0.1, 0.5, 0.2])


def test_the_paper_touch_has_no_limits():
    assert not KinematicChain.load("touch").limited
    assert KinematicChain.load("touch_device").limited


class TestBadArguments:
    touch = KinematicChain.load("touch")

    def test_unknown_robot_lists_the_known(self):
        with pytest.raises(UnknownRobotError, match=r"'touhc'.*did you mean 'touch'.*arm3.*planar2"):
            KinematicChain.load("touhc")

    def test_unknown_algebra_lists_the_known(self):
        with pytest.raises(UnknownNameError, match=r"'octonion'.*quaternion, conformal"):
            self.touch.forward([0, 0, 0], "octonion")

    @pytest.mark.parametrize("angles", [[0, 0], 1.0, np.zeros((2, 2, 3)), np.zeros((4, 2))])
    def test_wrong_shape_names_what_it_was_and_may_be(self, angles):
        with pytest.raises(ShapeError, match=r"angles has shape .*\(3,\)"):
            self.touch.forward(angles)

    @pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
    def test_what_is_not_finite_is_refused(self, bad):
        for call in (self.touch.forward, self.touch.jacobian, self.touch.frames):
            with pytest.raises(NotFiniteError, match="angles"):
                call([0.0, bad, 0.0])

    def test_text_is_refused(self):
        with pytest.raises(GaikError, match="angles is"):
            self.touch.forward(["a", "b", "c"])

    @pytest.mark.parametrize(
        ("joints", "message"),
        [
            ([], "at least one joint"),
            ([Joint("a", (0, 0, 1)), Joint("a", (0, 0, 1))], "two joints are called 'a'"),
            ([Joint("a", (0, 0, 1), coupling={"b": 1.0})], "'b'.*known: a"),
            ([Joint("a", (0, 0, 1)), Joint("p", (0, 0, 1), passive=True)], "passive without a coupling"),
        ],
    )
    def test_impossible_chains(self, joints, message):
        with pytest.raises(GaikError, match=message):
            KinematicChain(joints)

    @pytest.mark.parametrize("angles", [1.0, [1.0], np.zeros((2, 4))])
    def test_axis_angles_name_the_shape(self, angles):
        with pytest.raises(ShapeError, match=r"angles has shape .*; expected \(…, 3\)"):
            self.touch.axis_angles(angles)

    def test_what_is_no_joint_and_no_orientation(self):
        with pytest.raises(GaikError, match="a joint is 'elbow'; expected a Joint"):
            KinematicChain(["elbow"])
        with pytest.raises(GaikError, match=r"orientation is .*; expected anything but zero"):
            KinematicChain([Joint("a", (0, 0, 1))], orientation=(0, 0, 0, 0))

    @pytest.mark.parametrize("robot", [None, 3, ["touch"]])
    def test_what_is_no_name_of_a_robot(self, robot):
        with pytest.raises(UnknownRobotError, match=r"unknown robot .*known: .*touch"):
            KinematicChain.load(robot)
