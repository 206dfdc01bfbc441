"""Hamilton's algebra: its laws on random elements, and rotations against matrices made by Rodrigues' formula."""

import numpy as np
import pytest

from gaik_core import quaternion
from gaik_core.errors import GaikError
from gaik_core.quaternion import Quaternion


def random_quaternions(seed, count=200):
    return Quaternion(np.random.default_rng(seed).normal(size=(count, 4)))


def random_rotations(seed, count=200):
    return random_quaternions(seed, count).normalised()


def rodrigues(axis, angle):
    """R = 1 + sin θ [n] + (1 - cos θ) [n]², with [n] v = n × v."""
    n = np.asarray(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def test_hamiltons_rules():
    i, j, k = Quaternion([0, 1, 0, 0]), Quaternion([0, 0, 1, 0]), Quaternion([0, 0, 0, 1])
    for unit in (i, j, k):
        assert unit * unit == -1
    assert i * j * k == -1
    assert i * j == k
    assert j * i == -k


def test_product_is_associative_and_distributes():
    p, q, r = (random_quaternions(seed) for seed in (1, 2, 3))
    assert ((p * q) * r).isclose(p * (q * r)).all()
    assert (p * (q + r)).isclose(p * q + p * r).all()
    assert ((p + q) * r).isclose(p * r + q * r).all()


def test_norm_of_a_product_is_the_product_of_norms():
    p, q = random_quaternions(4), random_quaternions(5)
    np.testing.assert_allclose((p * q).norm(), p.norm() * q.norm(), rtol=1e-12)


def test_conjugate_turns_products_round():
    p, q = random_quaternions(6), random_quaternions(7)
    assert (~(p * q)).isclose(~q * ~p).all()
    assert (p * ~p).isclose(p.norm() ** 2).all()


def test_inverse_and_division():
    p, q = random_quaternions(8), random_quaternions(9)
    assert (p * p.inverse()).isclose(1).all()
    assert ((p / q) * q).isclose(p).all()
    assert (1 / p).isclose(p.inverse()).all()


def test_inverse_survives_the_ends_of_the_number_range():
    for size in (1e-200, 1e200):
        assert (Quaternion([size, 0, 0, size]) * Quaternion([size, 0, 0, size]).inverse()).isclose(1)


def test_exp_of_log_is_the_same():
    q = random_quaternions(10)
    assert q.log().exp().isclose(q).all()


@pytest.mark.parametrize("size", [1e-300, 1e-9, 1e-3, 1.0, 3.1])
def test_log_of_exp_is_the_same_while_the_angle_is_below_pi(size):
    vectors = np.random.default_rng(11).normal(size=(50, 3))
    q = Quaternion.from_vector(size * vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)) + 0.3
    assert q.exp().log().isclose(q, atol=0.0).all()


def test_exp_is_the_limit_of_its_series():
    q = random_quaternions(12)
    term, total = Quaternion(np.tile([1.0, 0, 0, 0], (200, 1))), Quaternion(np.zeros((200, 4)))
    for order in range(1, 60):
        total, term = total + term, term * q / float(order)
    assert q.exp().isclose(total).all()


def test_log_of_a_negative_number_is_along_i():
    np.testing.assert_allclose(quaternion.log([-1.0, 0, 0, 0]), [0, np.pi, 0, 0])


def test_powers():
    q = random_rotations(13)
    assert (q**3).isclose(q * q * q).all()
    assert ((q**0.5) ** 2).isclose(q).all()


def test_rotation_is_rodrigues():
    random = np.random.default_rng(14)
    for _ in range(50):
        axis, angle, v = random.normal(size=3), random.uniform(-7, 7), random.normal(size=3)
        q = Quaternion.from_axis_angle(axis, angle)
        np.testing.assert_allclose(q.rotate(v), rodrigues(axis, angle) @ v, atol=1e-14)
        np.testing.assert_allclose(q.to_matrix(), rodrigues(axis, angle), atol=1e-14)


def test_rotate_is_q_v_conjugate_q_whatever_the_norm():
    q, v = random_quaternions(15), np.random.default_rng(16).normal(size=(200, 3))
    product = q * Quaternion.from_vector(v) * ~q
    np.testing.assert_allclose(q.rotate(v), product.vector, atol=1e-12)
    np.testing.assert_allclose(product.scalar, 0.0, atol=1e-12)


def test_composition_applies_the_right_factor_first():
    p, q, v = random_rotations(17), random_rotations(18), np.random.default_rng(19).normal(size=(200, 3))
    np.testing.assert_allclose((p * q).rotate(v), p.rotate(q.rotate(v)), atol=1e-13)


def test_matrix_and_back():
    q = random_rotations(20)
    q = Quaternion(np.where(q.scalar[:, None] < 0, -q.components, q.components))
    assert Quaternion.from_matrix(q.to_matrix()).isclose(q).all()


@pytest.mark.parametrize("axis", [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [-1, 2, -3]])
def test_matrix_of_a_half_turn(axis):
    """Where w = 0 the usual formula divides by zero."""
    found = quaternion.to_matrix(quaternion.from_matrix(rodrigues(axis, np.pi)))
    np.testing.assert_allclose(found, rodrigues(axis, np.pi), atol=1e-15)


def test_axis_and_angle_and_back():
    axis, angle = random_rotations(21).to_axis_angle()
    assert ((angle >= 0) & (angle <= np.pi)).all()
    np.testing.assert_allclose(np.linalg.norm(axis, axis=-1), 1.0)
    back_axis, back_angle = quaternion.to_axis_angle(quaternion.from_axis_angle(axis, angle))
    np.testing.assert_allclose(back_axis, axis, atol=1e-12)
    np.testing.assert_allclose(back_angle, angle, atol=1e-12)


def test_angle_of_q_and_minus_q_is_the_same():
    q = random_rotations(22)
    np.testing.assert_allclose(q.to_axis_angle()[1], (-q).to_axis_angle()[1])


def test_a_tiny_turn_keeps_its_axis_and_angle():
    axis, angle = quaternion.to_axis_angle(quaternion.from_axis_angle([0, 0, 2], 1e-12))
    np.testing.assert_allclose(axis, [0, 0, 1])
    np.testing.assert_allclose(angle, 1e-12)


def test_interpolation_turns_at_constant_speed():
    p, axis = random_rotations(23, 1)[0], np.array([1.0, 2, -1])
    fractions = np.linspace(0, 1, 11)
    steps = p.interpolate(p * Quaternion.from_axis_angle(axis, 2.5), fractions)
    expected = p * Quaternion.from_axis_angle(axis, 2.5 * fractions)
    assert steps.isclose(expected).all()


def test_interpolation_takes_the_shorter_way():
    p, q = Quaternion.identity(), Quaternion.from_axis_angle([0, 0, 1], 1.0)
    half = p.interpolate(-q, 0.5)
    np.testing.assert_allclose(half.to_matrix(), rodrigues([0, 0, 1], 0.5), atol=1e-15)


def test_functions_broadcast():
    left, right = np.ones((5, 1, 4)), np.ones((1, 7, 4))
    assert quaternion.multiply(left, right).shape == (5, 7, 4)
    assert quaternion.rotate(left, np.ones((7, 3))).shape == (5, 7, 3)
    assert quaternion.from_axis_angle([0, 0, 1], np.zeros((2, 3))).shape == (2, 3, 4)


def test_numbers_and_arrays_scale_from_both_sides():
    q = random_quaternions(24, 3)
    factors = np.array([1.0, 2.0, 3.0])
    np.testing.assert_array_equal((factors * q).components, factors[:, None] * q.components)
    np.testing.assert_array_equal((q * factors).components, (factors * q).components)
    assert (2 - q + q == 2).all() or (2 - q + q).isclose(2).all()


def test_values_are_frozen():
    source = np.array([1.0, 2, 3, 4])
    q = Quaternion(source)
    source[0] = 9.0
    np.testing.assert_array_equal(q.components, [1, 2, 3, 4])
    with pytest.raises(ValueError, match="read-only"):
        q.components[0] = 5.0
    with pytest.raises(AttributeError):
        q.w = 1.0


def test_arrays_are_indexed_by_quaternion():
    q = random_quaternions(25, 6)
    assert len(q) == len(list(q)) == 6
    with pytest.raises(TypeError, match="no length"):
        list(q[0])
    np.testing.assert_array_equal(q[2].components, q.components[2])
    np.testing.assert_array_equal(q[1:4].components, q.components[1:4])
    with pytest.raises(IndexError):
        q[0][0]


def test_indices_never_reach_into_the_components():
    with pytest.raises(IndexError):
        random_quaternions(26, 6)[0, 0]


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: Quaternion([1, 2, 3]), r"components has shape \(3,\); expected \(…, 4\)"),
        (lambda: Quaternion("abcd"), "expected real numbers"),
        (lambda: Quaternion([1j, 0, 0, 0]), "expected real numbers"),
        (lambda: quaternion.inverse([0, 0, 0, 0]), "q is zero"),
        (lambda: quaternion.log([0, 0, 0, 0]), "q is zero"),
        (lambda: quaternion.normalise(np.zeros((2, 4))), "q is zero"),
        (lambda: quaternion.from_axis_angle([0, 0, 0], 1.0), "axis has the length 0"),
        (lambda: quaternion.from_matrix(np.diag([1.0, 1, -1])), "no rotation"),
        (lambda: quaternion.from_matrix(2 * np.eye(3)), "no rotation"),
        (lambda: quaternion.from_matrix(np.eye(4)), r"expected \(…, 3, 3\)"),
        (lambda: quaternion.rotate([1, 0, 0, 0], [1, 2]), r"v has shape \(2,\)"),
    ],
)
def test_bad_input_is_named(call, message):
    with pytest.raises(GaikError, match=message):
        call()
