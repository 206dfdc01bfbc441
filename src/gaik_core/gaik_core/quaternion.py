"""Hamilton's algebra (paper, section 2.1) on arrays `(…, 4)`, the components w, x, y, z of w + xi + yj + zk.

The functions take and give plain arrays and broadcast as numpy does; the class `Quaternion` puts operators on them.
A unit quaternion q turns a vector by q v q~; q and -q are the same rotation. Angles are in rad.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from gaik_core.arrays import Array, components, numbers, select
from gaik_core.errors import GaikError

# --- functions on arrays ---------------------------------------------------------------------------------------------


def multiply(p: ArrayLike, q: ArrayLike) -> Array:
    """Hamilton's product p q (eq. 2: i² = j² = k² = ijk = -1)."""
    pw, px, py, pz = _split("p", p)
    qw, qx, qy, qz = _split("q", q)
    return np.stack(
        (
            pw * qw - px * qx - py * qy - pz * qz,
            pw * qx + px * qw + py * qz - pz * qy,
            pw * qy - px * qz + py * qw + pz * qx,
            pw * qz + px * qy - py * qx + pz * qw,
        ),
        axis=-1,
    )


def conjugate(q: ArrayLike) -> Array:
    """q~ = w - xi - yj - zk (eq. 7)."""
    return components("q", q, 4) * (1.0, -1.0, -1.0, -1.0)


def norm(q: ArrayLike) -> Array:
    """|q| = √(q q~), shape `(…)`."""
    return _length(components("q", q, 4))


def inverse(q: ArrayLike) -> Array:
    """q⁻¹ = q~ / |q|²; GaikError for the zero quaternion."""
    length = _nonzero_norm("q", q)[..., None]
    return conjugate(q) / length / length  # divided twice: |q|² may overflow where |q| does not


def normalise(q: ArrayLike) -> Array:
    """q / |q|; GaikError for the zero quaternion."""
    return components("q", q, 4) / _nonzero_norm("q", q)[..., None]


def exp(q: ArrayLike) -> Array:
    """e^q = e^w (cos |v| + sin |v| v/|v|), for q = w + v (eq. 5 where q = θ/2 n)."""
    w, v = _scalar_and_vector("q", q)
    angle = _length(v)
    return np.exp(w)[..., None] * _join(np.cos(angle), _sinc(angle)[..., None] * v)


def log(q: ArrayLike) -> Array:
    """The principal logarithm ln |q| + φ v/|v|, with φ in [0, π] the angle of q = |q| (cos φ + sin φ v/|v|).

    A negative real number has a logarithm along every axis; i is taken. GaikError for the zero quaternion.
    """
    length = _nonzero_norm("q", q)
    w, v = _scalar_and_vector("q", q)
    sine = _length(v)
    angle = np.arctan2(sine, w)
    axis = np.where(sine[..., None] > 0.0, v / np.where(sine > 0.0, sine, 1.0)[..., None], (1.0, 0.0, 0.0))
    return _join(np.log(length), angle[..., None] * axis)


def rotate(q: ArrayLike, v: ArrayLike) -> Array:
    """The vectors `(…, 3)` of q v q~ (eq. 6, whose print lost the v), for q of any norm: the result grows by |q|²."""
    w, u = _scalar_and_vector("q", q)
    v = components("v", v, 3)
    along = np.sum(u * v, axis=-1, keepdims=True)
    squared = np.sum(u * u, axis=-1, keepdims=True)
    w = w[..., None]
    rotated: Array = (w * w - squared) * v + 2.0 * along * u + 2.0 * w * np.cross(u, v)
    return rotated


def from_axis_angle(axis: ArrayLike, angle: ArrayLike) -> Array:
    """cos θ/2 + sin θ/2 n (eq. 4), for the axis `(…, 3)` of any length but zero and the angle `(…)`."""
    axis = components("axis", axis, 3)
    length = _length(axis)[..., None]
    if not np.all(length > 0.0):
        raise GaikError("axis has the length 0; an axis of rotation needs a direction")
    half = 0.5 * numbers("angle", angle)
    return _join(np.cos(half), np.sin(half)[..., None] * (axis / length))


def to_axis_angle(q: ArrayLike) -> tuple[Array, Array]:
    """The unit axis `(…, 3)` and the angle `(…)` in [0, π] of a rotation, the shorter way round.

    The identity has no axis; x is given. GaikError for the zero quaternion.
    """
    _nonzero_norm("q", q)
    w, v = _scalar_and_vector("q", q)
    v = np.where(w[..., None] < 0.0, -v, v)
    sine = _length(v)
    axis = np.where(sine[..., None] > 0.0, v / np.where(sine > 0.0, sine, 1.0)[..., None], (1.0, 0.0, 0.0))
    return axis, 2.0 * np.arctan2(sine, np.abs(w))


def to_matrix(q: ArrayLike) -> Array:
    """The rotation matrices `(…, 3, 3)` with R @ v = q v q~ / |q|²; GaikError for the zero quaternion."""
    q = normalise(q)
    columns = [rotate(q, unit) for unit in np.eye(3)]
    return np.stack(columns, axis=-1)


def from_matrix(matrix: ArrayLike) -> Array:
    """The unit quaternions, w ≥ 0, of rotation matrices `(…, 3, 3)`; GaikError where RᵀR is not 1 or det R is not +1.

    Of the four columns that q qᵀ has, the one with the largest diagonal element gives q without cancellation
    (Shepperd, "Quaternion from rotation matrix", 1978).
    """
    r = numbers("matrix", matrix)
    if r.shape[-2:] != (3, 3):
        raise GaikError(f"matrix has shape {r.shape}; expected (…, 3, 3)")
    orthogonal = np.allclose(np.swapaxes(r, -1, -2) @ r, np.eye(3), rtol=0.0, atol=1e-6)
    if not (orthogonal and np.all(np.linalg.det(r) > 0.0)):
        raise GaikError("matrix is no rotation; expected orthonormal columns and the determinant +1")
    xx, yy, zz = r[..., 0, 0], r[..., 1, 1], r[..., 2, 2]
    wx, wy, wz = r[..., 2, 1] - r[..., 1, 2], r[..., 0, 2] - r[..., 2, 0], r[..., 1, 0] - r[..., 0, 1]
    xy, xz, yz = r[..., 0, 1] + r[..., 1, 0], r[..., 0, 2] + r[..., 2, 0], r[..., 1, 2] + r[..., 2, 1]
    four_q_qt = (
        (1.0 + xx + yy + zz, wx, wy, wz),
        (wx, 1.0 + xx - yy - zz, xy, xz),
        (wy, xy, 1.0 - xx + yy - zz, yz),
        (wz, xz, yz, 1.0 - xx - yy + zz),
    )
    columns = np.stack([np.stack(column, axis=-1) for column in four_q_qt], axis=-2)
    largest = np.argmax(np.diagonal(columns, axis1=-2, axis2=-1), axis=-1)
    q = normalise(np.take_along_axis(columns, largest[..., None, None], axis=-2)[..., 0, :])
    return np.where(q[..., :1] < 0.0, -q, q)


def interpolate(p: ArrayLike, q: ArrayLike, fraction: ArrayLike) -> Array:
    """The rotation at `fraction` of the shorter way from p (0) to q (1), at constant speed (slerp), p and q unit."""
    way = multiply(conjugate(p), q)
    way = np.where(way[..., :1] < 0.0, -way, way)
    return multiply(p, exp(numbers("fraction", fraction)[..., None] * log(way)))


def _split(what: str, q: ArrayLike) -> tuple[Array, Array, Array, Array]:
    q = components(what, q, 4)
    return q[..., 0], q[..., 1], q[..., 2], q[..., 3]


def _scalar_and_vector(what: str, q: ArrayLike) -> tuple[Array, Array]:
    q = components(what, q, 4)
    return q[..., 0], q[..., 1:]


def _join(w: Array, v: Array) -> Array:
    shape = np.broadcast_shapes(w.shape, v.shape[:-1])
    return np.concatenate((np.broadcast_to(w, shape)[..., None], np.broadcast_to(v, (*shape, 3))), axis=-1)


def _length(x: Array) -> Array:
    """√(Σ x²) over the last axis, also where the squares would overflow or vanish."""
    length: Array = np.hypot.reduce(x, axis=-1)
    return length


def _nonzero_norm(what: str, q: ArrayLike) -> Array:
    length = norm(q)
    if np.any(length == 0.0):
        raise GaikError(f"{what} is zero, which has no inverse, logarithm or direction")
    return length


def _real(value: Quaternion | ArrayLike) -> Array:
    """The components of a quaternion, or of the real quaternion that a number stands for."""
    if isinstance(value, Quaternion):
        return value.components
    return numbers("operand", value)[..., None] * (1.0, 0.0, 0.0, 0.0)


def _sinc(x: Array) -> Array:
    """sin x / x, and 1 at 0 (np.sinc takes x in units of π)."""
    return np.where(x == 0.0, 1.0, np.sin(x) / np.where(x == 0.0, 1.0, x))


# --- the class -------------------------------------------------------------------------------------------------------


class Quaternion:
    """One quaternion, or an array of them: frozen, `components (…, 4)`, w first.

    p * q    multiply    Hamilton's product; a number or an array `(…)` scales
    ~q       conjugate
    p / q                p times the inverse of q
    q ** t               exp(t log q)
    p + q, p - q, -q, p == q   by components; a number counts as its real part
    """

    __slots__ = ("_components",)
    __array_ufunc__ = None  # so that numpy leaves `array * quaternion` to __rmul__
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, components_wxyz: ArrayLike) -> None:
        self._components: Array = components("components", components_wxyz, 4).copy()

    @classmethod
    def identity(cls) -> Self:
        """1, the rotation that leaves all where it is."""
        return cls((1.0, 0.0, 0.0, 0.0))

    @classmethod
    def from_axis_angle(cls, axis: ArrayLike, angle: ArrayLike) -> Self:
        """cos θ/2 + sin θ/2 n (eq. 4), for the axis `(…, 3)` of any length but zero and the angle `(…)` in rad."""
        return cls(from_axis_angle(axis, angle))

    @classmethod
    def from_vector(cls, vector: ArrayLike) -> Self:
        """The pure quaternion 0 + xi + yj + zk (eq. 3, which prints a real part of 1)."""
        vector = components("vector", vector, 3)
        return cls(_join(np.zeros(vector.shape[:-1]), vector))

    @classmethod
    def from_matrix(cls, matrix: ArrayLike) -> Self:
        """The unit quaternions of rotation matrices `(…, 3, 3)`."""
        return cls(from_matrix(matrix))

    @property
    def components(self) -> Array:
        """`(…, 4)`, w first; read-only."""
        view = self._components.view()
        view.flags.writeable = False
        return view

    @property
    def scalar(self) -> Array:
        """The real part w, shape `(…)`."""
        return self.components[..., 0]

    @property
    def vector(self) -> Array:
        """The vector part x, y, z, shape `(…, 3)`."""
        return self.components[..., 1:]

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of the array of quaternions: `()` for one."""
        return self._components.shape[:-1]

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError("one quaternion has no length; an array of them has")
        return self.shape[0]

    def __iter__(self) -> Iterator[Self]:
        return (self[index] for index in range(len(self)))

    def __getitem__(self, index: object) -> Self:
        if not self.shape:
            raise IndexError("one quaternion cannot be indexed; .components can")
        return type(self)(select(self._components, index))

    def multiply(self, other: Quaternion) -> Quaternion:
        """Hamilton's product."""
        return Quaternion(multiply(self._components, other._components))

    def __mul__(self, other: Quaternion | ArrayLike) -> Quaternion:
        if isinstance(other, Quaternion):
            return self.multiply(other)
        return Quaternion(self._components * numbers("factor", other)[..., None])

    def __rmul__(self, other: ArrayLike) -> Quaternion:
        return self * other

    def __truediv__(self, other: Quaternion | ArrayLike) -> Quaternion:
        if isinstance(other, Quaternion):
            return self.multiply(other.inverse())
        return Quaternion(self._components / numbers("divisor", other)[..., None])

    def __rtruediv__(self, other: ArrayLike) -> Quaternion:
        return self.inverse() * other

    def __add__(self, other: Quaternion | ArrayLike) -> Quaternion:
        return Quaternion(self._components + _real(other))

    __radd__ = __add__

    def __sub__(self, other: Quaternion | ArrayLike) -> Quaternion:
        return Quaternion(self._components - _real(other))

    def __rsub__(self, other: ArrayLike) -> Quaternion:
        return Quaternion(_real(other) - self._components)

    def __neg__(self) -> Quaternion:
        return Quaternion(-self._components)

    def __pow__(self, exponent: ArrayLike) -> Quaternion:
        return (self.log() * exponent).exp()

    def conjugate(self) -> Quaternion:
        """w - xi - yj - zk."""
        return Quaternion(conjugate(self._components))

    __invert__ = conjugate

    def norm(self) -> Array:
        """√(q q~), shape `(…)`."""
        return norm(self._components)

    def inverse(self) -> Quaternion:
        """q~ / |q|²; GaikError for zero."""
        return Quaternion(inverse(self._components))

    def normalised(self) -> Quaternion:
        """q / |q|; GaikError for zero."""
        return Quaternion(normalise(self._components))

    def exp(self) -> Quaternion:
        """e^q."""
        return Quaternion(exp(self._components))

    def log(self) -> Quaternion:
        """The principal logarithm; see the function `log`."""
        return Quaternion(log(self._components))

    def rotate(self, vectors: ArrayLike) -> Array:
        """q v q~ of vectors `(…, 3)`."""
        return rotate(self._components, vectors)

    def to_axis_angle(self) -> tuple[Array, Array]:
        """The unit axis `(…, 3)` and the angle `(…)` in [0, π]."""
        return to_axis_angle(self._components)

    def to_matrix(self) -> Array:
        """The rotation matrices `(…, 3, 3)`."""
        return to_matrix(self._components)

    def interpolate(self, other: Quaternion, fraction: ArrayLike) -> Quaternion:
        """The rotation at `fraction` of the shorter way to `other`, at constant speed (slerp)."""
        return Quaternion(interpolate(self._components, other._components, fraction))

    def __eq__(self, other: object) -> bool | np.bool_ | np.ndarray:  # type: ignore[override]
        if not isinstance(other, Quaternion | int | float | np.ndarray):
            return NotImplemented
        equal: np.ndarray = np.all(self._components == _real(other), axis=-1)
        return equal

    def isclose(self, other: Quaternion | ArrayLike, rtol: float = 1e-9, atol: float = 1e-12) -> np.ndarray:
        """Whether |self - other| is at most atol + rtol |other|, shape `(…)`."""
        reference = _real(other)
        bound = atol + rtol * np.linalg.norm(reference, axis=-1)
        close: np.ndarray = np.linalg.norm(self._components - reference, axis=-1) <= bound
        return close

    def __repr__(self) -> str:
        return f"Quaternion({self._components.tolist()})"
