"""Motors against rigid motions done with matrices, and the paper's equations 12, 44, 50, 52 and 56."""

import numpy as np
import pytest

from gaik_core import cga, quaternion
from gaik_core.cga import Multivector
from gaik_core.cga.blades import Ie, e1, e2, e3, e12, e45, einf
from gaik_core.errors import GaikError
from gaik_core.quaternion import Quaternion
from gaik_core.versors import Motor, Rotor, Translator, VersorError

RANDOM = np.random.default_rng(1)
POINTS, AXES, PLACES, TRANSLATIONS = RANDOM.normal(size=(4, 30, 3))
ANGLES, SLIDES = RANDOM.uniform(-3, 3, size=(2, 30))
MOTORS = Motor.from_axis(PLACES, AXES, ANGLES, SLIDES)


def rotated(points, axes, angles):
    """Rodrigues' formula."""
    n, angles = axes / np.linalg.norm(axes, axis=-1, keepdims=True), np.asarray(angles)[..., None]
    along = np.sum(n * points, axis=-1, keepdims=True)
    return np.cos(angles) * points + np.sin(angles) * np.cross(n, points) + (1 - np.cos(angles)) * along * n


def moved():
    """The points turned about each axis through its place, and slid along it."""
    n = AXES / np.linalg.norm(AXES, axis=-1, keepdims=True)
    return PLACES + rotated(POINTS - PLACES, AXES, ANGLES) + SLIDES[:, None] * n


def close(a, b, atol=1e-12):
    return np.abs((a - b).components).max() < atol


def test_a_motor_turns_about_its_axis_and_slides_along_it():
    np.testing.assert_allclose(MOTORS.apply(POINTS), moved(), atol=1e-12)
    sandwich = MOTORS * cga.up(POINTS) * ~MOTORS
    np.testing.assert_allclose(cga.down(sandwich), moved(), atol=1e-12)
    np.testing.assert_allclose((sandwich | einf).scalar, -1.0, atol=1e-12)


def test_screw_rotor_is_equation_12():
    line, theta = cga.axis_line(PLACES[0], AXES[0]), 0.8
    motor = Motor.from_line(line, theta)
    assert close(motor, np.cos(theta / 2) - np.sin(theta / 2) * line)
    assert close(motor, (-theta / 2 * line).exp())
    assert close(~motor, (theta / 2 * line).exp())


def test_the_angle_turned_is_theta():
    """From b to a turns positively: about e3 a quarter turn takes x to y."""
    motor = Motor.from_line(cga.line([0, 0, 1], [0, 0, 0]), np.pi / 2)
    np.testing.assert_allclose(motor.apply([1, 0, 0]), [0, 1, 0], atol=1e-15)


def test_derivative_of_a_chain_is_equation_50():
    """∂p_f/∂θ_j = p_f · L'_j, with L'_j of eq. 52, against central differences."""
    lines = cga.axis_line(PLACES[:4], AXES[:4])
    p0, angles, step = cga.up(POINTS[0]), ANGLES[:4], 1e-6

    def forward(angles):
        motor = Motor.identity()
        for line, angle in zip(lines, angles, strict=True):
            motor = motor * Motor.from_line(line, angle)
        return motor.apply(p0)

    for j in range(4):
        before = Motor.identity()
        for i in range(j):
            before = before * Motor.from_line(lines[i], angles[i])
        nudge = step * np.eye(4)[j]
        slope = (forward(angles + nudge) - forward(angles - nudge)) / (2 * step)
        assert close(forward(angles) | before.apply(lines[j]), slope, atol=1e-7)


def test_motors_move_every_object_alike():
    images = MOTORS.apply(POINTS), MOTORS.apply(PLACES), MOTORS.apply(TRANSLATIONS)
    for build in (cga.plane_through, cga.circle_through):
        assert close(MOTORS.apply(build(POINTS, PLACES, TRANSLATIONS)), build(*images), atol=1e-9)
    assert close(MOTORS.apply(cga.line(POINTS, PLACES)), cga.line(*images[:2]), atol=1e-10)
    assert close(MOTORS.apply(cga.sphere(POINTS, 0.5)), cga.sphere(images[0], 0.5), atol=1e-10)
    assert close(MOTORS.apply(einf), einf, atol=1e-12)


def test_one_motor_moves_one_object_as_many_move_many():
    lines, mixed = cga.line(POINTS, PLACES), Multivector(RANDOM.normal(size=(30, 32)))
    for objects in (cga.up(POINTS), lines, mixed):
        together = MOTORS.apply(objects)
        for motor, x, image in zip(MOTORS, objects, together, strict=True):
            assert close(motor.apply(x), image, atol=1e-10)
            assert close(motor * x * ~motor, image, atol=1e-10)


def test_composition_does_the_right_factor_first():
    n = Motor.from_axis(TRANSLATIONS, POINTS, SLIDES)
    np.testing.assert_allclose((MOTORS * n).apply(POINTS), MOTORS.apply(n.apply(POINTS)), atol=1e-11)


def test_reverse_undoes():
    assert close(MOTORS * ~MOTORS, Motor.identity())
    assert close(MOTORS.inverse(), ~MOTORS)
    np.testing.assert_allclose((~MOTORS).apply(moved()), POINTS, atol=1e-11)


def test_normalised_mends_a_drifted_motor():
    drift = 1e-4 * RANDOM.normal(size=(30, 32)) * (np.abs(MOTORS.components) > 1e-9)
    drift[:, 16:24] = drift[:, 8:16]
    drifted = MOTORS + Multivector(drift)
    with pytest.raises(VersorError):
        Motor(drifted.components)
    mended = Motor._of(drifted.components).normalised()
    assert close(mended * ~mended, Motor.identity(), atol=1e-7)
    assert close(mended.normalised(), Motor(mended.normalised().components))
    assert close(mended, MOTORS, atol=2e-3)
    assert close(MOTORS.normalised(), MOTORS)


def test_kinds():
    rotor, translator = Rotor.from_axis_angle([0, 0, 1], 0.3), Translator.from_vector([1, 2, 3])
    assert type(rotor * rotor) is type(~rotor) is Rotor
    assert type(translator * translator) is Translator
    assert type(translator * rotor) is type(rotor * translator) is type(MOTORS[0]) is Motor
    assert type(rotor * e1) is type(e1 * rotor) is type(2 * rotor) is type(rotor + rotor) is Multivector
    assert type(Rotor.identity()) is Rotor and type(MOTORS[2:4]) is Motor


def test_a_motor_is_a_multivector_and_prints():
    assert isinstance(MOTORS, Multivector)
    assert str(Translator.from_vector([2, 0, 0])) == "1 - e14 - e15"
    assert Motor(Multivector.parse(str(MOTORS[0])).components) == MOTORS[0]


@pytest.mark.parametrize("q", [Quaternion, np.asarray])
def test_rotors_are_quaternions(q):
    wxyz = quaternion.normalise(RANDOM.normal(size=(10, 4)))
    rotor = Rotor.from_quaternion(q(wxyz))
    np.testing.assert_allclose(rotor.rotation, wxyz)
    np.testing.assert_allclose(rotor.apply(POINTS[:10]), quaternion.rotate(wxyz, POINTS[:10]), atol=1e-13)
    other = quaternion.normalise(RANDOM.normal(size=(10, 4)))
    product = rotor * Rotor.from_quaternion(other)
    np.testing.assert_allclose(product.rotation, quaternion.multiply(wxyz, other), atol=1e-14)


def test_rotor_is_the_exponential_of_its_axis():
    n = AXES[0] / np.linalg.norm(AXES[0])
    assert close(Rotor.from_axis_angle(AXES[0], 0.7), (-0.35 * Multivector.from_vector(n) * Ie).exp())


def test_translator():
    translator = Translator.from_vector(TRANSLATIONS)
    np.testing.assert_allclose(translator.apply(POINTS), POINTS + TRANSLATIONS, atol=1e-14)
    assert close(translator, (-0.5 * Multivector.from_vector(TRANSLATIONS) * einf).exp())
    np.testing.assert_allclose(translator.translation, TRANSLATIONS)


def test_rotation_and_translation_and_back():
    motor = Motor.from_rotation_translation(MOTORS.rotation, TRANSLATIONS)
    np.testing.assert_allclose(motor.translation, TRANSLATIONS, atol=1e-13)
    np.testing.assert_allclose(
        motor.apply(POINTS), quaternion.rotate(MOTORS.rotation, POINTS) + TRANSLATIONS, atol=1e-12
    )


def test_matrices():
    matrix = MOTORS.to_matrix()
    homogeneous = np.concatenate((POINTS, np.ones((30, 1))), axis=-1)
    np.testing.assert_allclose((matrix @ homogeneous[..., None])[:, :3, 0], moved(), atol=1e-12)
    np.testing.assert_allclose(Motor.from_matrix(matrix).to_matrix(), matrix, atol=1e-12)


def test_exp_of_log_is_the_motor():
    assert close(Motor.exp(MOTORS.log()), MOTORS)
    assert MOTORS.log().grades() == (2,)


def test_log_is_half_the_screw():
    """log M = -½ (θ L + d einf), here with d along the line."""
    angle, slide = np.abs(ANGLES), SLIDES * np.sign(ANGLES)
    axes = AXES * np.sign(ANGLES)[:, None]
    n = Multivector.from_vector(axes / np.linalg.norm(axes, axis=-1, keepdims=True))
    expected = -0.5 * (angle * cga.axis_line(PLACES, axes) + slide * n * einf)
    assert close(MOTORS.log(), expected, atol=1e-11)


@pytest.mark.parametrize("angle", [1e-12, 1e-6, 1e-3, 0.1, 1.0, 3.0, 6.0])
def test_log_and_exp_of_small_and_large_turns(angle):
    line = cga.axis_line(PLACES[0], AXES[0])
    bivector = -0.5 * (angle * line + 0.4 * Multivector.from_vector(cga.line_direction(line)) * einf)
    assert close(Motor.exp(bivector).log(), bivector, atol=1e-11)


def test_screw_parameters():
    line, angle, slide = MOTORS.to_screw()
    np.testing.assert_allclose(angle, np.abs(ANGLES), atol=1e-12)
    np.testing.assert_allclose(slide, SLIDES * np.sign(ANGLES), atol=1e-12)
    assert close(line, cga.axis_line(PLACES, AXES * np.sign(ANGLES)[:, None]), atol=1e-11)
    again = Motor.from_line(line, angle, slide)
    np.testing.assert_allclose(again.apply(POINTS), moved(), atol=1e-11)


def test_screws_without_a_turn():
    line, angle, slide = Translator.from_vector([0, 0, -3.0]).to_screw()
    assert (angle, slide) == (0.0, 3.0)
    np.testing.assert_allclose(cga.line_direction(line), [0, 0, -1])
    _, angle, slide = Motor.identity().to_screw()
    assert (angle, slide) == (0.0, 0.0)


@pytest.mark.parametrize("seed", range(6))
def test_between_two_motors_of_one_orientation_there_is_no_turn(seed):
    """Rounding leaves a turn of some 1e-17 rad between them, about an axis 1e14 m away."""
    turned = np.random.default_rng(seed).normal(size=4)
    turned /= np.linalg.norm(turned)
    a, b = (Motor.from_rotation_translation(turned, [x, 0.2, 0.5]) for x in (0.3, 0.4))
    line, angle, slide = (b * ~a).to_screw()
    assert angle < 1e-15
    np.testing.assert_allclose(slide * cga.line_direction(line), [0.1, 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(cga.line_point(line), 0.0, atol=1e-12)


def test_interpolation_is_a_screw_at_constant_speed():
    start, line, fractions = MOTORS[0], cga.axis_line(PLACES[1], AXES[1]), np.linspace(0, 1, 9)
    end = start * Motor.from_line(line, 2.0, 0.5)
    expected = start * Motor.from_line(line, 2.0 * fractions, 0.5 * fractions)
    assert close(start.interpolate(end, fractions), expected, atol=1e-11)
    assert start.interpolate(-end, 0.25).isclose(start.interpolate(end, 0.25), atol=1e-11)


def test_shortest_turn_between_directions():
    rotor = Rotor.between(AXES, POINTS)
    turned = rotor.apply(AXES)
    np.testing.assert_allclose(np.cross(turned, POINTS), 0.0, atol=1e-12)
    assert (np.sum(turned * POINTS, axis=-1) > 0).all()
    np.testing.assert_allclose(rotor.apply(np.cross(AXES, POINTS)), np.cross(AXES, POINTS), atol=1e-12)


def test_arrays_broadcast():
    fan = Motor.from_axis([0, 0, 0], [0, 0, 1], np.linspace(0, 1, 5))
    assert fan.shape == (5,)
    assert fan.apply([1.0, 0, 0]).shape == (5, 3)
    assert MOTORS[0].apply(np.zeros((4, 7, 3))).shape == (4, 7, 3)
    assert fan[:, None].apply(POINTS).shape == (5, 30, 3)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: Motor.from_line(cga.line([0, 0, 2], [0, 0, 0]), 1.0), r"take line.normalised\(\)"),
        (lambda: Motor.from_line(cga.plane([0, 0, 1]), 1.0), "a line; this has other components"),
        (lambda: Motor.from_line(e12 + e3 * einf, 1.0), "L² = -1"),
        (lambda: Motor.from_line(cga.circle([0, 0, 0], [0, 0, 1], 1.0), 1.0), "other components"),
        (lambda: Motor.exp(e45), "other components"),
        (lambda: Motor.exp(1 + e12), "other components"),
        (lambda: Motor((2 * Motor.identity()).components), "unit motor"),
        (lambda: Motor((e1 * e45).components), "unit motor"),
        (lambda: Rotor(Translator.from_vector([1, 0, 0]).components), "unit rotor"),
        (lambda: Translator(Rotor.from_axis_angle([1, 0, 0], 1.0).components), "unit translator"),
        (lambda: Rotor.from_quaternion([2, 0, 0, 0]), "unit quaternion"),
        (lambda: Rotor.from_quaternion([np.nan, 0, 0, 0]), "unit quaternion"),
        (lambda: Motor(np.full(32, np.nan)), "unit motor"),
        (lambda: Rotor.between([1, 0, 0], [-2, 0, 0]), "opposite"),
        (lambda: Motor.from_axis([0, 0, 0], [0, 0, 0], 1.0), "direction has the length 0"),
        (lambda: Motor.from_matrix(np.eye(3)), "expected"),
        (lambda: Motor.from_matrix(np.diag([1.0, 1, -1, 1])), "no rotation"),
        (lambda: Motor.identity().apply([1, 2]), "has shape"),
    ],
)
def test_bad_input_is_named(call, message):
    with pytest.raises(GaikError, match=message):
        call()


def test_the_error_is_a_versor_error():
    with pytest.raises(VersorError):
        Motor.exp(e2 + e12)
