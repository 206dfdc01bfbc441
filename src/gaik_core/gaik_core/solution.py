"""What a solve returns."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Status(StrEnum):
    """How a solve ended."""

    CONVERGED = "converged"
    ITERATION_LIMIT = "iteration_limit"
    STAGNATED = "stagnated"
    UNREACHABLE = "unreachable"
    """The lengths of the links prove that no angles reach the target."""
    LIMITED = "limited"
    """Held off the target by joint limits."""


STATUS = (Status.CONVERGED, Status.ITERATION_LIMIT, Status.STAGNATED, Status.UNREACHABLE, Status.LIMITED)
"""By the numbers of `gaik_core.kernels.descent`."""


class Trace(NamedTuple):
    """Every iterate of a solve, its start included.

    Attributes:
        angles: (iterations + 1, dof).
        error: (iterations + 1,) distance from the target (m).
        orientation_error: (iterations + 1,) angle from the target (rad); zero for a position.
    """

    angles: Array
    error: Array
    orientation_error: Array


class Solution(NamedTuple):
    """The end of a solve.

    Attributes:
        angles: (dof,) the last angles; of a solve that has not converged, those that came nearest.
        error: distance |target - forward(angles)| (m).
        iterations: updates made, over all attempts; 0 where the start satisfied the tolerance.
        converged: whether the error is below the tolerance, and the orientation's error below its own.
        status: how the solve ended.
        trace: every iterate, where it was asked for.
        orientation_error: angle from the target's orientation or direction (rad); 0 for a position.
        restarts: how many other starts were tried.
    """

    angles: Array
    error: float
    iterations: int
    converged: bool
    status: Status
    trace: Trace | None = None
    orientation_error: float = 0.0
    restarts: int = 0


class Solutions(Solution):
    """The ends of m solves: a Solution whose every field but the trace has a first axis (m,)."""

    __slots__ = ()

    if TYPE_CHECKING:
        error: Array  # type: ignore[assignment]
        iterations: NDArray[np.int64]  # type: ignore[assignment]
        converged: NDArray[np.bool_]  # type: ignore[assignment]
        status: NDArray[np.object_]  # type: ignore[assignment]  # of Status
        orientation_error: Array  # type: ignore[assignment]
        restarts: NDArray[np.int64]  # type: ignore[assignment]
