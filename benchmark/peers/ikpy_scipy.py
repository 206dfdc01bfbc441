"""ikpy: scipy's trust-region least squares around a Python forward kinematics."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from ikpy.chain import Chain

from peers.protocol import Array, Solver, homogeneous
from problems import Problem


class Ikpy(Solver):
    """`Chain.inverse_kinematics_frame` with its default optimiser."""

    name = "ikpy"
    package = "ikpy"

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # ikpy warns that fixed links count as active by default
            self.chain = Chain.from_urdf_file(str(problem.urdf), base_elements=[problem.base])
        self.active = [link.joint_type != "fixed" for link in self.chain.links]
        self.chain.active_links_mask = np.array(self.active)
        self.mode = None if problem.orientations is None else "all"

    def targets(self) -> list[Any]:
        return list(homogeneous(self.problem))

    def start(self) -> Any:
        full = np.zeros(len(self.active))
        full[self.active] = self.problem.axis_start
        return full

    def solve(self, target: Any, start: Any) -> Any:
        return self.chain.inverse_kinematics_frame(target, initial_position=start, orientation_mode=self.mode)

    def angles(self, answers: list[Any]) -> Array:
        return self.problem.from_axes(np.array(answers)[:, self.active])
