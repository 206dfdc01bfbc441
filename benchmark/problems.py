"""The tasks: the same arm, targets, start and tolerance for everyone."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gaik_core import KinematicChain
from gaik_core.paths import Circle

Array = NDArray[np.float64]

ROBOTS = Path(__file__).parent / "robots"
RESTARTS = 20
"""How many other starts a solver that has restarts may try on the Panda."""
PANDA_READY = np.array([0.0, -np.pi / 4, 0.0, -3 * np.pi / 4, 0.0, np.pi / 2, np.pi / 4])
"""Franka's own ready pose."""


@dataclass(frozen=True, eq=False)
class Problem:
    """Targets for one arm.

    Attributes:
        key, title: its name and what it is.
        chain: the arm as gaik_core has it.
        urdf, base, tip: the arm as its peers get it: a plain series of joints, one for each axis of the chain.
        targets: (m, 3) positions (m).
        orientations: (m, 4) unit quaternions (w, x, y, z) for full poses; None where the orientation is free.
        start: (dof,) where each solve starts or, on a warm problem, the first.
        tolerance, orientation_tolerance: what a target counts as reached within (m, rad).
        warm: whether each solve starts from the answer before.
        restarts: how many other starts a solver that has restarts may try.
    """

    key: str
    title: str
    chain: KinematicChain
    urdf: Path
    base: str
    tip: str
    targets: Array
    start: Array
    tolerance: float
    orientations: Array | None = None
    orientation_tolerance: float = 1e-3
    warm: bool = False
    restarts: int = 0

    def __post_init__(self) -> None:
        """Refuse a URDF that is another arm than the chain."""
        peers = KinematicChain.from_urdf(self.urdf, self.base, self.tip)
        angles = np.linspace(-1.0, 1.0, 3 * self.chain.dof).reshape(3, -1)
        if not np.allclose(
            peers.forward(self.chain.axis_angles(angles)), self.chain.forward(angles), atol=1e-9
        ):
            raise ValueError(f"{self.urdf} is not the arm {self.chain.name!r}")

    @property
    def axis_start(self) -> Array:
        """(axes,) the start as the peers' joints have it."""
        return self.chain.axis_angles(self.start)

    def from_axes(self, axis_angles: Array) -> Array:
        """Joint values (…, dof) of the chain from the values (…, axes) of the peers' joints."""
        turned = np.atleast_2d(axis_angles) - self.chain.offset
        return np.linalg.solve(self.chain.coupling, turned.T).T

    def first(self, count: int) -> Problem:
        """The same problem with its first targets only."""
        orientations = None if self.orientations is None else self.orientations[:count]
        return replace(self, targets=self.targets[:count], orientations=orientations)


def fibonacci_sphere() -> Array:
    """The 200 points of Table 1's reproduction, (200, 3): a sphere of 0.2 m around [0.4, 0.6, 0]."""
    i = np.arange(200)
    z = 1 - (2 * i + 1) / 200
    azimuth = -np.pi * (3 - np.sqrt(5)) * (i + 0.5)
    across = np.sqrt(1 - z**2)
    points = np.stack([across * np.cos(azimuth), across * np.sin(azimuth), z], axis=-1)
    return np.array([0.4, 0.6, 0.0]) + 0.2 * points


def table1() -> Problem:
    """T1: the paper's Table 1."""
    chain = KinematicChain.load("arm3")
    return Problem(
        key="T1",
        title="3 joints, Table 1's 200 points, 5 mm",
        chain=chain,
        urdf=ROBOTS / "arm3.urdf",
        base="base",
        tip="tip",
        targets=fibonacci_sphere(),
        start=np.array([0.0, np.pi / 2, 0.0]),
        tolerance=5e-3,
    )


def panda_positions(count: int = 1000) -> Problem:
    """T2: positions of the Panda's flange at random angles inside the limits, from its ready pose."""
    return _panda("T2", f"Panda flange, {count} random positions, 1 mm", count, pose=False)


def panda_poses(count: int = 1000) -> Problem:
    """T2p: full poses of the Panda's flange at random angles inside the limits, from its ready pose."""
    return _panda("T2p", f"Panda flange, {count} random full poses, 1 mm and 1 mrad", count, pose=True)


def touch_circle() -> Problem:
    """T3: the Touch once around the demo's circle, each solve from the answer before."""
    chain = KinematicChain.load("touch")
    return Problem(
        key="T3",
        title="Touch along a circle of 126 points, warm, 0.1 mm",
        chain=chain,
        urdf=ROBOTS / "touch_serial.urdf",
        base="base",
        tip="tip",
        targets=Circle().points(126),
        start=np.array([0.0, 0.6, 0.6]),
        tolerance=1e-4,
        warm=True,
    )


def panda_batch(count: int = 100_000) -> Problem:
    """T4: as T2, many positions at once."""
    return _panda("T4", f"Panda flange, {count} positions at once, 1 mm", count, pose=False)


def _panda(key: str, title: str, count: int, pose: bool) -> Problem:
    urdf = ROBOTS / "panda.urdf"
    chain = KinematicChain.from_urdf(urdf)
    angles = np.random.default_rng(0).uniform(chain.lower, chain.upper, (count, chain.dof))
    positions, orientations = chain.pose(angles)
    return Problem(
        key=key,
        title=title,
        chain=chain,
        urdf=urdf,
        base="panda_link0",
        tip="panda_link8",
        targets=np.ascontiguousarray(positions),
        orientations=orientations if pose else None,
        start=PANDA_READY,
        tolerance=1e-3,
        restarts=RESTARTS,
    )
