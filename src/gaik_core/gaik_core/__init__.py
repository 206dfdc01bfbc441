"""Geometric-algebra inverse kinematics: by quaternions and by conformal geometric algebra.

>>> from gaik_core import KinematicChain, solve
>>> touch = KinematicChain.load("touch")
>>> solution = solve(touch, [0.05, 0.05, 0.0], tolerance=1e-4)
>>> solution.converged
True
"""

from gaik_core.cga import Multivector
from gaik_core.chain import ALGEBRAS, KinematicChain
from gaik_core.errors import GaikError
from gaik_core.joint import Joint
from gaik_core.quaternion import Quaternion
from gaik_core.solution import Solution, Solutions, Status, Trace
from gaik_core.solver import solve, solve_batch, solve_path
from gaik_core.targets import Pointing, Pose
from gaik_core.update_rules import (
    RULES,
    Adam,
    AMSGrad,
    DampedLeastSquares,
    GradientDescent,
    LevenbergMarquardt,
    Momentum,
    Nesterov,
    RMSProp,
    UpdateRule,
    rule_by_name,
)
from gaik_core.velocity import gradient_velocity
from gaik_core.versors import Motor, Rotor, Translator

__version__ = "0.1.0"

__all__ = [
    "ALGEBRAS",
    "RULES",
    "AMSGrad",
    "Adam",
    "DampedLeastSquares",
    "GaikError",
    "GradientDescent",
    "Joint",
    "KinematicChain",
    "LevenbergMarquardt",
    "Momentum",
    "Motor",
    "Multivector",
    "Nesterov",
    "Pointing",
    "Pose",
    "Quaternion",
    "RMSProp",
    "Rotor",
    "Solution",
    "Solutions",
    "Status",
    "Trace",
    "Translator",
    "UpdateRule",
    "gradient_velocity",
    "rule_by_name",
    "solve",
    "solve_batch",
    "solve_path",
]
