"""One axis of a chain, as a robot file describes it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal

Vector = tuple[float, float, float]
Kind = Literal["revolute", "prismatic"]


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
    coupling: Mapping[str, float] = field(default_factory=dict)
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
        norm = math.hypot(*self.axis)
        if not (math.isfinite(norm) and norm > 0.0):
            raise ValueError(
                f"joint {self.name!r}: axis is {list(self.axis)}; expected a direction other than zero"
            )
        for what, low, high in (
            ("limits", self.lower, self.upper),
            ("axis_limits", self.axis_lower, self.axis_upper),
        ):
            if not low <= high:
                raise ValueError(
                    f"joint {self.name!r}: {what} are [{low:g}, {high:g}]; the first must not be above the second"
                )
        if not self.passive and not self.lower <= self.home <= self.upper:
            raise ValueError(
                f"joint {self.name!r}: home is {self.home:g}; expected within its limits "
                f"[{self.lower:g}, {self.upper:g}]"
            )
        object.__setattr__(self, "axis", tuple(component / norm for component in self.axis))
        object.__setattr__(self, "coupling", MappingProxyType(dict(self.coupling)))
