"""What the running nodes say of themselves: the robot, the limits and timeouts that they promise to keep."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gaik_core import KinematicChain
from gaik_ros import ik_node, pid_controller
from gaik_ros.faults.fault import StageError
from gaik_ros.faults.remote import Remote
from gaik_ros.parameters import Parameter, ParameterSet

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Facts:
    """The promises of one suite in numbers, and three postures of its robot, each (dof,) rad and inside the limits."""

    chain: KinematicChain
    speed_limit: Array  # (dof,) rad/s of the joint reference
    effort_min: Array  # (dof,) N·m
    effort_max: Array  # (dof,) N·m
    reference_period: float  # s
    setpoint_timeout: float  # s
    setpoint_bound: float  # m
    reference_timeout: float  # s
    state_timeout: float  # s
    approach_speed: float  # rad/s
    home: Array  # where every fault begins
    away: Array  # where the arm goes to and fro
    far: Array  # far enough from home to saturate the controller


def read_facts(remote: Remote, patience: float) -> Facts:
    """Ask ik_node and pid_controller. StageError: one of them is not there within `patience` s."""
    ik = _values(remote, "ik_node", ik_node.TABLE.parameters, patience)
    chain = KinematicChain.load(ik.robot)
    names = chain.joint_names
    pid = _values(remote, "pid_controller", pid_controller.TABLE.for_joints(names).parameters, patience)
    gains = pid_controller.gains_of(pid, names)
    home = posture(chain, 0.0)
    return Facts(
        chain=chain,
        speed_limit=np.array(ik.per_joint("max_joint_speed", names)),
        effort_min=np.broadcast_to(gains.output_min, (chain.dof,)),
        effort_max=np.broadcast_to(gains.output_max, (chain.dof,)),
        reference_period=1.0 / ik.rate,
        setpoint_timeout=ik.setpoint_timeout,
        setpoint_bound=ik.setpoint_bound,
        reference_timeout=pid.reference_timeout,
        state_timeout=pid.state_timeout,
        approach_speed=pid.approach_speed,
        home=home,
        away=posture(chain, 0.4),
        far=posture(chain, 0.75),
    )


def _values(remote: Remote, node: str, rows: Iterable[Parameter], patience: float) -> ParameterSet:
    table: dict[str, Parameter] = {row.name: row for row in rows}
    try:
        held: dict[str, Any] = remote.parameters(node, table, patience)
    except StageError as error:
        raise StageError(
            f"{error}: is a suite running in this namespace? --start-suite starts one"
        ) from error
    return ParameterSet({name: row.convert(held[name]) for name, row in table.items()})


def posture(chain: KinematicChain, turn: float) -> Array:
    """Angles (dof,) rad with each joint turned by up to `turn` rad from home, away from the nearer limit."""
    upward = chain.upper - chain.home >= chain.home - chain.lower
    direction = np.where(upward, 1.0, -1.0)
    for share in np.linspace(1.0, 0.0, 21):
        angles = np.asarray(chain.home + share * turn * direction)
        if admissible(chain, angles):
            return angles
    return np.array(chain.home)


def admissible(chain: KinematicChain, angles: Array, tolerance: float = 1e-9) -> bool:
    """Whether `angles` (dof,) or (n, dof) rad keep all limits of joints and axes."""
    axes = angles @ chain.coupling.T + chain.offset
    return bool(
        (angles >= chain.lower - tolerance).all()
        and (angles <= chain.upper + tolerance).all()
        and (axes >= chain.axis_lower - tolerance).all()
        and (axes <= chain.axis_upper + tolerance).all()
    )
