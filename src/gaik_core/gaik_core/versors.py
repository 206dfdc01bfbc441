"""Rigid motions as versors of G(4,1): rotors, translators, and the screw rotors of eq. 12, here `Motor`.

A motor M moves everything, points and lines and spheres alike, by M x M̃ (eq. 14). It is a Multivector with

    1, e12, e13, e23   the rotor R = cos θ/2 - sin θ/2 n I_e, where the quaternion has cos θ/2 + sin θ/2 n
    e1∞, e2∞, e3∞, e123∞   zero in a rotor; with R = 1 the translator T = 1 - ½ t einf

and M = T R turns first. M and -M are the same motion.
"""

from __future__ import annotations

from typing import Self, overload

import numpy as np
from numpy.typing import ArrayLike

from gaik_core import arrays, quaternion
from gaik_core.arrays import Array
from gaik_core.cga import Multivector, axis_line, line_direction, line_moment
from gaik_core.cga.basis import BLADES, E1, E2, E3, E4, E5, E12, E13, E23, E123, REVERSE, SCALAR
from gaik_core.cga.blades import einf
from gaik_core.cga.multivector import Operand, wrap
from gaik_core.cga.objects import unit
from gaik_core.cga.products import GEOMETRIC, product, sandwich
from gaik_core.checks import unit_vector
from gaik_core.errors import GaikError
from gaik_core.quaternion import Quaternion

_ROTOR = [SCALAR, E23, E13, E12]
_ROTOR_SIGNS = (1.0, -1.0, 1.0, -1.0)
"""R = w - (x e23 - y e13 + z e12) for the quaternion w + xi + yj + zk."""
_TRANSLATION_4 = [E1 | E4, E2 | E4, E3 | E4, E123 | E4]
_TRANSLATION_5 = [E1 | E5, E2 | E5, E3 | E5, E123 | E5]


_NO_TURN = 1e-12
"""Screws that turn by less (rad) are translations: of two motors with one orientation, rounding leaves about 1e-16."""


class VersorError(GaikError):
    """A multivector that is no unit versor of the kind asked for, or a line that is no unit line."""


class Motor(Multivector):
    """A rotation about any axis together with a translation, or an array of them; frozen.

    `m * n` does n first and is a Motor; `m * x` with any other multivector is a Multivector; `~m` undoes m. `apply`
    moves positions and objects. Beyond that a Motor has all that a Multivector has.
    """

    __slots__ = ()

    def __init__(self, components: ArrayLike) -> None:
        super().__init__(components)
        self._check(self._indices())

    @staticmethod
    def _indices() -> list[int]:
        return [*_ROTOR, *_TRANSLATION_4, *_TRANSLATION_5]

    def _check(self, indices: list[int]) -> None:
        """VersorError unless the components are those of a unit versor of this kind, to 1e-9."""
        x = self._components
        others = np.delete(x, indices, axis=-1)
        uneven = x[..., _TRANSLATION_4] - x[..., _TRANSLATION_5]
        excess = (self * ~self - 1.0).components
        if not all(_vanishes(part, self) for part in (others, uneven, excess)):
            raise VersorError(f"the components are not those of a unit {type(self).__name__.lower()}")

    # --- making one --------------------------------------------------------------------------------------------------

    @classmethod
    def identity(cls) -> Self:
        """1, which moves nothing."""
        x = np.zeros(BLADES)
        x[SCALAR] = 1.0
        return cls._of(x)

    @classmethod
    def from_line(cls, line: Multivector, angle: ArrayLike, translation: ArrayLike = 0.0) -> Motor:
        """The screw rotor cos θ/2 - sin θ/2 L (eqs. 12, 44) about a unit line, with a translation in m along it.

        VersorError where L² is not -1, that is where |a - b| of eq. 13 is not 1; `line.normalised()` mends it.
        """
        _check_generator("the axis of a screw rotor is a line", line)
        if not _vanishes((line * line + 1.0).components, line):
            raise VersorError("the axis of a screw rotor is a line with L² = -1; take line.normalised()")
        half = 0.5 * arrays.numbers("angle", angle)
        turn = np.cos(half) - np.sin(half) * line
        along = Translator.from_vector(
            arrays.numbers("translation", translation)[..., None] * line_direction(line)
        )
        return Motor._of((along * turn)._components)

    @classmethod
    def from_axis(
        cls, point: ArrayLike, direction: ArrayLike, angle: ArrayLike, translation: ArrayLike = 0.0
    ) -> Motor:
        """The turn by an angle, right-handed about the axis through a point `(…, 3)` along a direction `(…, 3)`.

        With a translation `(…)` in m along the axis it is a screw; its pitch is translation/angle.
        """
        return cls.from_line(axis_line(point, direction), angle, translation)

    @classmethod
    def from_rotation_translation(cls, rotation: ArrayLike | Quaternion, translation: ArrayLike) -> Motor:
        """x ↦ q x q~ + t: the unit quaternion `(…, 4)`, w first, then the translation `(…, 3)` in m."""
        return Translator.from_vector(translation) * Rotor.from_quaternion(rotation)

    @classmethod
    def from_matrix(cls, matrix: ArrayLike) -> Motor:
        """Of homogeneous matrices `(…, 4, 4)`; GaikError where they are no rigid motion."""
        matrix = arrays.numbers("matrix", matrix)
        if matrix.shape[-2:] != (4, 4) or np.any(matrix[..., 3, :] != (0.0, 0.0, 0.0, 1.0)):
            raise GaikError(f"matrix of shape {matrix.shape}: expected (…, 4, 4) with the last row 0 0 0 1")
        return cls.from_rotation_translation(quaternion.from_matrix(matrix[..., :3, :3]), matrix[..., :3, 3])

    @staticmethod
    def exp(bivector: Multivector) -> Motor:  # type: ignore[override]
        """exp B for B = -½ (θ L + d einf), a bivector of e12, e13, e23, e1∞, e2∞, e3∞; VersorError for another.

        A function of the class, as of every Lie group, and the inverse of the method `log`.
        """
        _check_generator(
            "the exponential of a motor takes a bivector of e12, e13, e23, e1∞, e2∞, e3∞", bivector
        )
        return Motor._of(Multivector.exp(bivector)._components)

    # --- composing and applying --------------------------------------------------------------------------------------

    @overload
    def __mul__(self, other: Motor) -> Motor: ...
    @overload
    def __mul__(self, other: Operand) -> Multivector: ...
    def __mul__(self, other: Operand) -> Multivector:
        if not isinstance(other, Motor):
            return super().__mul__(other)
        kind = type(self) if type(self) is type(other) else Motor
        return kind._of(product(GEOMETRIC, self._components, other._components))

    def __neg__(self) -> Self:
        return self._of(-self._components)

    def reverse(self) -> Self:
        """M̃, which undoes M."""
        return self._of(self._components * REVERSE)

    def __invert__(self) -> Self:
        return self.reverse()

    def inverse(self) -> Self:
        """The reverse: M M̃ = 1."""
        return self.reverse()

    def normalised(self) -> Self:
        """M / √(M M̃): a unit motor again after a long product, whose rounding lets M M̃ drift from 1."""
        square = (self * ~self)._components  # a + Q with Q² = 0, so 1/√ of it is (2a - Q) / (2a √a)
        a = square[..., :1]
        root = np.concatenate((2.0 * a, -square[..., 1:]), axis=-1) / (2.0 * a * np.sqrt(a))
        return self._of(product(GEOMETRIC, root, self._components))

    @overload
    def apply(self, x: Multivector) -> Multivector: ...
    @overload
    def apply(self, x: ArrayLike) -> Array: ...
    def apply(self, x: Multivector | ArrayLike) -> Multivector | Array:
        """M x M̃ of a multivector, or the positions `(…, 3)` to which positions `(…, 3)` go; both broadcast."""
        if isinstance(x, Multivector):
            return wrap(sandwich(self._components, x._components))
        return quaternion.rotate(self.rotation, x) + self.translation

    # --- what it does ------------------------------------------------------------------------------------------------

    @property
    def rotation(self) -> Array:
        """The unit quaternion `(…, 4)` of the turn, w first."""
        rotation: Array = self._components[..., _ROTOR] * _ROTOR_SIGNS
        return rotation

    @property
    def translation(self) -> Array:
        """The translation `(…, 3)` in m, after the turn: where the origin goes."""
        # M = (1 - ½ t einf)(w - q I_e) has s einf + s0 I_e einf, with s = -½ (w t + t × q) and s0 = ½ t·q
        q = self.rotation
        s, s0 = self._components[..., _TRANSLATION_4[:3]], self._components[..., _TRANSLATION_4[3:]]
        translation: Array = 2.0 * (s0 * q[..., 1:] - q[..., :1] * s + np.cross(s, q[..., 1:]))
        return translation

    def to_matrix(self) -> Array:
        """Homogeneous matrices `(…, 4, 4)`."""
        matrix = np.zeros((*self.shape, 4, 4))
        matrix[..., :3, :3] = quaternion.to_matrix(self.rotation)
        matrix[..., :3, 3] = self.translation
        matrix[..., 3, 3] = 1.0
        return matrix

    def to_screw(self) -> tuple[Multivector, Array, Array]:
        """The unit line, the angle `(…)` in [0, π] about it and the translation `(…)` along it, the shorter way round.

        Chasles' theorem. Of a pure translation the line is the one through the origin.
        """
        bivector = self._shorter().log()
        turn, slide = -2.0 * line_direction(bivector), -2.0 * line_moment(bivector)
        angle = np.linalg.norm(turn, axis=-1)
        turns = angle[..., None] > _NO_TURN
        axis = np.where(turns, turn, slide)
        length = np.linalg.norm(axis, axis=-1, keepdims=True)
        direction = np.where(length > 0.0, axis / np.where(length > 0.0, length, 1.0), (0.0, 0.0, 1.0))
        point = np.where(turns, np.cross(turn, slide), 0.0) / np.where(turns, angle[..., None] ** 2, 1.0)
        return axis_line(point, direction), angle[()], np.sum(direction * slide, axis=-1)[()]

    def interpolate(self, other: Motor, fraction: ArrayLike) -> Motor:
        """M exp(f log(M̃ N)): the motion at a fraction `(…)` of the screw from this one (0) to another (1).

        The shorter way round, with turn and slide at constant speed.
        """
        way = Motor._of((~self * other)._components)._shorter().log()
        return Motor._of((self * Motor.exp(arrays.numbers("fraction", fraction) * way))._components)

    def _shorter(self) -> Self:
        """M or -M, whichever turns by no more than π."""
        return self._of(np.where(self._components[..., :1] < 0.0, -self._components, self._components))

    @classmethod
    def _of(cls, components: Array) -> Self:
        new = object.__new__(cls)
        new._components = components
        return new


class Rotor(Motor):
    """A rotation about an axis through the origin."""

    __slots__ = ()

    @staticmethod
    def _indices() -> list[int]:
        return _ROTOR

    @classmethod
    def from_quaternion(cls, q: ArrayLike | Quaternion) -> Self:
        """cos θ/2 - sin θ/2 n I_e of a quaternion cos θ/2 + sin θ/2 n, `(…, 4)`; VersorError where |q| is not 1."""
        q = q.components if isinstance(q, Quaternion) else arrays.components("q", q, 4)
        if not np.all(np.abs(quaternion.norm(q) - 1.0) <= 1e-9):
            raise VersorError("a rotor takes a unit quaternion; see quaternion.normalise")
        x = np.zeros((*q.shape[:-1], BLADES))
        x[..., _ROTOR] = q * _ROTOR_SIGNS
        return cls._of(x)

    @classmethod
    def from_axis_angle(cls, axis: ArrayLike, angle: ArrayLike) -> Self:
        """The turn by an angle `(…)` in rad, right-handed about an axis `(…, 3)` of any length but zero."""
        return cls.from_quaternion(quaternion.from_axis_angle(axis, angle))

    @classmethod
    def between(cls, a: ArrayLike, b: ArrayLike) -> Self:
        """The shortest turn from the direction a to the direction b, each `(…, 3)`; GaikError where b = -a."""
        a, b = unit("a", a), unit("b", b)
        real = 1.0 + np.sum(a * b, axis=-1, keepdims=True)
        if np.any(real < 1e-15):
            raise GaikError("a and b are opposite: the turn between them has no definite axis")
        return cls.from_quaternion(quaternion.normalise(np.concatenate((real, np.cross(a, b)), axis=-1)))


class Translator(Motor):
    """A translation."""

    __slots__ = ()

    @staticmethod
    def _indices() -> list[int]:
        return [SCALAR, *_TRANSLATION_4[:3], *_TRANSLATION_5[:3]]

    @classmethod
    def from_vector(cls, vector: ArrayLike) -> Self:
        """1 - ½ t einf, for t `(…, 3)` in m."""
        return cls._of((1.0 - 0.5 * Multivector.from_vector(vector) * einf)._components)


def _check_generator(expectation: str, bivector: Multivector) -> None:
    """VersorError unless the bivector generates a rigid motion: that is, leaves einf where it is."""
    x = bivector.components
    others = np.delete(x, [E12, E13, E23, *_TRANSLATION_4[:3], *_TRANSLATION_5[:3]], axis=-1)
    uneven = x[..., _TRANSLATION_4] - x[..., _TRANSLATION_5]
    if not (_vanishes(others, bivector) and _vanishes(uneven, bivector)):
        raise VersorError(f"{expectation}; this has other components")


def _vanishes(part: Array, of: Multivector) -> bool:
    """Whether a part of something is zero, to rounding; a NaN is not."""
    size = np.maximum(1.0, np.sum(of.components**2, axis=-1, keepdims=True))
    return bool(np.all(np.abs(part) <= 1e-9 * size))


Orientation = ArrayLike | Quaternion | Rotor
"""What tells how a frame is turned: a quaternion (4,), w first, a Quaternion or a Rotor."""


def unit_quaternion(what: str, orientation: Orientation) -> Array:
    """An orientation as (4,), w first, made a unit quaternion; GaikError where it is zero, not finite, or none."""
    if isinstance(orientation, Quaternion):
        orientation = orientation.components
    elif isinstance(orientation, Rotor):
        orientation = orientation.rotation
    return unit_vector(what, orientation, 4)
