"""Conformal geometric algebra G(4,1) (paper, section 2.3): multivectors, their products, and their geometry.

Each name stands in a file named after what it does: `multivector` and `blades` hold the algebra, `points`, `objects`,
`parameters` and `incidence` the geometry, the rest what those are computed by.
"""

from gaik_core.cga import blades
from gaik_core.cga.basis import BladeNameError
from gaik_core.cga.exponential import LogarithmError
from gaik_core.cga.incidence import inner_form, join, meet, outer_form, reflect
from gaik_core.cga.inverse import NotInvertibleError
from gaik_core.cga.multivector import Multivector
from gaik_core.cga.objects import (
    axis_line,
    circle,
    circle_through,
    flat_point,
    line,
    plane,
    plane_through,
    point_pair,
    sphere,
    sphere_through,
)
from gaik_core.cga.parameters import (
    centre,
    circle_normal,
    flat_point_position,
    line_direction,
    line_moment,
    line_point,
    pair_points,
    plane_distance,
    plane_normal,
    radius,
    radius_squared,
)
from gaik_core.cga.points import InfinitePointError, distance, down, up
from gaik_core.cga.printing import ParseError

__all__ = [
    "BladeNameError",
    "InfinitePointError",
    "LogarithmError",
    "Multivector",
    "NotInvertibleError",
    "ParseError",
    "axis_line",
    "blades",
    "centre",
    "circle",
    "circle_normal",
    "circle_through",
    "distance",
    "down",
    "flat_point",
    "flat_point_position",
    "inner_form",
    "join",
    "line",
    "line_direction",
    "line_moment",
    "line_point",
    "meet",
    "outer_form",
    "pair_points",
    "plane",
    "plane_distance",
    "plane_normal",
    "plane_through",
    "point_pair",
    "radius",
    "radius_squared",
    "reflect",
    "sphere",
    "sphere_through",
    "up",
]
