"""The laws of converting between our conventions and a driver's, and what was read in the drivers' sources."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from gaik_core import KinematicChain
from gaik_ros.driver_conventions import JointConvention, signed_axes, tip_force
from gaik_ros.drivers import DRIVERS

CHAIN = KinematicChain.load("touch_device")
vectors = arrays(np.float64, 3, elements=st.floats(-3.0, 3.0))
inside = st.tuples(st.floats(-0.9, 0.9), st.floats(0.2, 1.5), st.floats(-0.4, 0.8)).map(
    lambda q: np.array([q[0], q[1], q[1] + q[2]])
)
conventions = st.builds(
    lambda relative, signs, offsets: JointConvention(CHAIN, relative, signs, offsets),
    st.booleans(),
    st.tuples(*[st.sampled_from((-1.0, 1.0))] * 3),
    vectors,
)


def forms_of(driver):
    known = DRIVERS[driver]
    return JointConvention(CHAIN, known.relative, known.joint_signs, np.zeros(3)), signed_axes(
        known.force_axes
    )


@given(conventions, vectors)
def test_there_and_back_is_where_it_was(convention, values):
    for there, back in (
        (convention.to_driver, convention.from_driver),
        (convention.rates_to_driver, convention.rates_from_driver),
        (convention.efforts_to_driver, convention.efforts_from_driver),
    ):
        np.testing.assert_allclose(back(there(values)), values, atol=1e-12)
        np.testing.assert_allclose(there(back(values)), values, atol=1e-12)


@given(conventions, vectors, vectors)
def test_joint_power_is_the_same_on_both_sides(convention, efforts, rates):
    ours = efforts @ rates
    theirs = convention.efforts_to_driver(efforts) @ convention.rates_to_driver(rates)
    assert theirs == pytest.approx(ours, abs=1e-9)


@given(conventions, vectors, vectors)
def test_rates_are_the_derivatives_of_the_angles(convention, angles, rates):
    step = 1e-3  # the map is linear, so any step will do
    change = convention.to_driver(angles + step * rates) - convention.to_driver(angles)
    np.testing.assert_allclose(change / step, convention.rates_to_driver(rates), atol=1e-9)


@given(inside, vectors, vectors)
def test_the_force_does_the_work_of_the_efforts(angles, efforts, rates):
    jacobian = CHAIN.jacobian(angles)
    force = tip_force(jacobian, efforts, max_force=1e9, singular_value=1e-6)
    assert force.share == 1.0
    assert force.vector @ (jacobian @ rates) == pytest.approx(efforts @ rates, abs=1e-8)
    np.testing.assert_allclose(jacobian.T @ force.vector, efforts, atol=1e-9)


@given(inside, vectors, st.floats(0.1, 5.0))
def test_a_cut_force_keeps_its_direction_and_its_limit(angles, efforts, limit):
    jacobian = CHAIN.jacobian(angles)
    whole = tip_force(jacobian, efforts, 1e9, 1e-6).vector
    cut = tip_force(jacobian, efforts, limit, 0.03)
    assert np.linalg.norm(cut.vector) <= limit * (1.0 + 1e-12)
    np.testing.assert_allclose(cut.vector, cut.share * whole, atol=1e-9)
    assert 0.0 <= cut.share <= 1.0


def test_the_force_fades_to_zero_towards_a_singular_pose_without_a_jump():
    # With the elbow straightened the two links lie in one line, where no force along it can be made by the joints.
    straightening = np.linspace(0.4, np.pi / 2.0, 20_000)
    efforts = np.array([0.2, 0.3, -0.1])
    poses = np.stack(
        [np.zeros_like(straightening), np.full_like(straightening, 0.3), 0.3 + straightening], axis=1
    )
    smallest = np.array([np.linalg.svd(CHAIN.jacobian(pose), compute_uv=False)[-1] for pose in poses])
    forces = np.array([tip_force(CHAIN.jacobian(pose), efforts, 1e9, 0.02).vector for pose in poses])
    sizes = np.linalg.norm(forces, axis=1)
    assert smallest.max() > 0.04 and smallest.min() < 1e-6
    assert (sizes[smallest <= 0.02] == 0.0).all()
    assert sizes[smallest > 0.021].min() > 0.0
    assert np.abs(np.diff(sizes)).max() < 0.1  # N between poses 60 µrad apart; a switch would jump by several


def test_a_pose_on_the_singular_spot_itself_gives_zero_and_no_warning():
    force = tip_force(np.zeros((3, 3)), np.ones(3), 2.0, 0.02)
    assert force.vector.tolist() == [0.0, 0.0, 0.0]
    assert force.share == 0.0


@pytest.mark.parametrize("driver", ["geomagic_touch_ros2", "geomagic_touch_ros2_drivers", "phantom_omni"])
def test_the_omni_drivers_flip_the_waist_and_measure_the_elbow_from_the_upper_arm(driver):
    # omni_state.cpp: waist = -joints[0], shoulder = joints[1], elbow = joints[2] - joints[1], of HDAPI's angles,
    # and the force (x, y, z) goes to HDAPI as (x, z, -y).
    convention, axes = forms_of(driver)
    hdapi = np.array([0.3, 0.7, 1.1])
    np.testing.assert_allclose(convention.to_driver(hdapi), [-0.3, 0.7, 0.4], atol=1e-12)
    ours = np.array([1.0, 2.0, 3.0])
    x, y, z = axes @ ours
    assert [x, z, -y] == ours.tolist()


def test_saw_sensable_phantom_flips_the_waist_too_but_takes_forces_as_they_are():
    # mtsSensableHD.cpp: position[0] = -position[0], position[2] -= position[1]; servo_cf goes to HDAPI unchanged.
    convention, axes = forms_of("saw_sensable_phantom")
    np.testing.assert_allclose(convention.to_driver(np.array([0.3, 0.7, 1.1])), [-0.3, 0.7, 0.4], atol=1e-12)
    assert (axes == np.eye(3)).all()


@pytest.mark.parametrize("driver", ["geomagic_touch_x_ros2", "openhaptics", "own"])
def test_hdapi_s_own_angles_are_ours(driver):
    convention, axes = forms_of(driver)
    assert convention.to_driver(np.array([0.3, 0.7, 1.1])).tolist() == [0.3, 0.7, 1.1]
    assert (axes == np.eye(3)).all()


@pytest.mark.parametrize("text", ["x y z", "-x z y", "y z x", "x -z y"])
def test_axes_make_a_rotation(text):
    axes = signed_axes(text)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3))
    assert np.linalg.det(axes) == pytest.approx(1.0)


@pytest.mark.parametrize("text", ["", "x y", "x y -z", "x x y", "x y w", "x y z z", "--x y z", "0 0 0"])
def test_other_axes_are_refused(text):
    with pytest.raises(ValueError, match="right-handed"):
        signed_axes(text)


@pytest.mark.parametrize(
    ("signs", "offsets"),
    [([1, 1], [0, 0, 0]), ([1, 2, 1], [0, 0, 0]), ([1, 1, 1], [0, 0]), ([1, 1, 1], [0, np.nan, 0])],
)
def test_a_convention_that_does_not_fit_is_refused(signs, offsets):
    with pytest.raises(ValueError, match="they may be 3"):
        JointConvention(CHAIN, True, signs, offsets)
