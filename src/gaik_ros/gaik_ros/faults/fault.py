"""What a fault is: a name, what is done, what is promised, and the play that does it and checks the promise."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gaik_ros.faults.stage import Stage


class Need(StrEnum):
    """What a fault needs beyond a running suite."""

    PROCESSES = "processes"  # the nodes are the injector's own processes
    CABLE = "cable"  # joint_states come through the injector
    TWIN = "twin"  # the device is touch_sim


@dataclass(frozen=True)
class Check:
    """One thing that was promised, what was measured of it, and whether it holds."""

    promise: str
    measured: str
    holds: bool


Play = Callable[["Stage"], Sequence[Check]]


@dataclass(frozen=True)
class Fault:
    """One row of the table in docs/faults.md.

    `play` does it and returns what it checked; what holds in every case (invariants.py) and the recovery are checked
    around it. A `long` one takes a minute or more.
    """

    name: str
    does: str
    promises: str
    play: Play
    needs: frozenset[Need] = frozenset()
    long: bool = False


@dataclass(frozen=True)
class Outcome:
    """A fault that was played: its checks and how long it took in s."""

    fault: Fault
    checks: tuple[Check, ...]
    seconds: float

    @property
    def holds(self) -> bool:
        """Whether every promise held."""
        return all(check.holds for check in self.checks)

    @property
    def broken(self) -> tuple[Check, ...]:
        """The promises that did not hold."""
        return tuple(check for check in self.checks if not check.holds)


class StageError(RuntimeError):
    """A fault cannot be played: the suite lacks something, or does not answer. One line for the user."""
