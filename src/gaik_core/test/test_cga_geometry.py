"""Points, objects and where they meet, against vector geometry done without any algebra."""

import numpy as np
import pytest

from gaik_core import cga
from gaik_core.cga import Multivector, blades
from gaik_core.cga.blades import I, Ie, e0, e1, e2, e12, einf
from gaik_core.errors import GaikError

A, B, C, D = np.random.default_rng(1).normal(size=(4, 20, 3))


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def incident(x, positions):
    """Whether the points lie on the object: their inner product with it vanishes."""
    product = cga.up(positions).left_contraction(x)
    return np.abs(product.components).max() < 1e-11 * np.abs(x.components).max()


def parallel(a, b):
    return np.allclose(unit(a), unit(b), atol=1e-9)


# --- points ----------------------------------------------------------------------------------------------------------


def test_points_are_equation_11():
    p, x = cga.up(A), Multivector.from_vector(A)
    assert p.isclose(x + 0.5 * (x * x).scalar * einf + e0).all()
    np.testing.assert_allclose((p * p).components, 0.0, atol=1e-13)
    np.testing.assert_allclose((p | einf).scalar, -1.0)


def test_inner_product_is_the_distance():
    """Eqs. 47 and 48, with the e0 that holds: eq. 10 as printed gives a negative square."""
    distance = np.linalg.norm(A - B, axis=-1)
    np.testing.assert_allclose(-2 * (cga.up(A) | cga.up(B)).scalar, distance**2, rtol=1e-12)
    np.testing.assert_allclose(cga.distance(cga.up(A), 3 * cga.up(B)), distance, rtol=1e-12)


def test_down_undoes_up_at_any_weight():
    weights = np.random.default_rng(2).uniform(-5, 5, 20)
    np.testing.assert_allclose(cga.down(weights * cga.up(A)), A, rtol=1e-12)


def test_down_of_what_is_no_point():
    for infinite in (einf, cga.plane([0, 0, 1], 2.0), 3 * e1):
        with pytest.raises(cga.InfinitePointError, match="infinity"):
            cga.down(infinite)
    with pytest.raises(GaikError, match="grade 1"):
        cga.down(e12 + e0)
    with pytest.raises(cga.InfinitePointError):
        cga.distance(einf, e0)
    with pytest.raises(GaikError, match="positions has shape"):
        cga.up([1.0, 2.0])


# --- objects ---------------------------------------------------------------------------------------------------------


def test_line_is_equation_13_and_the_dual_of_its_points():
    a, b = Multivector.from_vector(A), Multivector.from_vector(B)
    line = cga.line(A, B)
    assert line.isclose((a - b) * Ie - einf * (a ^ b) * Ie).all()
    assert line.isclose((cga.up(A) ^ cga.up(B) ^ einf).dual()).all()
    assert line.isclose(cga.line(cga.up(A), B)).all()
    np.testing.assert_allclose((line * line).scalar, -(np.linalg.norm(A - B, axis=-1) ** 2), rtol=1e-12)


def test_line_parameters():
    line = cga.line(A, B)
    np.testing.assert_allclose(cga.line_direction(line), A - B, atol=1e-13)
    np.testing.assert_allclose(cga.line_moment(line), np.cross(A, A - B), atol=1e-12)
    point = cga.line_point(line)
    assert incident(line, point) and incident(line, A) and incident(line, B)
    np.testing.assert_allclose(np.sum(point * (A - B), axis=-1), 0.0, atol=1e-12)
    assert not incident(line, C)


def test_axis_line_is_unit():
    line = cga.axis_line(A, 7.0 * B)
    assert line.isclose(cga.line(A + unit(B), A)).all()
    np.testing.assert_allclose((line * line + 1).components, 0.0, atol=1e-12)


def test_plane():
    plane = cga.plane_through(A, B, C)
    assert incident(plane, A) and incident(plane, B) and incident(plane, C) and not incident(plane, D)
    normal = cga.plane_normal(plane)
    assert parallel(normal, np.cross(B - A, C - A))
    np.testing.assert_allclose(cga.plane_distance(plane), np.sum(normal * A, axis=-1), atol=1e-12)
    assert plane.normalised().isclose(cga.plane(3 * normal, np.sum(normal * A, axis=-1))).all()


def test_distance_of_a_point_from_a_plane_is_their_inner_product():
    np.testing.assert_allclose((cga.up(A) | cga.plane([0, 0, 1], 0.5)).scalar, A[:, 2] - 0.5, atol=1e-13)


def test_sphere():
    sphere = cga.sphere_through(A, B, C, D)
    assert all(incident(sphere, x) for x in (A, B, C, D))
    centre, radius = cga.centre(sphere), cga.radius(sphere)
    for x in (A, B, C, D):
        np.testing.assert_allclose(np.linalg.norm(x - centre, axis=-1), radius, rtol=1e-7)
    direct = cga.sphere(A, np.arange(1.0, 21.0))
    np.testing.assert_allclose(cga.centre(direct), A, atol=1e-12)
    np.testing.assert_allclose(cga.down(direct), A, atol=1e-12)
    np.testing.assert_allclose(cga.radius(-2 * direct), np.arange(1.0, 21.0), rtol=1e-12)


def test_circle():
    circle = cga.circle_through(A, B, C)
    assert incident(circle, A) and incident(circle, B) and incident(circle, C)
    centre, radius, normal = cga.centre(circle), cga.radius(circle), cga.circle_normal(circle)
    for x in (A, B, C):
        np.testing.assert_allclose(np.linalg.norm(x - centre, axis=-1), radius, rtol=1e-9)
    assert parallel(normal, np.cross(B - A, C - A))
    again = cga.circle(centre, normal, radius)
    assert again.normalised().isclose(circle.normalised(), rtol=1e-7).all()


def test_point_pair():
    first, second = cga.pair_points(cga.point_pair(A, B))
    np.testing.assert_allclose(first, A, atol=1e-10)
    np.testing.assert_allclose(second, B, atol=1e-10)
    np.testing.assert_allclose(cga.centre(cga.point_pair(A, B)), (A + B) / 2, atol=1e-11)
    np.testing.assert_allclose(
        cga.radius(cga.point_pair(A, B)), np.linalg.norm(A - B, axis=-1) / 2, rtol=1e-10
    )


def test_flat_point():
    np.testing.assert_allclose(cga.flat_point_position(-3 * cga.flat_point(A)), A, atol=1e-12)


def test_a_flat_is_a_round_through_infinity():
    assert cga.circle_through(A, B, einf).isclose(cga.line(A, B)).all()
    assert cga.point_pair(einf, A).isclose(cga.flat_point(A)).all()


# --- meet, join, reflect ---------------------------------------------------------------------------------------------


def test_two_planes_meet_in_a_line():
    p, q = cga.plane_through(A, B, C), cga.plane_through(A, B, D)
    line = cga.meet(p, q)
    assert line.isclose(p ^ q).all()
    assert incident(line, A) and incident(line, B)
    assert np.allclose(np.abs(np.sum(unit(cga.line_direction(line)) * unit(A - B), axis=-1)), 1.0)


def test_line_and_plane_meet_in_a_flat_point():
    flat = cga.meet(cga.line(A, D), cga.plane_through(A, B, C))
    np.testing.assert_allclose(cga.flat_point_position(flat), A, atol=1e-8)


def test_two_lines_in_a_plane_meet_in_a_flat_point():
    """Their outer product vanishes, as the lines do not span space."""
    p, q = cga.line(A, B), cga.line(A, C)
    assert np.abs((p ^ q).components).max() < 1e-10
    np.testing.assert_allclose(cga.flat_point_position(cga.meet(p, q)), A, atol=1e-8)


@pytest.mark.parametrize("far", [0.0, 1e2, 1e3, 1e4])
def test_distances_and_spheres_far_from_the_origin(far):
    """Products of points at distance d lose d² times the rounding of 1; positions lose none."""
    place = np.array([1.0, 2.0, 3.0]) * far
    p, q = cga.up(place), cga.up(place + np.array([0.0, 0.0, 1e-3]))
    np.testing.assert_allclose(cga.distance(p, q), 1e-3, rtol=1e-6, atol=1e-7 * far / 1e4)
    sphere = cga.sphere(place, 1.0)
    np.testing.assert_allclose(cga.centre(sphere), place, rtol=1e-6)
    if far < 1e4:  # beyond, r² is lost in d²
        np.testing.assert_allclose(cga.radius(sphere), 1.0, rtol=1e-6 * max(far, 1.0))


def test_what_touches_meets_in_a_circle_without_radius():
    """By rounding, the squared radius comes out on either side of zero."""
    for normal in np.random.default_rng(4).normal(size=(200, 3)):
        normal /= np.linalg.norm(normal)
        touching = cga.meet(
            cga.sphere([0.3, -0.2, 0.1], 1.0), cga.plane(normal, normal @ [0.3, -0.2, 0.1] + 1.0)
        )
        assert cga.radius(touching) < 1e-6


def test_sphere_and_plane_meet_in_a_circle():
    circle = cga.meet(cga.sphere([1.0, 2, 3], 5.0), cga.plane([0, 0, 1], 0.0))
    np.testing.assert_allclose(cga.centre(circle), [1, 2, 0], atol=1e-12)
    np.testing.assert_allclose(cga.radius(circle), 4.0)
    missed = cga.meet(cga.sphere([0.0, 0, 3], 1.0), cga.plane([0, 0, 1], 0.0))
    np.testing.assert_allclose(cga.radius_squared(missed), 1.0 - 9.0)
    with pytest.raises(GaikError, match="imaginary: its squared radius is -8"):
        cga.radius(missed)


def test_sphere_and_line_meet_in_a_point_pair():
    pair = cga.meet(cga.sphere([0.0, 0, 0], 5.0), cga.axis_line([0, 3, 0], [1, 0, 0]))
    points = sorted(np.stack(cga.pair_points(pair)).tolist())
    np.testing.assert_allclose(points, [[-4, 3, 0], [4, 3, 0]], atol=1e-12)
    with pytest.raises(GaikError, match="imaginary"):
        cga.pair_points(cga.meet(cga.sphere([0.0, 0, 0], 1.0), cga.axis_line([0, 3, 0], [1, 0, 0])))


def test_a_tangent_meets_in_one_point_twice():
    pair = cga.meet(cga.sphere([0.0, 0, 0], 3.0), cga.axis_line([0, 3, 0], [1, 0, 0]))
    np.testing.assert_allclose(cga.pair_points(pair), [[0, 3, 0], [0, 3, 0]], atol=1e-6)


def test_two_spheres_meet_in_a_circle():
    circle = cga.meet(cga.sphere([0.0, 0, 0], 5.0), cga.sphere([6.0, 0, 0], 5.0))
    np.testing.assert_allclose(cga.centre(circle), [3, 0, 0], atol=1e-12)
    np.testing.assert_allclose(cga.radius(circle), 4.0)
    assert parallel(np.abs(cga.circle_normal(circle)), np.array([1.0, 0, 0]))


def test_two_circles_on_a_sphere_meet_in_a_point_pair():
    p, q = cga.circle_through(A[0], B[0], C[0]), cga.circle_through(A[0], B[0], D[0])
    points = sorted(np.stack(cga.pair_points(cga.meet(p, q))).tolist())
    np.testing.assert_allclose(points, sorted([A[0].tolist(), B[0].tolist()]), atol=1e-6)


def test_what_shares_nothing_but_infinity():
    skew = cga.meet(cga.axis_line([0, 0, 0], [1, 0, 0]), cga.axis_line([0, 0, 1], [0, 1, 0]))
    assert (skew / skew.coefficient("e4")).isclose(einf)
    parallel_lines = cga.meet(cga.axis_line([0, 0, 0], [1, 0, 0]), cga.axis_line([0, 0, 1], [1, 0, 0]))
    with pytest.raises(GaikError, match="infinity"):
        cga.flat_point_position(parallel_lines)


def test_an_object_meets_its_own_points_in_themselves():
    found = cga.meet(cga.up(A), cga.line(A, B))
    np.testing.assert_allclose(cga.down(found), A, atol=1e-8)
    same = cga.meet(cga.line(A, B), cga.line(A, B))
    assert incident(same, A) and same.grades(1e-9) == (2,)


def test_joins_of_points_and_flats():
    assert cga.join(cga.up(A), cga.up(B)).isclose(cga.point_pair(A, B)).all()
    assert cga.join(cga.join(cga.up(A), cga.up(B)), cga.up(C)).isclose(cga.circle_through(A, B, C)).all()
    plane = cga.join(cga.line(A, B), cga.up(C))
    assert incident(plane, A) and incident(plane, B) and incident(plane, C) and plane.grades() == (1,)
    shared = cga.join(cga.line(A, B), cga.line(A, C))
    assert incident(shared, B) and incident(shared, C) and shared.grades() == (1,)
    assert cga.join(cga.line(A, B), cga.up(A)).grades(1e-9) == (2,)


def test_meet_refuses_what_is_no_blade():
    for wrong in (1 + e12, e12 + blades.e34, 0 * e1):
        with pytest.raises(GaikError, match="take blades"):
            cga.meet(wrong, cga.plane([0, 0, 1]))


def test_outer_and_inner_forms():
    for x in (cga.sphere(A, 1.0), cga.line(A, B), cga.up(A)):
        assert cga.inner_form(cga.outer_form(x)).isclose(x).all()
    assert cga.outer_form(cga.line(A, B)).isclose(cga.up(A) ^ cga.up(B) ^ einf).all()
    assert cga.outer_form(cga.up(A)).isclose(cga.up(A)).all()


def test_reflections():
    mirror = cga.plane([1, 2, -1], 0.7)
    normal = unit(np.array([1.0, 2, -1]))
    mirrored = A - 2 * (A @ normal - 0.7)[:, None] * normal
    np.testing.assert_allclose(cga.down(cga.reflect(cga.up(A), mirror)), mirrored, atol=1e-12)
    inverted = cga.reflect(cga.up(A), cga.sphere(B, 2.0))
    np.testing.assert_allclose(
        cga.down(inverted), B + 4.0 * (A - B) / np.sum((A - B) ** 2, axis=-1)[:, None], atol=1e-9
    )
    half_turn = cga.reflect(cga.up(A), cga.axis_line([1, 0, 0], [0, 0, 1]))
    np.testing.assert_allclose(cga.down(half_turn), A * [-1, -1, 1] + [2, 0, 0], atol=1e-12)
    assert incident(cga.reflect(cga.line(A, B), mirror), mirrored)
    with pytest.raises(GaikError, match="even grades or odd"):
        cga.reflect(e1, 1 + e2)


# --- refusals --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: cga.axis_line([0, 0, 0], [0, 0, 0]), "direction has the length 0"),
        (lambda: cga.plane([0, 0, 0], 1.0), "normal has the length 0"),
        (lambda: cga.centre(cga.plane([0, 0, 1])), "flat object"),
        (lambda: cga.radius(cga.axis_line([0, 0, 0], [1, 0, 0])), "flat object"),
        (lambda: cga.plane_normal(cga.line([0, 0, 1], [0, 0, 0])), "a plane has grade 1"),
        (lambda: cga.line_direction(cga.plane([0, 0, 1])), "a line has grade 2"),
        (lambda: cga.line_point(e1 * einf), "line at infinity"),
        (lambda: cga.pair_points(e1), "a point pair has grade 3"),
        (lambda: cga.flat_point_position(I), "a flat point has grade 3"),
        (lambda: cga.circle_normal(e2), "a circle has grade 2"),
        (lambda: cga.plane_normal(einf), "no normal"),
    ],
)
def test_bad_input_is_named(call, message):
    with pytest.raises(GaikError, match=message):
        call()
