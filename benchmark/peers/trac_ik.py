"""TRAC-IK by pytracik: KDL's Newton's method and a sequential quadratic programme, run side by side in C++."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytracik

from peers.protocol import Array, NotSolvableError, Solver
from problems import Problem

TIMEOUT = 0.005
"""TRAC-IK's own default (s)."""


class TracIk(Solver):
    """`TRAC_IK.CartToJnt` in its mode Speed."""

    name = "TRAC-IK"
    package = "pytracik"

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        if problem.orientations is None:
            raise NotSolvableError("its Python binding takes full poses only")
        # each component of the error has to be within this, so that their norms are within the tolerances
        epsilon = min(problem.tolerance, problem.orientation_tolerance) / math.sqrt(3.0)
        self.solver = pytracik.TRAC_IK(
            problem.base, problem.tip, problem.urdf.read_text(), TIMEOUT, epsilon, pytracik.SolveType.Speed
        )

    def targets(self) -> list[Any]:
        assert self.problem.orientations is not None
        w, x, y, z = self.problem.orientations.T
        return np.column_stack([self.problem.targets, x, y, z, w]).tolist()

    def start(self) -> Any:
        return self.problem.axis_start

    def solve(self, target: Any, start: Any) -> Any:
        return pytracik.ik(self.solver, start, *target)

    def angles(self, answers: list[Any]) -> Array:
        """An answer without a status of success, which is its first number, is taken for the start."""
        joints = len(self.problem.axis_start)
        found = [a[-joints:] if len(a) > joints and a[0] >= 0 else self.problem.axis_start for a in answers]
        return self.problem.from_axes(np.array(found))
