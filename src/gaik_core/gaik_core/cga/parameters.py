"""Directions, positions and radii back out of the objects of `gaik_core.cga.objects`, whatever their weight and sign.

GaikError where the object has another grade than the one asked for, and where a parameter does not exist: the centre of
a plane, the radius of spheres that do not meet.
"""

from __future__ import annotations

import numpy as np

from gaik_core.arrays import Array
from gaik_core.cga.basis import E1, E2, E3, E4, E5, E12, E13, E23, E45
from gaik_core.cga.blades import einf
from gaik_core.cga.multivector import Multivector
from gaik_core.cga.points import down, graded_components, vector_components
from gaik_core.errors import GaikError

ROUNDING = 1e-14
"""Of a product of two multivectors, as a share of their components' squares: what touches has a radius of zero."""

_VECTOR = [E1, E2, E3]
_WITH_E4 = [E1 | E4, E2 | E4, E3 | E4]
_WITH_E5 = [E1 | E5, E2 | E5, E3 | E5]


def line_direction(line: Multivector) -> Array:
    """a - b of eq. 13, `(…, 3)`: not a unit vector unless the line is unit."""
    x = graded_components("a line", line, 2)
    return np.stack((x[..., E23], -x[..., E13], x[..., E12]), axis=-1)


def line_moment(line: Multivector) -> Array:
    """c × (a - b) for any point c of the line, `(…, 3)`: with the direction, its Plücker coordinates."""
    x = graded_components("a line", line, 2)
    moment: Array = 0.5 * (x[..., _WITH_E4] + x[..., _WITH_E5])
    return moment


def line_point(line: Multivector) -> Array:
    """The point of the line nearest the origin, `(…, 3)`."""
    direction, moment = line_direction(line), line_moment(line)
    squared = np.sum(direction * direction, axis=-1, keepdims=True)
    if np.any(squared == 0.0):
        raise GaikError("a line at infinity has no nearest point: its direction is zero")
    point: Array = np.cross(direction, moment) / squared
    return point


def plane_normal(plane: Multivector) -> Array:
    """The unit normal, `(…, 3)`."""
    normal: Array = vector_components("a plane", plane)[..., _VECTOR]
    return normal / _length(normal)


def plane_distance(plane: Multivector) -> Array:
    """The signed distance of the plane from the origin, along its normal, shape `(…)`."""
    x = vector_components("a plane", plane)
    distance: Array = 0.5 * (x[..., E4] + x[..., E5]) / _length(x[..., _VECTOR])[..., 0]
    return distance


def centre(round_object: Multivector) -> Array:
    """The centre `(…, 3)` of a sphere, circle or point pair: what infinity becomes by reflection in it, X einf X̃."""
    _weight_squared(round_object)
    image = round_object * einf * ~round_object
    return down(image.grade(1))


def radius_squared(round_object: Multivector) -> Array:
    """The squared radius `(…)` of a sphere, circle or point pair: negative where it is the meet of what does not meet.

    r² = -X X̂ / (einf ⌋ X)², X̂ the grade involution.
    """
    return _radius_squared(round_object)[0]


def radius(round_object: Multivector) -> Array:
    """The radius `(…)` of a sphere, circle or point pair (half the distance of its points)."""
    squared, rounding = _radius_squared(round_object)
    if np.any(squared < -rounding):
        raise GaikError(f"the object is imaginary: its squared radius is {np.min(squared):.6g}")
    return np.sqrt(np.maximum(squared, 0.0))


def circle_normal(circle: Multivector) -> Array:
    """The unit normal of the circle's plane einf ⌋ X, `(…, 3)`."""
    graded_components("a circle", circle, 2)
    return plane_normal(einf.left_contraction(circle))


def pair_points(pair: Multivector) -> tuple[Array, Array]:
    """The two positions `(…, 3)` of a point pair (a ∧ b)*: a, then b."""
    graded_components("a point pair", pair, 3)
    outer = pair.undual()
    squared = outer.scalar_product(outer)
    size = np.sum(outer.components**2, axis=-1)
    if np.any(squared < -1e-12 * size):
        raise GaikError("the point pair is imaginary: what it comes from does not meet")
    root = Multivector.from_scalar(np.sqrt(np.maximum(squared, 0.0)))
    towards = einf.left_contraction(outer)
    return down(((outer - root) * towards).grade(1)), down(((outer + root) * towards).grade(1))


def flat_point_position(flat: Multivector) -> Array:
    """The position `(…, 3)` of a flat point (einf ∧ a)*."""
    graded_components("a flat point", flat, 3)
    outer = flat.undual().components  # e45 - x einf, for e45 = einf ∧ e0
    weight = outer[..., E45, None]
    if np.any(np.abs(weight) <= 1e-15 * np.abs(outer).max(axis=-1, keepdims=True)):
        raise GaikError("the flat point lies at infinity: it has no position")
    position: Array = -0.5 * (outer[..., _WITH_E4] + outer[..., _WITH_E5]) / weight
    return position


def _radius_squared(round_object: Multivector) -> tuple[Array, Array]:
    """The squared radius, and how far rounding may have moved it."""
    weight = _weight_squared(round_object)
    squared: Array = -round_object.scalar_product(round_object.grade_involution()) / weight
    return squared, ROUNDING * np.sum(round_object.components**2, axis=-1) / weight


def _weight_squared(round_object: Multivector) -> Array:
    """(einf ⌋ X)², zero for flat objects, which are refused."""
    towards = einf.left_contraction(round_object)
    squared = towards.scalar_product(towards)
    if np.any(np.abs(squared) <= 1e-24 * np.sum(round_object.components**2, axis=-1)):
        raise GaikError(
            "a flat object has neither centre nor radius; expected a sphere, circle or point pair"
        )
    return squared


def _length(vectors: Array) -> Array:
    length: Array = np.linalg.norm(vectors, axis=-1, keepdims=True)
    if np.any(length == 0.0):
        raise GaikError("the object has no normal: its vector part is zero")
    return length
