"""One axis of a chain, as a robot file describes it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import partial
from types import MappingProxyType
from typing import Any, Literal, get_args

from gaik_core.checks import finite_vector, is_number, unit_vector
from gaik_core.errors import GaikError

Vector = tuple[float, float, float]
Kind = Literal["revolute", "prismatic"]

KINDS: tuple[str, ...] = get_args(Kind)


@dataclass(frozen=True)
class Joint:
    """An axis and the link that follows it, both as they stand when every angle is zero.

    The angle about the axis is ``offset`` + the joint's value + the sum of ``factor * value`` over ``coupling``. That
    sum is how the Touch's parallelogram is written (its third axis turns by θ3 - θ2), a URDF's mimic joint, or a belt.
    """

    name: str
    axis: Vector
    """Direction in the base frame; made a unit vector."""
    link: Vector = (0.0, 0.0, 0.0)
    """From this axis to the next, or to the tip (m)."""
    kind: Kind = "revolute"
    coupling: Mapping[str, float] = field(default_factory=dict, hash=False)
    """Factors of other joints' values."""
    passive: bool = False
    """Whether the axis has no value of its own and follows its coupling alone."""
    offset: float = 0.0
    """Angle (rad) or travel (m) when every value is zero."""
    lower: float = -math.inf
    """Lowest value of the joint (rad or m)."""
    upper: float = math.inf
    axis_lower: float = -math.inf
    """Lowest angle about the axis, where several values share it (rad or m)."""
    axis_upper: float = math.inf
    home: float = 0.0
    """The joint's value where a solve starts by default (rad or m)."""

    def __post_init__(self) -> None:
        """Check and freeze; GaikError: what is wrong with which joint."""
        if self.kind not in KINDS:
            raise self._error("kind", repr(self.kind), f"expected {' or '.join(KINDS)}")
        if not isinstance(self.coupling, Mapping):
            raise self._error("coupling", repr(self.coupling), "expected factors by the names of joints")
        axis = unit_vector(f"joint {self.name!r}: axis", self.axis, 3)
        link = finite_vector(f"joint {self.name!r}: link", self.link, 3)
        for what, number in {"offset": self.offset, "home": self.home, **self._factors()}.items():
            if not (is_number(number) and math.isfinite(number)):
                raise self._error(what, repr(number), "expected a finite number")
        for what, low, high in (
            ("limits", self.lower, self.upper),
            ("axis_limits", self.axis_lower, self.axis_upper),
        ):
            if not (is_number(low) and is_number(high)):
                raise self._error(what, f"[{low!r}, {high!r}]", "expected two numbers; infinite for none")
            if not low <= high:
                raise self._error(what, f"[{low:g}, {high:g}]", "the first must not be above the second")
        if self.passive and (self.lower > -math.inf or self.upper < math.inf):
            limits = f"[{self.lower:g}, {self.upper:g}]"
            raise self._error("limits", limits, "a passive joint has no value; give its axis axis_limits")
        if not self.passive and not self.lower <= self.home <= self.upper:
            raise self._error(
                "home", f"{self.home:g}", f"expected within its limits [{self.lower:g}, {self.upper:g}]"
            )
        object.__setattr__(self, "axis", tuple(axis.tolist()))
        object.__setattr__(self, "link", tuple(link.tolist()))
        object.__setattr__(self, "coupling", MappingProxyType(dict(self.coupling)))

    def __reduce__(self) -> tuple[Any, ...]:
        given = {each.name: getattr(self, each.name) for each in fields(self)}
        return partial(Joint, **given | {"coupling": dict(self.coupling)}), ()

    def _factors(self) -> dict[str, float]:
        return {f"coupling to {name!r}": factor for name, factor in self.coupling.items()}

    def _error(self, what: str, was: str, expected: str) -> GaikError:
        return GaikError(
            f"joint {self.name!r}: {what} {'are' if what.endswith('s') else 'is'} {was}; {expected}"
        )
