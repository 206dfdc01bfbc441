"""Pinocchio: closed-loop inverse kinematics, a Python loop around its C++ kinematics as in its own example."""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio

from peers.protocol import MAX_ITERATIONS, Array, Solver, homogeneous
from problems import Problem

DAMPING = 1e-4


class PinocchioClik(Solver):
    """Full damped Gauss-Newton steps, clipped to the joint limits."""

    name = "Pinocchio CLIK"
    package = "pin"

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        self.model = pinocchio.buildModelFromUrdf(str(problem.urdf))
        self.data = self.model.createData()
        self.frame = self.model.getFrameId(problem.tip)
        self.lower, self.upper = self.model.lowerPositionLimit, self.model.upperPositionLimit
        self.solve = self._position if problem.orientations is None else self._pose  # type: ignore[method-assign]

    def targets(self) -> list[Any]:
        if self.problem.orientations is None:
            return list(self.problem.targets)
        return [pinocchio.SE3(matrix) for matrix in homogeneous(self.problem)]

    def start(self) -> Any:
        return self.problem.axis_start

    def solve(self, target: Any, start: Any) -> Any:
        raise NotImplementedError

    def _position(self, target: Array, start: Array) -> Array:
        model, data, frame = self.model, self.data, self.frame
        damping, tolerance = DAMPING * np.eye(3), self.problem.tolerance
        q = start
        for _ in range(MAX_ITERATIONS):
            pinocchio.computeJointJacobians(model, data, q)
            error = target - pinocchio.updateFramePlacement(model, data, frame).translation
            if error.dot(error) < tolerance * tolerance:
                break
            jacobian = pinocchio.getFrameJacobian(model, data, frame, pinocchio.LOCAL_WORLD_ALIGNED)[:3]
            step = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + damping, error)
            q = np.minimum(np.maximum(q + step, self.lower), self.upper)
        return q

    def _pose(self, target: Any, start: Array) -> Array:
        model, data, frame = self.model, self.data, self.frame
        damping, p = DAMPING * np.eye(6), self.problem
        q = start
        for _ in range(MAX_ITERATIONS):
            pinocchio.computeJointJacobians(model, data, q)
            placement = pinocchio.updateFramePlacement(model, data, frame)
            error = pinocchio.log6(placement.actInv(target)).vector
            if (
                error[:3].dot(error[:3]) < p.tolerance**2
                and error[3:].dot(error[3:]) < p.orientation_tolerance**2
            ):
                break
            jacobian = pinocchio.getFrameJacobian(model, data, frame, pinocchio.LOCAL)
            step = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + damping, error)
            q = np.minimum(np.maximum(q + step, self.lower), self.upper)
        return q

    def angles(self, answers: list[Any]) -> Array:
        return self.problem.from_axes(np.array(answers))
