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


class KdlOwnTypes(Solver):
    """`ChainIkSolverPos_LMA`, from a KDL frame and a KDL array to a KDL array."""

    name = "PyKDL, own types"
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
        return _to_kdl(self.problem.axis_start)

    def solve(self, target: Any, start: Any) -> Any:
        answer = kdl.JntArray(self.joints)
        self.solver.CartToJnt(start, target, answer)
        return answer

    def angles(self, answers: list[Any]) -> Array:
        return self.problem.from_axes(np.array([_from_kdl(answer) for answer in answers]))


class Kdl(KdlOwnTypes):
    """The same from NumPy to NumPy, as all others take their targets and give their answers."""

    name = "PyKDL"

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        turns = problem.orientations
        self.frame = _position_frame if turns is None else _pose_frame
        self.same_start = None if problem.warm else super().start()

    def targets(self) -> list[Any]:
        turns = self.problem.orientations
        if turns is None:
            return list(self.problem.targets)
        return list(zip(self.problem.targets, turns, strict=True))

    def start(self) -> Any:
        return self.problem.axis_start

    def solve(self, target: Any, start: Any) -> Any:
        begin = _to_kdl(start) if self.same_start is None else self.same_start
        answer = kdl.JntArray(self.joints)
        self.solver.CartToJnt(begin, self.frame(target), answer)
        return np.array(_from_kdl(answer))

    def angles(self, answers: list[Any]) -> Array:
        return self.problem.from_axes(np.array(answers))


def _position_frame(position: Array) -> Any:
    return kdl.Frame(kdl.Vector(*position.tolist()))


def _pose_frame(pose: tuple[Array, Array]) -> Any:
    position, (w, x, y, z) = pose[0], pose[1].tolist()
    return kdl.Frame(kdl.Rotation.Quaternion(x, y, z, w), kdl.Vector(*position.tolist()))


def _to_kdl(angles: Array) -> Any:
    joints = kdl.JntArray(len(angles))
    for joint, angle in enumerate(angles.tolist()):
        joints[joint] = angle
    return joints


def _from_kdl(joints: Any) -> list[float]:
    return [joints[i] for i in range(joints.rows())]


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
