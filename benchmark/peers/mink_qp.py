"""mink: differential inverse kinematics on MuJoCo by quadratic programmes, iterated to the target."""

from __future__ import annotations

from typing import Any

import mink
import numpy as np

from peers.mujoco_dls import load
from peers.protocol import MAX_ITERATIONS, Array, Solver
from problems import Problem


class Mink(Solver):
    """A FrameTask with full steps and the configuration limit, solved by DAQP."""

    name = "mink"
    package = "mink"

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        self.configuration = mink.Configuration(load(problem))
        self.limits = [mink.ConfigurationLimit(self.configuration.model)]
        turns = 0.0 if problem.orientations is None else 1.0
        self.task = mink.FrameTask(problem.tip, "body", position_cost=1.0, orientation_cost=turns)

    def targets(self) -> list[Any]:
        turns = self.problem.orientations
        if turns is None:
            return [mink.SE3.from_translation(position) for position in self.problem.targets]
        return [
            mink.SE3.from_rotation_and_translation(mink.SO3(turn), position)
            for turn, position in zip(turns, self.problem.targets, strict=True)
        ]

    def start(self) -> Any:
        return self.problem.axis_start

    def solve(self, target: Any, start: Any) -> Any:
        configuration, task, problem = self.configuration, self.task, self.problem
        free = problem.orientations is None
        configuration.update(q=start)
        task.set_target(target)
        for _ in range(MAX_ITERATIONS):
            error = task.compute_error(configuration)
            reached = error[:3].dot(error[:3]) < problem.tolerance**2
            if reached and (free or error[3:].dot(error[3:]) < problem.orientation_tolerance**2):
                break
            velocity = mink.solve_ik(configuration, [task], 1.0, "daqp", damping=1e-4, limits=self.limits)
            configuration.integrate_inplace(velocity, 1.0)
        return configuration.q.copy()

    def angles(self, answers: list[Any]) -> Array:
        return self.problem.from_axes(np.array(answers))
