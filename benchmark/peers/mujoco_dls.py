"""MuJoCo: damped least squares, a Python loop around its C kinematics."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from peers.protocol import MAX_ITERATIONS, Array, Solver
from problems import Problem

DAMPING = 1e-4

COMPILER = '<mujoco><compiler boundmass="1" boundinertia="1" fusestatic="false"/></mujoco></robot>'
"""Links without inertia get some, and the tip stays a body of its own."""


def load(problem: Problem) -> mujoco.MjModel:
    """MuJoCo's model of the problem's URDF."""
    return mujoco.MjModel.from_xml_string(problem.urdf.read_text().replace("</robot>", COMPILER))


class MujocoDls(Solver):
    """Full damped Gauss-Newton steps, clipped to the joint limits."""

    name = "MuJoCo DLS"
    package = "mujoco"

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        self.model = load(problem)
        self.data = mujoco.MjData(self.model)
        self.body = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_BODY, problem.tip)
        self.lower, self.upper = self.model.jnt_range.T
        self.rows = 3 if problem.orientations is None else 6
        self.jacobian = np.zeros((6, self.model.nv))
        self.damping = DAMPING * np.eye(self.rows)

    def targets(self) -> list[Any]:
        if self.problem.orientations is None:
            return [(position, None) for position in self.problem.targets]
        return list(zip(self.problem.targets, self.problem.orientations, strict=True))

    def start(self) -> Any:
        return self.problem.axis_start

    def solve(self, target: Any, start: Any) -> Any:
        model, data, body, jacobian = self.model, self.data, self.body, self.jacobian
        position, orientation = target
        tolerance, turn_tolerance = self.problem.tolerance, self.problem.orientation_tolerance
        rows, error, q = jacobian[: self.rows], np.zeros(self.rows), start
        back, difference = np.empty(4), np.empty(4)
        for _ in range(MAX_ITERATIONS):
            data.qpos[:] = q
            mujoco.mj_kinematics(model, data)
            mujoco.mj_comPos(model, data)
            error[:3] = position - data.xpos[body]
            reached = error[:3].dot(error[:3]) < tolerance * tolerance
            if orientation is not None:
                mujoco.mju_negQuat(back, data.xquat[body])
                mujoco.mju_mulQuat(difference, orientation, back)
                mujoco.mju_quat2Vel(error[3:], difference, 1.0)
                reached = reached and error[3:].dot(error[3:]) < turn_tolerance * turn_tolerance
            if reached:
                break
            mujoco.mj_jacBody(model, data, jacobian[:3], jacobian[3:], body)
            step = rows.T @ np.linalg.solve(rows @ rows.T + self.damping, error)
            q = np.minimum(np.maximum(q + step, self.lower), self.upper)
        return q

    def angles(self, answers: list[Any]) -> Array:
        return self.problem.from_axes(np.array(answers))
