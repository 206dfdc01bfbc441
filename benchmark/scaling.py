"""Time per iteration for arms of 2 to 64 joints."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gaik_core import ALGEBRAS, Adam, Joint, KinematicChain, LevenbergMarquardt, UpdateRule, solve
from measure import interleave

JOINTS = (2, 4, 8, 16, 32, 64)
REPEATS = 20
RULES: tuple[tuple[UpdateRule, int], ...] = ((Adam(1e-4), 60), (LevenbergMarquardt(), 8))
"""With how many updates to make of each: fewer than its window, so that no solve stops early by stagnation."""


@dataclass(frozen=True)
class Scaling:
    """Seconds (joints, names) per iteration."""

    joints: tuple[int, ...]
    names: list[str]
    seconds: NDArray[np.float64]


def measure_scaling(rounds: int) -> Scaling:
    """The paper's rule and the fastest, by both algebras.

    Of each solve that makes no update the time is taken away; the fastest of the rounds counts, as anything else the
    machine does only adds.
    """
    columns = [(rule, updates, algebra) for rule, updates in RULES for algebra in ALGEBRAS]
    tasks = [
        _task(serial_arm(joints), algebra, rule, most)
        for joints in JOINTS
        for rule, updates, algebra in columns
        for most in (updates, 0)
    ]
    fastest = interleave(tasks, rounds, "joints").min(axis=1).reshape(len(JOINTS), len(columns), 2)
    updates = np.array([updates for _, updates, _ in columns])
    names = [f"{type(rule).__name__}, {algebra}" for rule, _, algebra in columns]
    return Scaling(JOINTS, names, (fastest[..., 0] - fastest[..., 1]) / (REPEATS * updates))


def serial_arm(joints: int) -> KinematicChain:
    """An arm of 1 m whose axes point along z and y in turn."""
    axes = ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0))
    link = (1.0 / joints, 0.0, 0.0)
    return KinematicChain([Joint(f"joint{i}", axes[i % 2], link) for i in range(joints)], name=f"arm{joints}")


def _task(chain: KinematicChain, algebra: str, rule: UpdateRule, updates: int) -> Callable[[], object]:
    """Solves that make exactly so many updates each: the tolerance is out of reach."""
    start = np.full(chain.dof, 0.3)
    target = 0.7 * chain.forward(np.full(chain.dof, -0.5))
    options: dict[str, Any] = {
        "algebra": algebra,
        "rule": rule,
        "tolerance": 1e-300,
        "max_iterations": updates,
    }
    made = solve(chain, target, start, **options).iterations
    if made != updates:
        raise RuntimeError(f"{chain.name}: {made} iterations instead of {updates}")
    return lambda: [solve(chain, target, start, **options) for _ in range(REPEATS)]
