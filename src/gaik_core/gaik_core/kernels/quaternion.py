"""Hamilton's quaternions as tuples (w, x, y, z), vectors as tuples (x, y, z)."""

from __future__ import annotations

import math

from gaik_core.kernels.compiled import inlined

Quaternion = tuple[float, float, float, float]
Vector = tuple[float, float, float]


@inlined
def cross(a: Vector, b: Vector) -> Vector:
    """a × b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@inlined
def multiply(p: Quaternion, q: Quaternion) -> Quaternion:
    """Hamilton's product p q (eq. 2)."""
    return (
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    )


@inlined
def conjugate(q: Quaternion) -> Quaternion:
    """q~ (eq. 7)."""
    return (q[0], -q[1], -q[2], -q[3])


@inlined
def from_half_angle(axis: Vector, c: float, s: float) -> Quaternion:
    """c + s n, for c and s the cosine and sine of half the angle about a unit axis n."""
    return (c, s * axis[0], s * axis[1], s * axis[2])


@inlined
def from_axis_angle(axis: Vector, angle: float) -> Quaternion:
    """cos θ/2 + sin θ/2 n, for a unit axis n (eq. 4)."""
    return from_half_angle(axis, math.cos(0.5 * angle), math.sin(0.5 * angle))


@inlined
def rotate(q: Quaternion, v: Vector) -> Vector:
    """q v q~ (eq. 6, whose print lost the v), for a unit q: v + 2 w (u × v) + 2 u × (u × v), with q = w + u."""
    u = (q[1], q[2], q[3])
    t = cross(u, v)
    s = cross(u, t)
    w = q[0]
    return (v[0] + 2.0 * (w * t[0] + s[0]), v[1] + 2.0 * (w * t[1] + s[1]), v[2] + 2.0 * (w * t[2] + s[2]))


@inlined
def rotation_vector(q: Quaternion) -> Vector:
    """Axis times angle of the rotation q: twice the logarithm, by the shorter way round."""
    sign = 1.0 if q[0] >= 0.0 else -1.0
    norm = math.sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    scale = 2.0 * sign if norm < 1e-12 else 2.0 * sign * math.atan2(norm, sign * q[0]) / norm
    return (scale * q[1], scale * q[2], scale * q[3])
