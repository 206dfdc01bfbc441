"""Peter Corke's Robotics Toolbox: Levenberg-Marquardt in C++, with restarts and joint limits."""

from __future__ import annotations

from typing import Any

import numpy as np
import roboticstoolbox
from roboticstoolbox.models.URDF.URDFRobot import URDF_file

from peers.protocol import Array, Solver, homogeneous
from problems import Problem


class Toolbox(Solver):
    """`ETS.ik_LM` with Chan's damping, the library's default."""

    name = "roboticstoolbox"
    package = "roboticstoolbox-python"

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        links, _, _ = URDF_file(str(problem.urdf))
        robot = roboticstoolbox.Robot(links)
        self.ets = robot.ets(start=problem.base, end=problem.tip)
        turns = 0.0 if problem.orientations is None else 1.0
        tolerance = problem.tolerance if not turns else min(problem.tolerance, problem.orientation_tolerance)
        # without restarts one long search; with them, the library's 30 iterations each
        self.options = {
            "mask": np.array([1.0, 1.0, 1.0, turns, turns, turns]),
            "tol": 0.5 * tolerance**2,  # the toolbox's residual is ½ eᵀ W e
            "joint_limits": problem.chain.limited,
            "slimit": problem.restarts + 1,
            "ilimit": 30 if problem.restarts else 500,
            "method": "chan",
            "k": 1.0,
        }

    def targets(self) -> list[Any]:
        return list(homogeneous(self.problem))

    def start(self) -> Any:
        return self.problem.axis_start

    def solve(self, target: Any, start: Any) -> Any:
        return self.ets.ik_LM(target, q0=start, **self.options).q

    def angles(self, answers: list[Any]) -> Array:
        return self.problem.from_axes(np.array(answers))
