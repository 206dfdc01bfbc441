"""pink: differential inverse kinematics on Pinocchio by quadratic programmes, iterated to the target."""

from __future__ import annotations

from typing import Any

import numpy as np
import pink
import pinocchio

from peers.protocol import MAX_ITERATIONS, Array, Solver, homogeneous
from problems import Problem


class Pink(Solver):
    """A FrameTask with full steps and the configuration limit, solved by DAQP."""

    name = "pink"
    package = "pin-pink"

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        self.model = pinocchio.buildModelFromUrdf(str(problem.urdf))
        self.data = self.model.createData()
        self.limits = [pink.limits.ConfigurationLimit(self.model)]
        turns = 0.0 if problem.orientations is None else 1.0
        self.task = pink.tasks.FrameTask(problem.tip, position_cost=1.0, orientation_cost=turns)

    def targets(self) -> list[Any]:
        return [pinocchio.SE3(matrix) for matrix in homogeneous(self.problem)]

    def start(self) -> Any:
        return self.problem.axis_start

    def solve(self, target: Any, start: Any) -> Any:
        task, problem = self.task, self.problem
        free = problem.orientations is None
        configuration = pink.Configuration(self.model, self.data, start)
        task.set_target(target)
        for _ in range(MAX_ITERATIONS):
            error = task.compute_error(configuration)
            reached = error[:3].dot(error[:3]) < problem.tolerance**2
            if reached and (free or error[3:].dot(error[3:]) < problem.orientation_tolerance**2):
                break
            velocity = pink.solve_ik(
                configuration, [task], 1.0, "daqp", damping=1e-4, limits=self.limits, safety_break=False
            )
            configuration.integrate_inplace(velocity, 1.0)
        return configuration.q

    def angles(self, answers: list[Any]) -> Array:
        return self.problem.from_axes(np.array(answers))
