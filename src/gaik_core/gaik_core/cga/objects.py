"""Lines, planes, spheres, circles and point pairs.

An object here is what the paper's line (eq. 13) is: the blade whose inner product with a point is zero exactly where
the point lies on it (the inner form, also dual or IPNS). `x.undual()` is the outer product of points of it (the outer
form, also direct or OPNS). A versor moves both forms alike.

| object | grade | from points | from parameters |
| --- | --- | --- | --- |
| sphere | 1 | (a ∧ b ∧ c ∧ d)* | centre - ½ radius² einf |
| plane | 1 | (einf ∧ a ∧ b ∧ c)* | normal + distance einf |
| circle | 2 | (a ∧ b ∧ c)* | plane ∧ sphere |
| line | 2 | (einf ∧ a ∧ b)* | eq. 13 |
| point pair | 3 | (a ∧ b)* | |
| flat point | 3 | (einf ∧ a)* | |
| point | 1 | a itself: null vectors are their own outer form | |

Points are given as positions `(…, 3)` or as conformal points; all arguments broadcast. A circle's normal and a plane's
turn right-handed from a by b to c.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gaik_core import arrays
from gaik_core.arrays import Array
from gaik_core.cga.blades import Ie, einf
from gaik_core.cga.multivector import Multivector
from gaik_core.cga.points import up
from gaik_core.errors import GaikError

Point = Multivector | ArrayLike


def line(a: Point, b: Point) -> Multivector:
    """L = (a - b) I_e - einf (a ∧ b) I_e (eqs. 13, 45), the line through a and b; from b to a turns positively.

    L² = -|a - b|², so as the axis of a screw rotor it needs |a - b| = 1, or `.normalised()`.
    """
    if isinstance(a, Multivector) or isinstance(b, Multivector):
        return (einf ^ _point(a) ^ _point(b)).dual()
    a, b = Multivector.from_vector(a), Multivector.from_vector(b)
    return (a - b) * Ie - einf * (a ^ b) * Ie


def axis_line(point: ArrayLike, direction: ArrayLike) -> Multivector:
    """The unit line (L² = -1) through a point along a direction, each `(…, 3)`; turns are right-handed about it."""
    point = arrays.components("point", point, 3)
    return line(point + unit("direction", direction), point)


def plane(normal: ArrayLike, distance: ArrayLike = 0.0) -> Multivector:
    """n + d einf: the plane x·n = d with the unit normal along `(…, 3)`, at a signed distance `(…)` from the origin."""
    return Multivector.from_vector(unit("normal", normal)) + arrays.numbers("distance", distance) * einf


def plane_through(a: Point, b: Point, c: Point) -> Multivector:
    """The plane through three points."""
    return (einf ^ _point(a) ^ _point(b) ^ _point(c)).dual()


def sphere(centre: ArrayLike, radius: ArrayLike) -> Multivector:
    """c - ½ r² einf: centre `(…, 3)`, radius `(…)`."""
    radius = arrays.numbers("radius", radius)
    return up(centre) - (0.5 * radius * radius) * einf


def sphere_through(a: Point, b: Point, c: Point, d: Point) -> Multivector:
    """The sphere through four points."""
    return (_point(a) ^ _point(b) ^ _point(c) ^ _point(d)).dual()


def circle(centre: ArrayLike, normal: ArrayLike, radius: ArrayLike) -> Multivector:
    """The plane through the centre ∧ the sphere about it: centre and normal `(…, 3)`, radius `(…)`."""
    centre, normal = arrays.components("centre", centre, 3), unit("normal", normal)
    return plane(normal, np.sum(centre * normal, axis=-1)) ^ sphere(centre, radius)


def circle_through(a: Point, b: Point, c: Point) -> Multivector:
    """The circle through three points."""
    return (_point(a) ^ _point(b) ^ _point(c)).dual()


def point_pair(a: Point, b: Point) -> Multivector:
    """Two points as one object: a sphere of one dimension."""
    return (_point(a) ^ _point(b)).dual()


def flat_point(a: Point) -> Multivector:
    """A point together with infinity: what a line and a plane have in common."""
    return (einf ^ _point(a)).dual()


def unit(what: str, vectors: ArrayLike) -> Array:
    """Vectors `(…, 3)` at length 1; GaikError for a zero vector."""
    vectors = arrays.components(what, vectors, 3)
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    if not np.all(length > 0.0):
        raise GaikError(f"{what} has the length 0; it needs a direction")
    result: Array = vectors / length
    return result


def _point(value: Point) -> Multivector:
    return value if isinstance(value, Multivector) else up(value)
