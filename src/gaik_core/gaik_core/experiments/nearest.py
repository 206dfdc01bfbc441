"""The paper's claim that descent ends at "the configuration closest to its initial condition" (3.4), measured.

Starts are drawn evenly over both turns of every joint, targets evenly over the disk the arm reaches. Angles are
never wrapped, so a solution counts with all its copies a whole turn away; how far a start is from a solution is
the Euclidean distance of their angles.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gaik_core.chain import KinematicChain
from gaik_core.experiments.both_algebras import joined, solve_both
from gaik_core.experiments.findings import Iterates
from gaik_core.update_rules import GradientDescent

Array = NDArray[np.float64]

SEED = 2
TOLERANCE = 1e-5  # m
RATE = 5.0  # rad²/m², small enough that the descent follows the gradient's field
SLACK = 1.01  # a descent that went no further than this times the nearest solution's distance ended there
ORIENTATIONS = 1440  # of the last link, over which the solutions of three joints are listed


class Nearest(NamedTuple):
    """How far descents went, and how far the nearest solution was.

    Attributes:
        went: (m,) distance from start to end over the angles (rad), of the descents that converged.
        nearest: (m,) distance from start to the nearest solution (rad).
        tried: how many descents were started.
        iterates: of all of them.
    """

    went: Array
    nearest: Array
    tried: int
    iterates: Iterates

    @property
    def share(self) -> float:
        """Share of the converged descents that ended at the nearest solution, to 1 %."""
        return float(np.mean(self.went <= SLACK * self.nearest))

    @property
    def detour(self) -> float:
        """Median of how many times further than the nearest solution the others went."""
        others = self.went > SLACK * self.nearest
        return float(np.median(self.went[others] / self.nearest[others])) if others.any() else 1.0


def measure_nearest(chain: KinematicChain, count: int) -> Nearest:
    """Descend `count` times on a planar arm of two or three joints."""
    random = np.random.default_rng(SEED)
    starts = random.uniform(-np.pi, np.pi, (count, chain.dof))
    bearing = random.uniform(-np.pi, np.pi, count)
    inner = 0.05 * chain.reach
    distance = np.sqrt(random.uniform(inner**2, (0.98 * chain.reach) ** 2, count))
    targets = np.stack([distance * np.cos(bearing), distance * np.sin(bearing), np.zeros(count)], axis=1)
    rule = GradientDescent(RATE)
    solves = [
        solve_both(chain, target, start, rule, TOLERANCE, 4000)
        for start, target in zip(starts, targets, strict=True)
    ]
    went, nearest = [], []
    for start, target, both in zip(starts, targets, solves, strict=True):
        if both.quaternion.converged:
            went.append(np.linalg.norm(both.quaternion.angles - start))
            nearest.append(distance_to_nearest(chain, target, start))
    return Nearest(np.array(went), np.array(nearest), count, joined(solves))


def distance_to_nearest(chain: KinematicChain, target: Array, start: Array) -> float:
    """How far the nearest of all solutions is from a start (rad)."""
    away = solutions(chain, target) - start
    away = (away + np.pi) % (2.0 * np.pi) - np.pi  # each joint turns the shorter way
    return float(np.linalg.norm(away, axis=1).min())


def solutions(chain: KinematicChain, target: Array) -> Array:
    """The solutions (k, dof) of a planar arm: both of two joints, by the law of cosines; of three, a dense sample."""
    lengths = [joint.link[0] for joint in chain.joints]
    if chain.dof == 2:
        return _two_links(lengths[0], lengths[1], target[None, :2])
    last = np.linspace(-np.pi, np.pi, ORIENTATIONS, endpoint=False)
    wrists = target[:2] - lengths[2] * np.stack([np.cos(last), np.sin(last)], axis=1)
    pairs = _two_links(lengths[0], lengths[1], wrists)
    third = np.tile(last, 2) - pairs.sum(axis=1)
    result: Array = np.concatenate([pairs, third[:, None]], axis=1)
    reached: Array = result[np.isfinite(result).all(axis=1)]
    return reached


def _two_links(l1: float, l2: float, points: Array) -> Array:
    """Both pairs of angles (2 m, 2) for points (m, 2); NaN where a point is out of reach."""
    cosine = ((points**2).sum(axis=1) - l1**2 - l2**2) / (2.0 * l1 * l2)
    with np.errstate(invalid="ignore"):
        bend = np.arccos(cosine)
    elbow = np.concatenate([bend, -bend])
    bearing = np.tile(np.arctan2(points[:, 1], points[:, 0]), 2)
    return np.stack([bearing - np.arctan2(l2 * np.sin(elbow), l1 + l2 * np.cos(elbow)), elbow], axis=1)
