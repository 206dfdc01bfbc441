"""Kinematic chains: forward kinematics and Jacobian, by either algebra."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gaik_core.checks import array_of, finite, finite_vector
from gaik_core.errors import GaikError, ShapeError, UnknownNameError
from gaik_core.joint import Joint
from gaik_core.kernels import kinematics as kernels
from gaik_core.kernels.limits import can_hold
from gaik_core.packing import pack, without_limits
from gaik_core.versors import Orientation, unit_quaternion

Array = NDArray[np.float64]
Algebra = Literal["quaternion", "conformal"]

ALGEBRAS: tuple[str, ...] = get_args(Algebra)
_ALGEBRA_CODE = {"quaternion": kernels.QUATERNION, "conformal": kernels.CONFORMAL}


def algebra_code(algebra: str) -> int:
    """The kernels' number of an algebra; raises UnknownNameError."""
    try:
        return _ALGEBRA_CODE[algebra]
    except (KeyError, TypeError):
        raise UnknownNameError("algebra", algebra, ALGEBRAS) from None


class KinematicChain:
    """A serial chain of revolute and prismatic joints; never changed after it is made.

    Angles are rad (m for prismatic joints), one for each joint that is not passive. The base frame is the frame of the
    robot file or of the URDF's base link.

    Attributes:
        name, description: what it is.
        joints: every axis from the base to the tip, passive ones too.
        dof: how many values the chain has.
        joint_names: (dof,) their names.
        lower, upper: (dof,) the limits of the values; infinite where there are none.
        home: (dof,) where a solve starts by default.
        axis_names, axis_lower, axis_upper: (axes,) of the angles about the axes.
        coupling, offset: (axes, dof) and (axes,): axis angles = coupling @ angles + offset.
        limited: whether any limit is finite.
        reach: no target further than this from the first axis can be reached (m); infinite with unbounded travel.
        packed, packed_without_limits: the arrays the compiled kernels take.
    """

    def __init__(
        self,
        joints: Sequence[Joint],
        *,
        name: str = "chain",
        description: str = "",
        origin: ArrayLike = (0.0, 0.0, 0.0),
        orientation: Orientation = (1.0, 0.0, 0.0, 0.0),
    ) -> None:
        """Build a chain from its joints.

        Args:
            joints: the axes from base to tip, as they stand when every angle is zero.
            name: of the robot.
            description: one line about it.
            origin: (3,) where the first axis stands in the base frame (m).
            orientation: of the tip frame when every angle is zero: (4,) quaternion (w, x, y, z), Quaternion or Rotor.

        Raises:
            GaikError: where the chain has no joint, two of one name, or a coupling to a joint it has not.
        """
        if isinstance(joints, Joint):
            raise GaikError(f"joints is the joint {joints.name!r} alone; expected a sequence of joints")
        self.joints = tuple(joints)
        active = _active(self.joints)
        self.name = name
        self.description = description
        self.dof = len(active)
        self.joint_names = tuple(joint.name for joint in active)
        self.axis_names = tuple(joint.name for joint in self.joints)
        turn = unit_quaternion("orientation", orientation)
        self.packed = pack(self.joints, finite_vector("origin", origin, 3), turn)
        self.packed_without_limits = without_limits(self.packed)
        axes, couplings, ends, limits, held = self.packed
        self.lower, self.upper = limits
        self.home = _frozen([joint.home for joint in active])
        self.axis_lower = _frozen([joint.axis_lower for joint in self.joints])
        self.axis_upper = _frozen([joint.axis_upper for joint in self.joints])
        coupling = np.zeros((len(self.joints), self.dof))
        for axis, joint, factor in couplings:
            coupling[int(axis), int(joint)] += factor
        self.coupling = _frozen(coupling)
        self.offset = axes[:, 10]
        self.limited = bool(np.isfinite(limits).any() or len(held))
        self.reach = float(ends[11])
        if len(held) and not can_hold(axes, couplings, limits, held, self.home.copy()):
            raise GaikError(
                f"{name}: no joint values are found within their limits that bring every axis within its axis_limits; "
                "give a home that does"
            )

    def __reduce__(self) -> tuple[Any, ...]:
        # Made anew where it is copied or sent to another process: arrays do not stay read-only on that way.
        ends = self.packed[2]
        made = partial(
            KinematicChain,
            name=self.name,
            description=self.description,
            origin=ends[:3].copy(),
            orientation=ends[6:10].copy(),
        )
        return made, (self.joints,)

    def __repr__(self) -> str:
        return f"KinematicChain({self.name!r}, joints={list(self.joint_names)})"

    @classmethod
    def load(cls, robot: str | Path) -> KinematicChain:
        """A robot shipped with gaik_core by its name, or one from a YAML file by its path.

        Raises:
            UnknownRobotError: it is neither; the message lists the robots shipped.
            RobotFileError: the file is malformed; the message names the key and what it may be.
        """
        from gaik_core.robot_file import load_robot  # the reader builds chains, so it imports this file

        return load_robot(robot)

    @classmethod
    def from_urdf(
        cls,
        text_or_path: str | Path,
        base: str | None = None,
        tip: str | None = None,
        name: str | None = None,
    ) -> KinematicChain:
        """The chain between two links of a URDF, given as text or path: see `gaik_core.urdf.chain_from_urdf`.

        Raises:
            UrdfError: what is wrong with it, in one line.
        """
        from gaik_core.urdf import chain_from_urdf  # the reader builds chains, so it imports this file

        return chain_from_urdf(text_or_path, base, tip, name)

    @staticmethod
    def names() -> list[str]:
        """The robots shipped with gaik_core."""
        from gaik_core.robot_file import robot_names

        return robot_names()

    def forward(self, angles: ArrayLike, algebra: str = "quaternion") -> Array:
        """Position of the tip (m): angles (dof,) give (3,), angles (m, dof) give (m, 3) (eqs. 23 and 54).

        Raises:
            ShapeError, NotFiniteError: angles that do not fit the chain.
            UnknownNameError: an algebra other than "quaternion" and "conformal".
        """
        return self._poses(angles, algebra)[..., :3]

    def pose(self, angles: ArrayLike, algebra: str = "quaternion") -> tuple[Array, Array]:
        """Position (…, 3) of the tip (m) and its orientation (…, 4) as a unit quaternion (w, x, y, z)."""
        result = self._poses(angles, algebra)
        return result[..., :3], result[..., 3:]

    def jacobian(self, angles: ArrayLike, algebra: str = "quaternion") -> Array:
        """Derivative of the tip's position by the angles, (3, dof) in m/rad, at angles (dof,) (eqs. 39 and 50)."""
        return self.geometric_jacobian(angles, algebra)[:3]

    def geometric_jacobian(self, angles: ArrayLike, algebra: str = "quaternion") -> Array:
        """Velocity (m/s) above angular velocity (rad/s) of the tip per joint's rate, (6, dof), in the base frame."""
        code = algebra_code(algebra)
        values = finite_vector("angles", angles, self.dof)
        n = len(self.joints)
        jacobian = np.empty((6, self.dof))
        axes, couplings, ends, _, _ = self.packed
        turned, columns, pose = np.empty(n), np.empty((n, 6)), np.empty(7)
        kernels.kinematics(code, axes, couplings, ends, values, turned, columns, pose, jacobian)
        return jacobian

    def axis_angles(self, angles: ArrayLike) -> Array:
        """Angles about the axes (…, axes) for joint values (…, dof): C θ + offset."""
        values = finite("angles", array_of("angles", angles))
        if values.ndim == 0 or values.shape[-1] != self.dof:
            raise ShapeError("angles", values.shape, f"(…, {self.dof})")
        result: Array = values @ self.coupling.T + self.offset
        return result

    def frames(self, angles: ArrayLike) -> Array:
        """Where each axis stands and, last, the tip: (axes + 1, 3) in m, for drawing the arm."""
        values = finite_vector("angles", angles, self.dof)
        points = np.empty((len(self.joints) + 1, 3))
        kernels.joint_positions(self.packed, values, points)
        return points

    def inverse_velocity(
        self,
        angles: ArrayLike,
        velocity: ArrayLike,
        algebra: str = "quaternion",
        damping: float | None = None,
    ) -> Array:
        """Joint rates (dof,) in rad/s that move the tip at `velocity` (3,) in m/s: see `gaik_core.velocity`."""
        from gaik_core.velocity import damped_pseudo_inverse

        wanted = finite_vector("velocity", velocity, 3)
        return damped_pseudo_inverse(self.jacobian(angles, algebra), damping) @ wanted

    def _poses(self, angles: ArrayLike, algebra: str) -> Array:
        """Poses (…, 7) of the tip."""
        code = algebra_code(algebra)
        values = finite("angles", array_of("angles", angles))
        if values.ndim not in (1, 2) or values.shape[-1] != self.dof:
            raise ShapeError("angles", np.shape(angles), f"({self.dof},) or (m, {self.dof})")
        many = values.reshape(-1, self.dof)
        result = np.empty((len(many), 7))
        kernels.poses(code, self.packed, many, result)
        return result.reshape((*values.shape[:-1], 7))


def no_chain(what: object) -> GaikError:
    """The error of a function that was given something else for a chain."""
    load = f"; load one with KinematicChain.load({what!r})" if isinstance(what, str) else ""
    return GaikError(f"chain is {what!r}; expected a KinematicChain{load}")


def _frozen(values: ArrayLike) -> Array:
    array = np.array(values, dtype=float)
    array.flags.writeable = False
    return array


def _active(joints: Sequence[Joint]) -> list[Joint]:
    """Those that have a value; GaikError: what of them makes no chain."""
    for joint in joints:
        if not isinstance(joint, Joint):
            raise GaikError(f"a joint is {joint!r}; expected a Joint")
    active = [joint for joint in joints if not joint.passive]
    _check_names(joints, [joint.name for joint in active])
    return active


def _check_names(joints: Sequence[Joint], active: Sequence[str]) -> None:
    if not active:
        raise GaikError("a chain needs at least one joint that is not passive; it has none")
    names = [joint.name for joint in joints]
    for name in names:
        if names.count(name) > 1:
            raise GaikError(f"two joints are called {name!r}; names must differ")
    for joint in joints:
        for other in joint.coupling:
            if other not in active:
                raise UnknownNameError(f"joint in the coupling of {joint.name!r}:", other, active)
        if joint.passive and not joint.coupling:
            raise GaikError(
                f"joint {joint.name!r} is passive without a coupling; give it one, or a value of its own"
            )
