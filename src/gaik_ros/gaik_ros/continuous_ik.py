"""Inverse kinematics for a device that a hand holds: an answer for every target, and no jump to another branch.

A solve from far away may end on another branch of solutions than the one the arm is on. So a far target is
approached in the mind first: along the straight line from the tip, in steps short enough to stay on the branch.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gaik_core import KinematicChain, Solution, Status, UpdateRule, solve

Array = NDArray[np.float64]

STEP = 0.02  # m: longest step of the approach
SHORTEST = STEP / 64.0  # m: where a step of this length still jumps, there is no continuous way on
JUMP = 0.3  # rad: a joint that turns more than this in one step has left the branch
MOST_SOLVES = 200  # of one approach: bounds its time
SAME = 1e-3  # rad: answers closer than this are the same
ON_LIMIT = 1e-6  # rad


class Result(StrEnum):
    """The verdict on a setpoint."""

    REACHED = "reached"
    UNREACHABLE = "unreachable"  # the lengths of the links rule it out
    LIMITED = "limited"  # joint limits hold the arm off it
    STAGNATED = "stagnated"  # the solver came no nearer
    REFUSED = "refused"  # not a position
    WAITING = "waiting"  # nothing is known of the device yet


_RESULT = {
    Status.CONVERGED: Result.REACHED,
    Status.UNREACHABLE: Result.UNREACHABLE,
    Status.LIMITED: Result.LIMITED,
    Status.STAGNATED: Result.STAGNATED,
    Status.ITERATION_LIMIT: Result.STAGNATED,
}


@dataclass(frozen=True, eq=False)
class Answer:
    """What is done about a target: `angles` (dof,) are finite and inside the limits, whatever the result."""

    result: Result
    angles: Array
    nearest: Array  # (3,) m, where the tip is with these angles
    error: float  # m, between the target and `nearest`
    iterations: int  # updates of all solves made for it
    joint: str = ""  # the joints that stand on a limit, where that is the reason
    branch_refused: bool = False  # the direct solve had ended on another branch


class ContinuousIk:
    """Solves targets one after the other, each from the answer of the one before."""

    def __init__(
        self, chain: KinematicChain, algebra: str, rule: UpdateRule, tolerance: float, max_iterations: int
    ) -> None:
        """As for `gaik_core.solve`; `tolerance` in m."""
        self.chain = chain
        self._algebra = algebra
        self._options: dict[str, Any] = {
            "algebra": algebra,
            "rule": rule,
            "tolerance": tolerance,
            "max_iterations": max_iterations,
        }
        self._iterations = 0

    def solve(self, target: Array, start: Array) -> Answer:
        """The answer for a target (3,) m, finite, from where the arm is: `start` (dof,) rad."""
        self._iterations = 0
        tip = self.chain.forward(start, self._algebra)
        direct = self._solve(target, start)
        near = float(np.linalg.norm(target - tip)) <= STEP
        if direct.converged and near and np.abs(direct.angles - start).max() <= JUMP:
            return self._answer(target, direct)
        aim = self._within_reach(target)
        walked = self._approach(tip, aim, start)
        polished = self._solve(target, self._solve(aim, walked).angles)
        if not polished.converged:
            # No way along the line: the direct answer, even on another branch, is better than none.
            return self._answer(target, min((direct, polished), key=lambda s: (not s.converged, s.error)))
        flipped = direct.converged and bool(np.abs(direct.angles - polished.angles).max() > SAME)
        return self._answer(target, polished, flipped)

    def onto_limits(self, angles: Array) -> Array:
        """Angles (dof,) rad moved onto the limits that they break."""
        return solve(self.chain, self.chain.forward(angles), angles, max_iterations=0).angles

    def _solve(self, target: Array, start: Array) -> Solution:
        solution = solve(self.chain, target, start, **self._options)
        self._iterations += solution.iterations
        return solution

    def _within_reach(self, target: Array) -> Array:
        """The target, drawn in to the sphere that holds all positions of the tip."""
        base = self.chain.frames(self.chain.home)[0]
        away = target - base
        distance = float(np.linalg.norm(away))
        return target if distance <= self.chain.reach else base + away * (self.chain.reach / distance)

    def _approach(self, tip: Array, target: Array, start: Array) -> Array:
        """The angles (dof,) as far along the line from `tip` to `target` as the arm gets without a jump."""
        distance = float(np.linalg.norm(target - tip))
        angles, done, step = start, 0.0, STEP
        for _ in range(MOST_SOLVES):
            if done >= distance:
                break
            reach = min(distance, done + step)
            solution = self._solve(tip + (target - tip) * (reach / distance), angles)
            if solution.converged and np.abs(solution.angles - angles).max() <= JUMP:
                angles, done, step = solution.angles, reach, min(STEP, 2.0 * step)
            elif step > SHORTEST:
                step *= 0.5
            else:
                break
        return angles

    def _answer(self, target: Array, solution: Solution, flipped: bool = False) -> Answer:
        nearest = self.chain.forward(solution.angles, self._algebra)
        result = _RESULT[solution.status]
        joint = self._on_limit(solution.angles) if result is not Result.REACHED else ""
        return Answer(
            result=result,
            angles=solution.angles,
            nearest=nearest,
            error=float(np.linalg.norm(target - nearest)),
            iterations=self._iterations,
            joint=joint,
            branch_refused=flipped,
        )

    def _on_limit(self, angles: Array) -> str:
        """The names of the joints and axes that stand on a limit."""
        chain, axes = self.chain, self.chain.axis_angles(angles)
        names = _standing(chain.joint_names, angles, chain.lower, chain.upper)
        names += _standing(chain.axis_names, axes, chain.axis_lower, chain.axis_upper)
        return ",".join(dict.fromkeys(names))


def _standing(names: tuple[str, ...], angles: Array, lower: Array, upper: Array) -> list[str]:
    standing = (angles <= lower + ON_LIMIT) | (angles >= upper - ON_LIMIT)
    return [name for name, there in zip(names, standing, strict=True) if there]
