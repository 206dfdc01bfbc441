"""Orocos KDL: Levenberg-Marquardt in C++ (`apt install python3-pykdl`; no restarts, no joint limits)."""

from __future__ import annotations

import importlib
import importlib.util
import sys
from pathlib import Path
from typing import Any

import numpy as np
from urdf_parser_py.urdf import URDF

from peers.protocol import MAX_ITERATIONS, Array, NotSolvableError, Solver, homogeneous
from problems import Problem


def _import() -> Any:
    """PyKDL; from Debian's folder where a virtual environment of the same Python does not see it."""
    version = f"{sys.version_info.major}{sys.version_info.minor}"
    found = list(Path("/usr/lib/python3/dist-packages").glob(f"PyKDL.cpython-{version}-*.so"))
    if not found:
        return importlib.import_module("PyKDL")
    if np.lib.NumpyVersion(np.__version__) >= "2.0.0":
        raise ImportError("Debian's PyKDL was built for numpy < 2 and crashes with numpy " + np.__version__)
    spec = importlib.util.spec_from_file_location("PyKDL", found[0])
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


kdl = _import()


class Kdl(Solver):
    """`ChainIkSolverPos_LMA`."""

    name = "PyKDL"
    package = "PyKDL"

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        self.chain = _chain(problem)
        turns = 0.0 if problem.orientations is None else 1.0
        tolerance = problem.tolerance if not turns else min(problem.tolerance, problem.orientation_tolerance)
        weights = np.array([1.0, 1.0, 1.0, turns, turns, turns])
        self.solver = kdl.ChainIkSolverPos_LMA(self.chain, weights, tolerance, MAX_ITERATIONS)
        self.joints = self.chain.getNrOfJoints()

    def targets(self) -> list[Any]:
        return [
            kdl.Frame(kdl.Rotation(*matrix[:3, :3].ravel().tolist()), kdl.Vector(*matrix[:3, 3].tolist()))
            for matrix in homogeneous(self.problem)
        ]

    def start(self) -> Any:
        start = kdl.JntArray(self.joints)
        for joint, angle in enumerate(self.problem.axis_start):
            start[joint] = angle
        return start

    def solve(self, target: Any, start: Any) -> Any:
        answer = kdl.JntArray(self.joints)
        self.solver.CartToJnt(start, target, answer)
        return answer

    def angles(self, answers: list[Any]) -> Array:
        return self.problem.from_axes(
            np.array([[answer[i] for i in range(self.joints)] for answer in answers])
        )


def _chain(problem: Problem) -> Any:
    """KDL's chain from the URDF, as kdl_parser makes it."""
    robot = URDF.from_xml_file(str(problem.urdf))
    chain = kdl.Chain()
    for name in robot.get_chain(problem.base, problem.tip, links=False):
        joint = robot.joint_map[name]
        frame = kdl.Frame(kdl.Rotation.RPY(*joint.origin.rpy), kdl.Vector(*joint.origin.xyz))
        if joint.type == "fixed":
            moving = kdl.Joint(name, kdl.Joint.Fixed)
        elif joint.type == "revolute":
            axis = frame.M * kdl.Vector(*joint.axis)
            moving = kdl.Joint(name, frame.p, axis, kdl.Joint.RotAxis)
        else:
            raise NotSolvableError(f"joint {name!r} is {joint.type}")
        chain.addSegment(kdl.Segment(joint.child, moving, frame))
    return chain
