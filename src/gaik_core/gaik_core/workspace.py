"""The reachable workspace of a chain: which cells of a grid have a centre that the tip can be brought to.

Joint values drawn at random say roughly where the tip comes. Then each cell's centre is solved for from the values of a
sample in it or of a neighbour that is reached, and so on outwards until no neighbour is left. A random sample alone
would miss the outer shell of an arm of many joints, where values seldom lead.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gaik_core.chain import KinematicChain, no_chain
from gaik_core.checks import count
from gaik_core.errors import GaikError
from gaik_core.solver import solve_batch
from gaik_core.update_rules import LevenbergMarquardt

Array = NDArray[np.float64]
Cells = NDArray[np.int64]

FREE = np.pi  # rad: how far a joint without a limit is turned to either side
MARGIN = 0.15  # of the longest side: how far beyond the samples is looked
TRIES = 4  # solves for one centre, each from another neighbour
CHUNK = 8192  # solves between two looks at whether to carry on
CLOSE = 1e-3  # cells: a centre is reached within this
UPDATES = 60  # of one solve: from a neighbour it is near, or not to be had
RESTARTS = 20  # of a centre that most of its neighbours surround
SURROUNDED = 4 / 3  # neighbours for each direction: four of six in space, three of four in a plane
FLAT = 1e-9  # of the longest side: less is none
PROBES = 64  # poses at which the dimension is looked for

SIDES: Cells = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])


@dataclass(frozen=True)
class Workspace:
    """What is reachable.

    Attributes:
        dimension: 3, or less where the tip only moves on a surface (2) or a curve (1).
        corner, cell: the grid's lower corner (3,) and the side of a cell, in m.
        reached: (i, j, k) whether the tip can be at a cell's centre; one layer in a direction that it never moves in.
        tips: (n, 3) the sampled positions and the centres reached, in m.
        anchor: (3,) where the first axis stands, from which distances count.
        complete: whether no neighbour was left to try.
    """

    dimension: int
    corner: Array
    cell: float
    reached: NDArray[np.bool_]
    tips: Array
    anchor: Array
    complete: bool

    @property
    def size(self) -> float:
        """The volume in m³, or the area in m² of a plane workspace; 0 of one that fills neither."""
        thick = [count > 1 for count in self.reached.shape]
        return float(self.reached.sum() * self.cell ** sum(thick)) if sum(thick) == self.dimension else 0.0

    @property
    def lower(self) -> Array:
        """The lower corner (3,) m of the box around it."""
        return np.asarray(self.tips.min(axis=0))

    @property
    def upper(self) -> Array:
        """The upper corner (3,) m of the box around it."""
        return np.asarray(self.tips.max(axis=0))

    @cached_property
    def _distances(self) -> Array:
        return np.asarray(np.linalg.norm(self.tips - self.anchor, axis=1))

    @property
    def nearest(self) -> float:
        """The shortest distance of the tip from the first axis's place, in m."""
        return float(self._distances.min())

    @property
    def farthest(self) -> float:
        """The longest distance of the tip from the first axis's place, in m."""
        return float(self._distances.max())


def find_workspace(
    chain: KinematicChain,
    cells: int = 64,
    samples: int = 200_000,
    seed: int = 0,
    carry_on: Callable[[int, int], bool] = lambda done, waiting: True,
) -> Workspace:
    """Find the workspace of a chain within its limits; a joint without one is turned by half a turn to either side.

    Args:
        chain: the arm.
        cells: along the longest side of the box around the samples.
        samples: joint values drawn at random, evenly over each joint's range.
        seed: of the draw; the same gives the same workspace.
        carry_on: is told how many centres have been tried and how many wait; False ends the search where it is.

    Raises:
        GaikError: a number that is too small, or a joint that slides without a limit.
    """
    if not isinstance(chain, KinematicChain):
        raise no_chain(chain)
    for what, value, least in (("cells", cells, 4), ("samples", samples, 100)):
        if value < least:
            raise GaikError(f"{what} is {value}; it may be {least} or more")
    values = sample_joints(chain, samples, count("seed", seed))
    tips = chain.forward(values)
    extent = np.ptp(tips, axis=0)
    thick = extent > FLAT * max(float(extent.max()), FLAT)
    dimension = _dimension(chain, values[:PROBES])
    anchor = chain.frames(chain.home)[0]
    if dimension == 0:
        return Workspace(0, tips[0], 0.0, np.ones((1, 1, 1), dtype=bool), tips[:1], anchor, True)
    cell = float(extent.max()) / cells
    pad = np.where(thick, np.ceil(MARGIN * cells), 0.0)
    corner = np.where(thick, tips.min(axis=0) - pad * cell, tips[0] - 0.5 * cell)
    shape = tuple(int(n) for n in np.where(thick, np.ceil(extent / cell) + 2.0 * pad, 1.0))
    search = _Search(chain, corner, cell, shape)
    complete = True
    if dimension == int(thick.sum()):
        complete = search.spread(tips, values, carry_on)
        tips = np.concatenate([tips, search.centres(np.argwhere(search.reached))])
    return Workspace(dimension, corner, cell, search.reached, tips, anchor, complete)


def sample_joints(chain: KinematicChain, count: int, seed: int) -> Array:
    """Joint values (n, dof) within all limits, n at most `count`. GaikError: a joint slides without a limit."""
    lower = np.where(np.isfinite(chain.lower), chain.lower, chain.home - FREE)
    upper = np.where(np.isfinite(chain.upper), chain.upper, chain.home + FREE)
    kinds = {joint.name: joint.kind for joint in chain.joints}
    for name, low, high in zip(chain.joint_names, chain.lower, chain.upper, strict=True):
        if kinds[name] == "prismatic" and not (np.isfinite(low) and np.isfinite(high)):
            raise GaikError(f"joint {name!r} slides without a limit: the workspace has no end")
    values = lower + (upper - lower) * np.random.default_rng(seed).random((count, chain.dof))
    values[0] = chain.home
    turned = chain.axis_angles(values)
    return values[((turned >= chain.axis_lower) & (turned <= chain.axis_upper)).all(axis=1)]


def _dimension(chain: KinematicChain, values: Array) -> int:
    """How many directions the tip moves in, at the most."""
    singular = [np.linalg.svd(chain.jacobian(angles), compute_uv=False) for angles in values]
    return max(int((found > 1e-9 * max(found[0], 1e-12)).sum()) for found in singular)


class _Search:
    """The spreading over the grid: which centres are reached, and by which joint values."""

    def __init__(self, chain: KinematicChain, corner: Array, cell: float, shape: tuple[int, ...]) -> None:
        self._chain, self._corner, self._cell = chain, corner, cell
        self.reached = np.zeros(shape, dtype=bool)
        self._tries = np.zeros(shape, dtype=np.int64)
        self._values = np.zeros((*shape, chain.dof))

    def centres(self, cells: Cells) -> Array:
        """The centres (n, 3) m of cells (n, 3)."""
        return self._corner + (cells + 0.5) * self._cell

    def spread(self, tips: Array, values: Array, carry_on: Callable[[int, int], bool]) -> bool:
        """Begin in the cells of the samples, go on to neighbours; return whether none was left."""
        inside = np.floor((tips - self._corner) / self._cell).astype(np.int64)
        inside = np.clip(inside, 0, np.array(self.reached.shape) - 1)
        cells, first = np.unique(inside, axis=0, return_index=True)
        starts = values[first]
        done = 0
        while len(cells):
            fresh = []
            for begin in range(0, len(cells), CHUNK):
                part = slice(begin, begin + CHUNK)
                fresh.append(self._solve(cells[part], starts[part]))
                done += len(cells[part])
                if not carry_on(done, len(cells) - begin - len(cells[part])):
                    return False
            cells, starts = self._neighbours(np.concatenate(fresh))
        self._fill_gaps()
        return True

    def _fill_gaps(self) -> None:
        """Try the cells that most of their neighbours surround once more, from starts of all kinds.

        A joint limit can hold every neighbour's solution off a centre that another posture reaches.
        """
        missed = np.argwhere((self._tries > 0) & ~self.reached)
        padded = np.pad(self.reached, 1)
        around = sum(padded[tuple((missed + side + 1).T)].astype(int) for side in SIDES)
        missed = missed[around >= SURROUNDED * np.count_nonzero(np.array(self.reached.shape) > 1)]
        if len(missed):
            self._solve(missed, np.repeat(self._chain.home[None], len(missed), axis=0), restarts=RESTARTS)

    def _solve(self, cells: Cells, starts: Array, restarts: int = 0) -> Cells:
        """Try centres from joint values; return the cells that are reached."""
        solved = solve_batch(
            self._chain,
            self.centres(cells),
            starts,
            rule=LevenbergMarquardt(),
            tolerance=CLOSE * self._cell,
            max_iterations=UPDATES,
            restarts=restarts,
        )
        fresh = cells[solved.converged]
        self._tries[tuple(cells.T)] += 1
        self.reached[tuple(fresh.T)] = True
        self._values[tuple(fresh.T)] = solved.angles[solved.converged]
        return fresh

    def _neighbours(self, fresh: Cells) -> tuple[Cells, Array]:
        """The cells beside `fresh` that are worth a try, each once, with joint values to start from."""
        beside = (fresh[:, None] + SIDES).reshape(-1, 3)
        starts = np.repeat(self._values[tuple(fresh.T)], len(SIDES), axis=0)
        inside = ((beside >= 0) & (beside < self.reached.shape)).all(axis=1)
        beside, starts = beside[inside], starts[inside]
        where = tuple(beside.T)
        worth = ~self.reached[where] & (self._tries[where] < TRIES)
        cells, first = np.unique(beside[worth], axis=0, return_index=True)
        return cells, starts[worth][first]
