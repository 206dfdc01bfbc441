"""Inverse position kinematics: `solve` one target, `solve_path` along many, `solve_batch` each for itself."""

from __future__ import annotations

import math
from enum import StrEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gaik_core.chain import KinematicChain, algebra_code
from gaik_core.checks import count, finite, positive, rows, vector
from gaik_core.errors import GaikError, ShapeError
from gaik_core.kernels import descent as kernels
from gaik_core.kernels.task import POSITION
from gaik_core.targets import Target, pack_target
from gaik_core.update_rules import Adam, UpdateRule

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
        angles: (dof,) the last angles.
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


class Solutions(NamedTuple):
    """The ends of m solves: as Solution, with a first axis (m,) everywhere."""

    angles: Array
    error: Array
    iterations: NDArray[np.int64]
    converged: NDArray[np.bool_]
    status: NDArray[np.str_]
    trace: None = None
    orientation_error: Array | None = None
    restarts: NDArray[np.int64] | None = None


_ADAM = Adam()
_NO_TRACE = np.empty((0, 2))


def solve(
    chain: KinematicChain,
    target: Target,
    start: ArrayLike | None = None,
    algebra: str = "quaternion",
    rule: UpdateRule = _ADAM,
    tolerance: float = 5e-3,
    max_iterations: int = 1000,
    *,
    limits: bool | None = None,
    trace: bool = False,
    restarts: int = 0,
    seed: int = 0,
    orientation_tolerance: float = 1e-2,
    orientation_weight: float | None = None,
) -> Solution:
    """Find angles that bring the tip to a target, by descent from a start (sections 3.2 and 4.2).

    Args:
        chain: the arm.
        target: (3,) a position in m, or a Pointing or a Pose.
        start: (dof,) angles to start from; the chain's home by default. Not changed; never wrapped.
        algebra: "quaternion" or "conformal": the same numbers to rounding.
        rule: how an update follows from the error and the Jacobian.
        tolerance: the solve converges when the distance to the target is below it (m).
        max_iterations: how many updates it may make in all.
        limits: whether to hold the joint limits at every iterate; by default where the chain has any.
        trace: whether to keep every iterate; not together with restarts.
        restarts: how many seeded starts inside the limits to try, one after the other, when stuck.
        seed: of those starts.
        orientation_tolerance: for a Pointing or a Pose, the angle below which the solve converges (rad).
        orientation_weight: how many metres one radian counts for in the loss; by default the chain's reach over π.

    Returns:
        A Solution; one that has not converged says why in its status.

    Raises:
        GaikError: an argument of the wrong shape, not finite, out of range or unknown; the message names it.
    """
    kind, wanted = pack_target(target)
    angles = vector("start", chain.home if start is None else start, chain.dof).copy()
    stop = (
        positive("tolerance", tolerance),
        positive("orientation_tolerance", orientation_tolerance),
        _weight(chain, kind, orientation_weight),
        rule.window,
        count("max_iterations", max_iterations),
    )
    held = chain.limited if limits is None else limits
    packed = chain.packed if held else chain.packed_without_limits
    problem = (algebra_code(algebra), packed, kind, wanted, stop, rule.kernel, rule.settings, angles)
    if trace:
        return _solve_traced(problem, restarts)
    used = 0
    if restarts:
        starts = random_starts(chain, count("restarts", restarts), seed)
        status, iterations, error, turn, used = kernels.solve_with_restarts(*problem, starts)
    else:
        status, iterations, error, turn = kernels.solve_once(*problem, _NO_TRACE, _NO_TRACE)
    _raise_if_not_finite(status, wanted, angles)
    return Solution(angles, error, iterations, status == kernels.CONVERGED, STATUS[status], None, turn, used)


def solve_batch(
    chain: KinematicChain, targets: ArrayLike, start: ArrayLike | None = None, **options: object
) -> Solutions:
    """Solve m positions (m, 3), each from the same start (dof,) or from its own (m, dof); options as for `solve`."""
    points = rows("targets", targets, 3)
    first = np.asarray(chain.home if start is None else start, dtype=float)
    if first.shape not in ((chain.dof,), (len(points), chain.dof)):
        raise ShapeError("start", first.shape, f"({chain.dof},) or ({len(points)}, {chain.dof})")
    starts = np.broadcast_to(first, (len(points), chain.dof))
    return _gather(chain, [solve(chain, p, s, **options) for p, s in zip(points, starts, strict=True)])  # type: ignore[arg-type]


def solve_path(
    chain: KinematicChain, targets: ArrayLike, start: ArrayLike | None = None, **options: object
) -> Solutions:
    """Solve positions (m, 3) in order, each from the angles of the one before (section 4.3); options as for `solve`."""
    angles = chain.home if start is None else start
    solutions = []
    for point in rows("targets", targets, 3):
        solutions.append(solve(chain, point, angles, **options))  # type: ignore[arg-type]
        angles = solutions[-1].angles
    return _gather(chain, solutions)


def random_starts(chain: KinematicChain, count: int, seed: int) -> Array:
    """Angles (count, dof) drawn evenly from inside the limits, or from a turn either way where there are none."""
    low = np.where(np.isfinite(chain.lower), chain.lower, -math.pi)
    high = np.where(np.isfinite(chain.upper), chain.upper, math.pi)
    low, high = np.minimum(low, high), np.maximum(low, high)
    return np.random.default_rng(seed).uniform(low, high, (count, chain.dof))


def _solve_traced(problem: kernels.Problem, restarts: int) -> Solution:
    """One descent with every iterate kept."""
    if restarts:
        raise GaikError(f"restarts is {restarts}; expected 0 with trace=True, as a trace is of one descent")
    _, _, _, target, stop, _, _, angles = problem
    length = stop[-1] + 1
    trace_angles, trace_errors = np.empty((length, len(angles))), np.empty((length, 2))
    status, iterations, error, turn = kernels.solve_once(*problem, trace_angles, trace_errors)
    _raise_if_not_finite(status, target, angles)
    made = slice(iterations + 1)
    kept = Trace(trace_angles[made].copy(), trace_errors[made, 0].copy(), trace_errors[made, 1].copy())
    return Solution(angles, error, iterations, status == kernels.CONVERGED, STATUS[status], kept, turn)


def _raise_if_not_finite(status: int, target: Array, start: Array) -> None:
    if status == kernels.NOT_FINITE:
        finite("target", target)
        finite("start", start)


def _weight(chain: KinematicChain, kind: int, given: float | None) -> float:
    """Metres that one radian counts for."""
    if given is not None:
        return positive("orientation_weight", given)
    return 1.0 if kind == POSITION or math.isinf(chain.reach) else chain.reach / math.pi


def _gather(chain: KinematicChain, solutions: list[Solution]) -> Solutions:
    return Solutions(
        angles=np.array([s.angles for s in solutions]).reshape(-1, chain.dof),
        error=np.array([s.error for s in solutions], dtype=float),
        iterations=np.array([s.iterations for s in solutions], dtype=np.int64),
        converged=np.array([s.converged for s in solutions], dtype=bool),
        status=np.array([s.status.value for s in solutions], dtype=str),
        orientation_error=np.array([s.orientation_error for s in solutions], dtype=float),
        restarts=np.array([s.restarts for s in solutions], dtype=np.int64),
    )
