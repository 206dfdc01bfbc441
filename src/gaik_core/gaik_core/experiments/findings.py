"""What an experiment is and what it finds: rows beside the paper's, tables, errata, a picture."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Comparison:
    """A quantity as the paper prints it and as it comes out here, by each algebra.

    Attributes:
        quantity: what it is, in words.
        unit: of all three; "" for a count.
        printed: what the paper prints, a number or several; None where it prints nothing.
        quaternion, conformal: what comes out here.
        decimals: how many a reader needs.
        remark: why it differs, where it does.
    """

    quantity: str
    unit: str
    printed: ArrayLike | None
    quaternion: ArrayLike
    conformal: ArrayLike
    decimals: int = 4
    remark: str = ""

    @property
    def difference(self) -> Array | None:
        """Ours by quaternions less the paper's; None where the paper prints nothing."""
        if self.printed is None:
            return None
        difference: Array = np.asarray(self.quaternion, dtype=float) - np.asarray(self.printed, dtype=float)
        return difference


@dataclass(frozen=True)
class Erratum:
    """A place where the paper errs.

    Attributes:
        where: equation or section.
        printed: what stands there.
        holds: what holds.
        measured: the evidence, in words and numbers of this run.
        confirmed: whether the evidence bears it out.
    """

    where: str
    printed: str
    holds: str
    measured: str
    confirmed: bool


class Table(NamedTuple):
    """A table of the page: texts and numbers."""

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[object]]


class Iterates(NamedTuple):
    """Every iterate of the same descents, (steps, dof) in rad, as each algebra makes them."""

    quaternion: Array
    conformal: Array

    @property
    def gap(self) -> float:
        """The largest difference of any joint at any step (rad); infinite where one makes more steps."""
        if self.quaternion.shape != self.conformal.shape:
            return float("inf")
        return float(np.abs(self.quaternion - self.conformal).max(initial=0.0))


@dataclass(frozen=True)
class Findings:
    """What one run of an experiment found.

    Attributes:
        comparisons: the first is the one shown in the page's overview.
        iterates: the descents behind them, by either algebra.
        draw: makes the picture, as the paper draws it; None where there is none.
        tables: further tables for the page.
        errata: the paper's errors that this experiment shows.
        numbers: further numbers for the JSON file; arrays are welcome.
    """

    comparisons: Sequence[Comparison]
    iterates: Mapping[str, Iterates] = field(default_factory=dict)
    draw: Callable[[], Figure] | None = None
    tables: Sequence[Table] = ()
    errata: Sequence[Erratum] = ()
    numbers: Mapping[str, Any] = field(default_factory=dict)

    @property
    def gap(self) -> float:
        """The largest difference between the algebras at any step of any descent (rad)."""
        return max((iterates.gap for iterates in self.iterates.values()), default=0.0)


@dataclass(frozen=True)
class Experiment:
    """An experiment of the paper.

    Attributes:
        name: as on the command line, "fig18"; also the stem of the picture's file.
        section: of the paper.
        title: a line.
        about: a paragraph for the page: what is done, and what had to be assumed.
        run: does it. It may take seconds and must be repeatable.
    """

    name: str
    section: str
    title: str
    about: str
    run: Callable[[], Findings]
