"""The multivector of G(4,1), and what its operators mean."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from gaik_core import arrays
from gaik_core.arrays import Array
from gaik_core.cga import exponential, printing, products
from gaik_core.cga import inverse as inverses
from gaik_core.cga.basis import BLADES, CONJUGATE, INVOLUTION, REVERSE, blade_index_and_sign, grade_mask
from gaik_core.cga.products import GEOMETRIC, INNER, OUTER, product


class Multivector:
    """A multivector of G(4,1), or an array of them, frozen: `components (…, 32)`.

    Bit i of a component's index says whether e(i+1) is in its blade: index 3 is e12, 24 is e45, 31 the pseudoscalar I.
    e1² = e2² = e3² = e4² = 1, e5² = -1 (eqs. 8, 9); e0 = (e5 - e4)/2 and einf = e4 + e5, so e0·einf = -1 (eq. 10
    prints e4 - e5). Arrays of multivectors broadcast as numpy arrays of shape `.shape` do. A number, or an array of
    numbers `(…)`, counts as scalar wherever a multivector may stand.

        a * b    geometric   the geometric (Clifford) product
        a ^ b    outer       the outer product (wedge)
        a | b    inner       Hestenes' inner product (dot): grade |r - s|, zero where either side is a scalar
        ~a       reverse
        a / b                a times the inverse of b
        a ** n               geometric power, n an integer of either sign
        a == b               equal in every component, shape `(…)`; `isclose` forgives rounding

    All other products and functions have names only.
    """

    __slots__ = ("_components",)
    __array_ufunc__ = None  # so that numpy leaves `array * multivector` to __rmul__
    __hash__ = None  # type: ignore[assignment]

    _components: Array

    # --- making one --------------------------------------------------------------------------------------------------

    def __init__(self, components: ArrayLike) -> None:
        self._components = arrays.components("components", components, BLADES).copy()

    @classmethod
    def from_scalar(cls, values: ArrayLike) -> Multivector:
        """The scalars `(…)`."""
        values = arrays.numbers("values", values)
        components = np.zeros((*values.shape, BLADES))
        components[..., 0] = values
        return wrap(components)

    @classmethod
    def from_vector(cls, vectors: ArrayLike) -> Multivector:
        """x e1 + y e2 + z e3 of Euclidean vectors `(…, 3)`. For the conformal point of a position, see `up`."""
        vectors = arrays.components("vectors", vectors, 3)
        components = np.zeros((*vectors.shape[:-1], BLADES))
        components[..., [1, 2, 4]] = vectors
        return wrap(components)

    @classmethod
    def parse(cls, text: str) -> Multivector:
        """The multivector that a text such as "1.5 + 2*e12 - e1^einf" writes; exact for what `str` gives."""
        return wrap(printing.parse(text))

    # --- what it holds -----------------------------------------------------------------------------------------------

    @property
    def components(self) -> Array:
        """The components `(…, 32)`, read-only."""
        view = self._components.view()
        view.flags.writeable = False
        return view

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of the array of multivectors: `()` for one."""
        return self._components.shape[:-1]

    @property
    def scalar(self) -> Array:
        """The scalar part, shape `(…)`."""
        return self.components[..., 0][()]

    def coefficient(self, blade: str) -> Array:
        """The coefficient of a basis blade such as "e12" (or "e21", its negative), shape `(…)`."""
        index, sign = blade_index_and_sign(blade)
        return (sign * self._components[..., index])[()]

    def grades(self, tolerance: float = 0.0) -> tuple[int, ...]:
        """The grades with a component larger than the tolerance."""
        return inverses.grades(self._components, tolerance)

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError("one multivector has no length; an array of them has")
        return self.shape[0]

    def __iter__(self) -> Iterator[Self]:
        return (self[index] for index in range(len(self)))

    def __getitem__(self, index: object) -> Self:
        if not self.shape:
            raise IndexError("one multivector cannot be indexed; .coefficient and .components give its parts")
        return self._same(arrays.select(self._components, index))

    def __bool__(self) -> bool:
        if self.shape:
            raise ValueError("the truth of an array of multivectors is ambiguous")
        return bool(self._components.any())

    # --- sums and scalars --------------------------------------------------------------------------------------------

    def __add__(self, other: Operand) -> Multivector:
        operand = as_multivector(other)
        return NotImplemented if operand is None else wrap(self._components + operand._components)

    __radd__ = __add__

    def __sub__(self, other: Operand) -> Multivector:
        operand = as_multivector(other)
        return NotImplemented if operand is None else wrap(self._components - operand._components)

    def __rsub__(self, other: Operand) -> Multivector:
        return -self + other

    def __neg__(self) -> Multivector:
        return wrap(-self._components)

    def __pos__(self) -> Multivector:
        return self

    # --- products ----------------------------------------------------------------------------------------------------

    def geometric(self, other: Operand) -> Multivector:
        """The geometric (Clifford) product."""
        return self._product(GEOMETRIC, other)

    def outer(self, other: Operand) -> Multivector:
        """The outer product: grade r + s."""
        return self._product(OUTER, other)

    def inner(self, other: Operand) -> Multivector:
        """Hestenes' inner product: grade |r - s|, zero where either side is a scalar."""
        return self._product(INNER, other)

    def left_contraction(self, other: Operand) -> Multivector:
        """A ⌋ B: grade s - r, zero where that is negative."""
        return self._product(products.LEFT_CONTRACTION, other)

    def right_contraction(self, other: Operand) -> Multivector:
        """A ⌊ B: grade r - s, zero where that is negative."""
        return self._product(products.RIGHT_CONTRACTION, other)

    def scalar_product(self, other: Operand) -> Array:
        """⟨A B⟩₀, shape `(…)`."""
        return self._product(products.SCALAR_PRODUCT, other).scalar

    def commutator(self, other: Operand) -> Multivector:
        """(AB - BA)/2. On vectors this is the outer product; on other grades it is not."""
        return self._product(products.COMMUTATOR, other)

    def anticommutator(self, other: Operand) -> Multivector:
        """(AB + BA)/2. On vectors this is the inner product; on other grades it is not."""
        return self._product(products.ANTICOMMUTATOR, other)

    def regressive(self, other: Operand) -> Multivector:
        """A ∨ B = undual(dual B ∧ dual A): the meet of two blades that together span the whole space."""
        return wrap(products.regressive(self._components, expect_multivector(other)._components))

    def project_onto(self, blade: Multivector) -> Multivector:
        """(A ⌋ B) B⁻¹, the part of A within an invertible blade B."""
        return self.left_contraction(blade) * blade.inverse()

    def __mul__(self, other: Operand) -> Multivector:
        if isinstance(other, Multivector):
            return wrap(product(GEOMETRIC, self._components, other._components))
        factor = as_factor(other)
        return NotImplemented if factor is None else wrap(self._components * factor)

    def __rmul__(self, other: Operand) -> Multivector:
        factor = as_factor(other)
        return NotImplemented if factor is None else wrap(self._components * factor)

    def __xor__(self, other: Operand) -> Multivector:
        return NotImplemented if as_multivector(other) is None else self.outer(other)

    __rxor__ = __xor__  # the left operand is a scalar, which commutes

    def __or__(self, other: Operand) -> Multivector:
        return NotImplemented if as_multivector(other) is None else self.inner(other)

    __ror__ = __or__  # zero: the left operand is a scalar

    def __truediv__(self, other: Operand) -> Multivector:
        if isinstance(other, Multivector):
            return self * other.inverse()
        divisor = as_factor(other)
        return NotImplemented if divisor is None else wrap(self._components / divisor)

    def __rtruediv__(self, other: Operand) -> Multivector:
        return self.inverse() * other

    def __pow__(self, exponent: int) -> Multivector:
        if not isinstance(exponent, int | np.integer):
            return NotImplemented
        base = self.inverse() if exponent < 0 else self
        result = Multivector.from_scalar(1.0)
        for _ in range(abs(exponent)):
            result = result * base
        return result

    # --- involutions, grades, duals ----------------------------------------------------------------------------------

    def reverse(self) -> Multivector:
        """The factors of every blade in the opposite order: the sign (-1)^(r(r-1)/2) on grade r."""
        return wrap(self._components * REVERSE)

    def __invert__(self) -> Multivector:
        return self.reverse()

    def grade_involution(self) -> Multivector:
        """The sign (-1)^r on grade r."""
        return wrap(self._components * INVOLUTION)

    def conjugate(self) -> Multivector:
        """Clifford's conjugate, reverse and grade involution together: the sign (-1)^(r(r+1)/2) on grade r."""
        return wrap(self._components * CONJUGATE)

    def grade(self, *grades: int) -> Multivector:
        """⟨A⟩_r, the part of one grade, or of several."""
        return wrap(np.where(grade_mask(grades), self._components, 0.0))

    def even(self) -> Multivector:
        """The part of grades 0, 2 and 4."""
        return self.grade(0, 2, 4)

    def odd(self) -> Multivector:
        """The part of grades 1, 3 and 5."""
        return self.grade(1, 3, 5)

    def dual(self) -> Multivector:
        """A I⁻¹ with I = e12345, where I⁻¹ = -I; so the dual of the dual is -A, and `undual` leads back."""
        return wrap(products.dual(self._components))

    def undual(self) -> Multivector:
        """A I, the inverse of `dual`."""
        return wrap(products.undual(self._components))

    # --- norm, inverse, functions ------------------------------------------------------------------------------------

    def norm_squared(self) -> Array:
        """⟨A Ã⟩₀, shape `(…)`; of either sign, as e5² = -1."""
        return inverses.norm_squared(self._components)[()]

    def norm(self) -> Array:
        """√|⟨A Ã⟩₀|, shape `(…)`; zero for null vectors, such as points."""
        return np.sqrt(np.abs(self.norm_squared()))

    def normalised(self) -> Self:
        """A / |A|; NotInvertibleError where the norm is zero."""
        return self._same(inverses.normalise(self._components))

    def inverse(self) -> Multivector:
        """A⁻¹, of every multivector that has one, not only of versors; else NotInvertibleError."""
        return wrap(inverses.inverse(self._components))

    def exp(self) -> Multivector:
        """e^A: in closed form for scalar + bivector, of whatever kind; of anything else by its series."""
        return wrap(exponential.exp(self._components))

    def log(self) -> Multivector:
        """The bivector B with e^B = A, of a unit even versor A (a rotor, translator, motor, dilator, or their product).

        The branch is the principal one; LogarithmError where there is none (see `gaik_core.cga.exponential.log`).
        """
        return wrap(exponential.log(self._components))

    # --- comparing and printing --------------------------------------------------------------------------------------

    def __eq__(self, other: object) -> bool | np.ndarray:  # type: ignore[override]
        other = as_multivector(other)
        if other is None:
            return NotImplemented
        equal: np.ndarray = np.all(self._components == other._components, axis=-1)
        return equal

    def isclose(self, other: Operand, rtol: float = 1e-9, atol: float = 1e-12) -> np.ndarray:
        """Whether the components of A - B are at most atol + rtol times the largest of B, shape `(…)`."""
        reference = expect_multivector(other)._components
        bound = atol + rtol * np.abs(reference).max(axis=-1)
        close: np.ndarray = np.abs(self._components - reference).max(axis=-1) <= bound
        return close

    def to_text(self, spec: str = "", null_basis: bool = False) -> str:
        """A sum of blades, exact, or each number by a format such as ".3f"; with `null_basis` by e0 and einf.

        Terms that print as zero are left out. An array gives a list of such sums.
        """
        if not self.shape:
            return printing.to_text(self._components, spec, null_basis)
        texts = np.empty(self.shape, dtype=object)
        for index in np.ndindex(self.shape):
            texts[index] = printing.to_text(self._components[index], spec, null_basis)
        return np.array2string(texts, separator=", ", threshold=20, formatter={"all": str})

    def __str__(self) -> str:
        return self.to_text()

    def __format__(self, spec: str) -> str:
        return self.to_text(spec)

    def __repr__(self) -> str:
        return self.to_text() if not self.shape else f"{type(self).__name__} {self.shape}: {self.to_text()}"

    # --- inside ------------------------------------------------------------------------------------------------------

    def _product(self, table: Array, other: Operand) -> Multivector:
        return wrap(product(table, self._components, expect_multivector(other)._components))

    def _same(self, components: Array) -> Self:
        """Components of the same kind as these, unchecked."""
        new = object.__new__(type(self))
        new._components = components
        return new


Operand = Multivector | float | Array


def wrap(components: Array) -> Multivector:
    """A multivector around components that no one else will change, unchecked: what every operation ends with."""
    new = object.__new__(Multivector)
    new._components = components
    return new


def as_factor(value: object) -> float | Array | None:
    """A number as it is, an array of numbers with an axis for the components; None where it is neither."""
    if isinstance(value, float | int):
        return value
    if isinstance(value, np.ndarray | np.generic) and value.dtype.kind in "biuf":
        factor: Array = np.asarray(value, dtype=np.float64)[..., None]
        return factor
    return None


def as_multivector(value: object) -> Multivector | None:
    """A multivector as it is, numbers as scalars; None for what is neither."""
    if isinstance(value, Multivector):
        return value
    return None if as_factor(value) is None else Multivector.from_scalar(np.asarray(value, dtype=np.float64))


def expect_multivector(value: object) -> Multivector:
    """The same; TypeError for what is neither."""
    operand = as_multivector(value)
    if operand is None:
        raise TypeError(f"expected a multivector or a number; got {type(value).__name__}")
    return operand
