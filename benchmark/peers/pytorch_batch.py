"""PyTorch Kinematics: damped least squares of many targets at once, on the processor."""

from __future__ import annotations

import math
from typing import Any

import pytorch_kinematics as pk
import torch

from peers.protocol import Array, Solver, homogeneous
from problems import Problem


class PytorchKinematics(Solver):
    """`PseudoInverseIK` as its documentation has it, from one start, its iterates kept inside the limits.

    Its one target is the whole batch.
    """

    name = "pytorch-kinematics"
    package = "pytorch-kinematics"
    at_once = True

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        chain = pk.build_serial_chain_from_urdf(problem.urdf.read_bytes(), problem.tip, problem.base)
        self.solver = pk.PseudoInverseIK(
            chain,
            pos_tolerance=problem.tolerance,
            rot_tolerance=math.inf,
            orientation_weight=0.0,
            retry_configs=torch.tensor(problem.axis_start, dtype=torch.float32)[None],
            early_stopping_any_converged=True,
            clamp_to_limits=problem.chain.limited,
        )

    def targets(self) -> list[Any]:
        return [homogeneous(self.problem)]

    def start(self) -> Any:
        return None  # the solver has it

    def solve(self, target: Any, start: Any) -> Any:
        poses = pk.Transform3d(matrix=torch.tensor(target, dtype=torch.float32))
        return self.solver.solve(poses).solutions[:, 0].numpy()

    def angles(self, answers: list[Any]) -> Array:
        return self.problem.from_axes(answers[0].astype(float))
