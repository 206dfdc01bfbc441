"""Inverse position kinematics: `solve` one target, `solve_path` along many, `solve_batch` each for itself."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gaik_core.batch import BatchProblem, BatchResult, solve_in_parallel
from gaik_core.chain import KinematicChain, algebra_code, no_chain
from gaik_core.checks import array_of, copied_vector, count, finite, finite_vector, positive
from gaik_core.errors import GaikError, ShapeError
from gaik_core.kernels import descent as kernels
from gaik_core.kernels import many
from gaik_core.kernels.kinematics import Chain
from gaik_core.kernels.posture import settle
from gaik_core.kernels.problem import (
    pack_problem,
    solve_packed,
    solve_packed_with_restarts,
    solve_packed_with_trace,
)
from gaik_core.kernels.task import POSITION
from gaik_core.solution import STATUS, Solution, Solutions, Trace
from gaik_core.targets import Target, Targets, pack_target, pack_targets
from gaik_core.update_rules import Adam, LevenbergMarquardt, UpdateRule

Array = NDArray[np.float64]


__all__ = ["Solution", "Solutions", "Trace", "random_starts", "solve", "solve_batch", "solve_path"]

MOST_ITERATIONS = 2**53  # a float64 counts no further

WIDEST_SLIDE = 1e9
"""Half the range (m) from which a slide's limits no longer say where it may be; of what turns, a turn says no more."""

_ADAM = Adam()
_MARQUARDT = LevenbergMarquardt()


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
    posture: ArrayLike | None = None,
    orientation_tolerance: float = 1e-2,
    orientation_weight: float | None = None,
) -> Solution:
    """Find angles that bring the tip to a target, by descent from a start (sections 3.2 and 4.2).

    Args:
        chain: the arm.
        target: (3,) a position in m, a Pointing, a Pose, or a Motor that moves the base frame onto the tip's.
        start: (dof,) angles to start from; the chain's home by default. Not changed; never wrapped.
        algebra: "quaternion" or "conformal": the same numbers to rounding.
        rule: how an update follows from the error and the Jacobian.
        tolerance: the solve converges when the distance to the target is below it (m).
        max_iterations: how many updates it may make in all.
        limits: whether to hold the joint limits at every iterate; by default where the chain has any.
        trace: whether to keep every iterate; not together with restarts.
        restarts: how many seeded starts inside the limits to try, one after the other, when stuck.
        seed: of those starts.
        posture: (dof,) angles to prefer where the arm is redundant. A solve that converges then moves toward them for
            as long as the tip stays within the tolerance. Not together with trace.
        orientation_tolerance: for a Pointing or a Pose, the angle below which the solve converges (rad).
        orientation_weight: how many metres one radian counts for in the loss; by default the sum of the links'
            lengths over π, and 1 where that is zero.

    Returns:
        A Solution; one that has not converged says why in its status.

    Raises:
        GaikError: an argument of the wrong shape, not finite, out of range or unknown; the message names it.
    """
    if not isinstance(chain, KinematicChain):
        raise no_chain(chain)
    kind, wanted = pack_target(target)
    angles = copied_vector("start", chain.home if start is None else start, chain.dof)
    given = (
        chain, kind, algebra, rule, tolerance, max_iterations, limits, orientation_tolerance, orientation_weight,
    )  # fmt: skip
    try:
        packed = _packed_problem(*given)
    except TypeError:  # something that has no hash
        packed = _packed_problem.__wrapped__(*given)
    if trace:
        return _solve_traced(chain, packed, wanted, angles, max_iterations, restarts, posture)
    preferred = None if posture is None else finite_vector("posture", posture, chain.dof)
    used = 0
    if restarts:
        starts = random_starts(chain, count("restarts", restarts), count("seed", seed))
        status, iterations, error, turn, used = solve_packed_with_restarts(packed, wanted, angles, starts)
    else:
        status, iterations, error, turn = solve_packed(packed, wanted, angles)
    if status == kernels.NOT_FINITE:
        _raise_not_finite(wanted, angles)
    if preferred is not None and status == kernels.CONVERGED:
        left = max_iterations - iterations
        stop = _stop(chain, kind, rule, tolerance, orientation_tolerance, orientation_weight, left)
        problem = (algebra_code(algebra), _packed(chain, limits), kind, wanted, stop)
        more, error, turn = settle(*problem, _MARQUARDT.settings, preferred, angles)
        iterations += more
    converged = status == kernels.CONVERGED
    # As Solution(...), without the time it takes to bind eight arguments.
    return tuple.__new__(Solution, (angles, error, iterations, converged, STATUS[status], None, turn, used))


def solve_batch(
    chain: KinematicChain,
    targets: Targets,
    start: ArrayLike | None = None,
    algebra: str = "quaternion",
    rule: UpdateRule = _ADAM,
    tolerance: float = 5e-3,
    max_iterations: int = 1000,
    *,
    limits: bool | None = None,
    restarts: int = 0,
    seed: int = 0,
    workers: int | None = None,
    orientation_tolerance: float = 1e-2,
    orientation_weight: float | None = None,
) -> Solutions:
    """Solve m targets, each for itself, on all processors: positions by LevenbergMarquardt sixteen in lock step.

    Args:
        chain: the arm.
        targets: (m, 3) positions in m, an array of motors, or a sequence of Poses, Motors or Pointings.
        start: (dof,) for all of them, or (m, dof) for each; the chain's home by default.
        algebra: as for `solve`, like the rest but for `workers`.
        rule: how an update follows from the error and the Jacobian.
        tolerance: distance below which a solve converges (m).
        max_iterations: how many updates each may make.
        limits: whether to hold the joint limits.
        restarts: how many other starts each may try.
        seed: of those starts.
        workers: how many processors to use; all that the process may use by default.
        orientation_tolerance: of Poses, Motors and Pointings (rad).
        orientation_weight: how many metres one radian counts for.

    Returns:
        A Solution of arrays: the numbers that `solve` gives for each target, to rounding.

    Raises:
        GaikError: as for `solve`; not one NaN among the targets is taken.
    """
    if not isinstance(chain, KinematicChain):
        raise no_chain(chain)
    kind, wanted = pack_targets(targets)
    first = array_of("start", chain.home if start is None else start)
    if first.shape not in ((chain.dof,), (len(wanted), chain.dof)):
        raise ShapeError("start", first.shape, f"({chain.dof},) or ({len(wanted)}, {chain.dof})")
    finite("start", first)
    result = BatchResult.of(len(wanted), chain.dof)
    problem = BatchProblem(
        algebra_code(algebra),
        _packed(chain, limits),
        kind,
        wanted,
        np.broadcast_to(first, (len(wanted), chain.dof)),
        _stop(chain, kind, rule, tolerance, orientation_tolerance, orientation_weight, max_iterations),
        rule,
        random_starts(chain, count("restarts", restarts), count("seed", seed)),
    )
    solve_in_parallel(problem, result, count("workers", workers) if workers is not None else None)
    return result.solutions()


def solve_path(
    chain: KinematicChain,
    targets: Targets,
    start: ArrayLike | None = None,
    algebra: str = "quaternion",
    rule: UpdateRule = _ADAM,
    tolerance: float = 5e-3,
    max_iterations: int = 1000,
    *,
    limits: bool | None = None,
    largest_step: float = math.pi / 4,
    orientation_tolerance: float = 1e-2,
    orientation_weight: float | None = None,
) -> Solutions:
    """Solve targets in order, each from the angles of the one before (section 4.3), without a change of branch.

    Args:
        chain: the arm.
        targets: (m, 3) positions in m, an array of motors, or a sequence of Poses, Motors or Pointings, in order.
        start: (dof,) angles before the first; the chain's home by default.
        algebra: as for `solve`, like the rest but for `largest_step`.
        rule: how an update follows from the error and the Jacobian.
        tolerance: distance below which a target is reached (m).
        max_iterations: how many updates each solve may take: of a target or, on the way to it, of a piece.
        limits: whether to hold the joint limits.
        largest_step: no joint moves further than this (rad or m) in one solve. A target at which one would is walked
            to in 2, 4, … 128 pieces of the straight way from the target before; where even of the smallest one jumps,
            the arm stays where it was, stagnated. So targets that lie close together are as close in the joints.
        orientation_tolerance: of Poses, Motors and Pointings (rad).
        orientation_weight: how many metres one radian counts for.

    Returns:
        A Solution of arrays.

    Raises:
        GaikError: as for `solve`.
    """
    if not isinstance(chain, KinematicChain):
        raise no_chain(chain)
    kind, wanted = pack_targets(targets)
    first = finite_vector("start", chain.home if start is None else start, chain.dof)
    result = BatchResult.of(len(wanted), chain.dof)
    stop = _stop(chain, kind, rule, tolerance, orientation_tolerance, orientation_weight, max_iterations)
    bound = positive("largest_step", largest_step)
    if len(wanted):
        many.solve_along(
            algebra_code(algebra), _packed(chain, limits), kind, wanted, stop, rule.kernel, rule.settings,
            first, bound, result.angles, result.counts, result.errors,
        )  # fmt: skip
    return result.solutions()


@lru_cache(maxsize=64)
def random_starts(chain: KinematicChain, count: int, seed: int) -> Array:
    """Angles (count, dof) drawn evenly from inside the limits; where these are wide, from a range of 2π about home.

    Kept, and so read-only: a solve that needs no restart does not pay for drawing them.
    """
    turn = 2.0 * math.pi
    slides = np.array([joint.kind == "prismatic" for joint in chain.joints if not joint.passive])
    wide = chain.upper / 2.0 - chain.lower / 2.0 > np.where(slides, WIDEST_SLIDE, turn)
    low = np.where(wide, np.clip(chain.home - math.pi, chain.lower, chain.upper - turn), chain.lower)
    high = np.where(wide, low + turn, chain.upper)
    try:
        starts = np.random.default_rng(seed).uniform(low, high, (count, chain.dof))
    except (MemoryError, ValueError):
        raise GaikError(f"restarts is {count}; there is no memory for so many starts") from None
    starts.flags.writeable = False
    return starts


def _solve_traced(
    chain: KinematicChain,
    packed: Array,
    target: Array,
    angles: Array,
    most: int,
    restarts: int,
    posture: ArrayLike | None,
) -> Solution:
    """One descent with every iterate kept."""
    if restarts:
        raise GaikError(f"restarts is {restarts}; expected 0 with trace=True, as a trace is of one descent")
    if posture is not None:
        raise GaikError(f"posture is {posture}; expected None with trace=True, as a trace is of one descent")
    try:
        trace_angles, trace_errors = np.empty((most + 1, len(angles))), np.empty((most + 1, 2))
    except (MemoryError, ValueError):
        raise GaikError(f"max_iterations is {most}; there is no memory for a trace of so many") from None
    status, iterations, error, turn = solve_packed_with_trace(
        packed, target, angles, trace_angles, trace_errors
    )
    if status == kernels.NOT_FINITE:
        _raise_not_finite(target, angles)
    made = slice(iterations + 1)
    kept = Trace(trace_angles[made].copy(), trace_errors[made, 0].copy(), trace_errors[made, 1].copy())
    if status == kernels.UNREACHABLE:  # then the descent may have been toward a nearer point
        x, y, z = (target[:3] - chain.forward(kept.angles)).T
        kept = kept._replace(error=np.hypot(np.hypot(x, y), z))
    return Solution(angles, error, iterations, status == kernels.CONVERGED, STATUS[status], kept, turn)


def _raise_not_finite(target: Array, start: Array) -> None:
    finite("target", target)
    finite("start", start)


@lru_cache(maxsize=256, typed=True)  # typed: 5 is a number of updates, 5.0 is not
def _packed_problem(
    chain: KinematicChain,
    kind: int,
    algebra: str,
    rule: UpdateRule,
    tolerance: float,
    max_iterations: int,
    limits: bool | None,
    orientation_tolerance: float,
    orientation_weight: float | None,
) -> Array:
    """All that a solve takes but for target and start, checked; kept, since most solves only change those two."""
    code = algebra_code(algebra)
    stop = _stop(chain, kind, rule, tolerance, orientation_tolerance, orientation_weight, max_iterations)
    return pack_problem(code, _packed(chain, limits), kind, stop, rule.kernel, rule.settings)


def _packed(chain: KinematicChain, limits: bool | None) -> Chain:
    """The chain's arrays, with the limits to hold."""
    held = chain.limited if limits is None else limits
    return chain.packed if held else chain.packed_without_limits


def _stop(
    chain: KinematicChain,
    kind: int,
    rule: UpdateRule,
    tolerance: float,
    orientation_tolerance: float,
    orientation_weight: float | None,
    max_iterations: int,
) -> kernels.Stop:
    """What ends a descent; checks the rule too, which says when it is stuck."""
    if not isinstance(rule, UpdateRule):
        raise GaikError(f"rule is {rule!r}; expected an update rule, such as LevenbergMarquardt()")
    weight = 1.0 if kind == POSITION else _weight(chain, orientation_weight)
    return (
        positive("tolerance", tolerance),
        positive("orientation_tolerance", orientation_tolerance),
        weight,
        rule.window,
        min(count("max_iterations", max_iterations), MOST_ITERATIONS),
    )


def _weight(chain: KinematicChain, given: float | None) -> float:
    """Metres that one radian counts for.

    Travel does not count: a gantry of 10 m would turn no further than to a tenth of a radian of a pose.
    """
    if given is not None:
        return positive("orientation_weight", given)
    length = sum(math.hypot(*joint.link) for joint in chain.joints)
    return length / math.pi if length > 0.0 else 1.0
