"""gaik itself, through its public functions with all their checks."""

from __future__ import annotations

from typing import Any

import numpy as np

from gaik_core import Adam, GradientDescent, LevenbergMarquardt, Pose, UpdateRule, solve
from peers.protocol import Array, NotSolvableError, Solver
from problems import Problem


class Ours(Solver):
    """`solve` with one rule and one algebra."""

    package = "gaik_core"
    algebra = "quaternion"
    rule: UpdateRule

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        self.options: dict[str, Any] = {
            "algebra": self.algebra,
            "rule": self.rule,
            "tolerance": problem.tolerance,
        }
        if problem.orientations is not None:
            self.options["orientation_tolerance"] = problem.orientation_tolerance
        if problem.restarts:
            self.options["restarts"] = problem.restarts

    def targets(self) -> list[Any]:
        if self.problem.orientations is None:
            return list(self.problem.targets)
        return [Pose(*pose) for pose in zip(self.problem.targets, self.problem.orientations, strict=True)]

    def start(self) -> Any:
        return self.problem.start

    def solve(self, target: Any, start: Any) -> Any:
        return solve(self.problem.chain, target, start, **self.options).angles

    def angles(self, answers: list[Any]) -> Array:
        return np.array(answers)


class LevenbergMarquardtQuaternion(Ours):
    """The rule for speed."""

    name = "gaik LM"
    rule = LevenbergMarquardt()


class LevenbergMarquardtConformal(Ours):
    """The same by the other algebra."""

    name = "gaik LM, conformal"
    algebra = "conformal"
    rule = LevenbergMarquardt()


class AdamQuaternion(Ours):
    """The paper's rule."""

    name = "gaik Adam"
    rule = Adam(0.05)


class AdamConformal(Ours):
    """The same by the other algebra."""

    name = "gaik Adam, conformal"
    algebra = "conformal"
    rule = Adam(0.05)


class AutoStep(Ours):
    """Gradient descent that chooses its own step."""

    name = "gaik descent, auto step"
    rule = GradientDescent("auto")


class LevenbergMarquardtUnlimited(Ours):
    """Without joint limits, as the peers that know none."""

    name = "gaik LM, limits off"
    rule = LevenbergMarquardt()

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        if not problem.chain.limited:
            raise NotSolvableError("the arm has no limits")
        self.options["limits"] = False
