"""Time per iteration for arms of 2 to 64 joints."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gaik_core import ALGEBRAS, Adam, Joint, KinematicChain, UpdateRule, solve
from measure import interleave

JOINTS = (2, 4, 8, 16, 32, 64)
ITERATIONS = 60
"""Fewer than any rule's window, so that no solve stops early by stagnation."""
REPEATS = 20


@dataclass(frozen=True)
class Scaling:
    """Seconds (joints, names) per iteration."""

    joints: tuple[int, ...]
    names: list[str]
    seconds: NDArray[np.float64]


def measure_scaling(rounds: int) -> Scaling:
    """Both algebras, the paper's rule."""
    columns = [(algebra, Adam(1e-4)) for algebra in ALGEBRAS]
    tasks = [_task(serial_arm(n), algebra, rule) for n in JOINTS for algebra, rule in columns]
    seconds = np.median(interleave(tasks, rounds, "joints"), axis=1) / (ITERATIONS * REPEATS)
    names = [f"{type(rule).__name__}, {algebra}" for algebra, rule in columns]
    return Scaling(JOINTS, names, seconds.reshape(len(JOINTS), -1))


def serial_arm(joints: int) -> KinematicChain:
    """An arm of 1 m whose axes point along z and y in turn."""
    axes = ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0))
    link = (1.0 / joints, 0.0, 0.0)
    return KinematicChain([Joint(f"joint{i}", axes[i % 2], link) for i in range(joints)], name=f"arm{joints}")


def _task(chain: KinematicChain, algebra: str, rule: UpdateRule) -> Callable[[], object]:
    """Solves that make exactly ITERATIONS updates each: the steps are too short to arrive."""
    start = np.full(chain.dof, 0.3)
    target = -chain.forward(start)
    options: dict[str, Any] = {
        "algebra": algebra,
        "rule": rule,
        "tolerance": 1e-9,
        "max_iterations": ITERATIONS,
    }
    made = solve(chain, target, start, **options).iterations
    if made != ITERATIONS:
        raise RuntimeError(f"{chain.name}: {made} iterations instead of {ITERATIONS}")
    return lambda: [solve(chain, target, start, **options) for _ in range(REPEATS)]
