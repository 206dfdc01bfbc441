"""Motors, lines and points of G(4,1) by the coefficients that can differ from zero.

A motor is a tuple of 8, a line a tuple of 6 (its direction u and its moment m), a point its Euclidean part (x, y, z):

    motor   r0 + r1 e23 + r2 e31 + r3 e12  +  s1 e1∞ + s2 e2∞ + s3 e3∞ + s0 e123∞     (r0, r1, r2, r3, s0, s1, s2, s3)
    line    u1 e23 + u2 e31 + u3 e12  +  m1 e1∞ + m2 e2∞ + m3 e3∞                     (u1, u2, u3, m1, m2, m3)

where e1∞ stands for e1 e∞. This is eq. 13 written out: (a - b) I_e = u I_e, and -e∞ (a ∧ b) I_e = m e∞ with m = c × u
for any point c of the line. A line at infinity (u = 0) generates the translation along m, and so a prismatic joint.
"""

from __future__ import annotations

import math

from gaik_core.kernels.compiled import inlined
from gaik_core.kernels.quaternion import Vector, cross

Motor = tuple[float, float, float, float, float, float, float, float]
Line = tuple[float, float, float, float, float, float]


@inlined
def dot(a: Vector, b: Vector) -> float:
    """a · b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inlined
def from_half_angle(line: Line, c: float, s: float) -> Motor:
    """c - s L, for c and s the cosine and sine of half the angle about a unit line L."""
    return (c, -s * line[0], -s * line[1], -s * line[2], 0.0, -s * line[3], -s * line[4], -s * line[5])


@inlined
def screw_rotor(line: Line, angle: float) -> Motor:
    """exp(-θ/2 L) = cos θ/2 - sin θ/2 L (eqs. 12 and 44), for a unit line L."""
    return from_half_angle(line, math.cos(0.5 * angle), math.sin(0.5 * angle))


@inlined
def translator(line: Line, distance: float) -> Motor:
    """exp(-d/2 L) = 1 - d/2 L, for a line L at infinity, whose square is zero."""
    h = -0.5 * distance
    return (1.0, 0.0, 0.0, 0.0, 0.0, h * line[3], h * line[4], h * line[5])


@inlined
def multiply(a: Motor, b: Motor) -> Motor:
    """The geometric product of two motors."""
    a0, b0, d0, f0 = a[0], b[0], a[4], b[4]
    ar, br, at, bt = (a[1], a[2], a[3]), (b[1], b[2], b[3]), (a[5], a[6], a[7]), (b[5], b[6], b[7])
    rr, rt, tr = cross(ar, br), cross(ar, bt), cross(at, br)
    return (
        a0 * b0 - dot(ar, br),
        a0 * br[0] + b0 * ar[0] - rr[0],
        a0 * br[1] + b0 * ar[1] - rr[1],
        a0 * br[2] + b0 * ar[2] - rr[2],
        a0 * f0 + b0 * d0 + dot(ar, bt) + dot(at, br),
        a0 * bt[0] + b0 * at[0] - f0 * ar[0] - d0 * br[0] - rt[0] - tr[0],
        a0 * bt[1] + b0 * at[1] - f0 * ar[1] - d0 * br[1] - rt[1] - tr[1],
        a0 * bt[2] + b0 * at[2] - f0 * ar[2] - d0 * br[2] - rt[2] - tr[2],
    )


@inlined
def rotate(m: Motor, v: Vector) -> Vector:
    """R v R~ by the motor's rotor R = r0 + r I_e, which turns about -r."""
    r = (m[1], m[2], m[3])
    t = cross(v, r)
    s = cross(t, r)
    w = m[0]
    return (v[0] + 2.0 * (w * t[0] + s[0]), v[1] + 2.0 * (w * t[1] + s[1]), v[2] + 2.0 * (w * t[2] + s[2]))


@inlined
def translation(m: Motor) -> Vector:
    """The vector t of the motor's translator in M = (1 - t e∞/2) R."""
    r, s = (m[1], m[2], m[3]), (m[5], m[6], m[7])
    c = cross(s, r)
    return (
        -2.0 * (m[0] * s[0] + m[4] * r[0] + c[0]),
        -2.0 * (m[0] * s[1] + m[4] * r[1] + c[1]),
        -2.0 * (m[0] * s[2] + m[4] * r[2] + c[2]),
    )


@inlined
def move_point(m: Motor, p: Vector) -> Vector:
    """The Euclidean part of M p M~ (eq. 14)."""
    q, t = rotate(m, p), translation(m)
    return (q[0] + t[0], q[1] + t[1], q[2] + t[2])


@inlined
def move_line(m: Motor, line: Line) -> Line:
    """M L M~ (eq. 52)."""
    u = rotate(m, (line[0], line[1], line[2]))
    n = rotate(m, (line[3], line[4], line[5]))
    c = cross(translation(m), u)
    return (u[0], u[1], u[2], n[0] + c[0], n[1] + c[1], n[2] + c[2])


@inlined
def point_dot_line(p: Vector, line: Line) -> Vector:
    """The Euclidean part of p · L: how p moves when it turns about L (eq. 50)."""
    c = cross((line[0], line[1], line[2]), p)
    return (c[0] + line[3], c[1] + line[4], c[2] + line[5])
