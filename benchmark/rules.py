"""Compare the update rules: `python benchmark/rules.py` writes docs/update_rules.md."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import problems
from environment import machine, versions
from gaik_core import RULES, GradientDescent, Pose, Solution, UpdateRule, solve
from measure import interleave, judge
from problems import Problem

DOCS = Path(__file__).parent.parent / "docs"
MAX_ITERATIONS = 1000

HEAD = """# Update rules compared

`python benchmark/rules.py` writes this page. Every rule solves the same targets from the same start, by quaternions,
without restarts, with at most {most} updates; joint limits are held where the arm has any. Iterations are counted over
the targets solved: the median, and what 95 % of them stay within. Times are medians of {rounds} interleaved rounds over
all targets, the stuck ones included; "conformal" is the time by the other algebra over the time by quaternions, which
makes the same updates.

- Machine: {machine}
- Versions: {versions}

A step of a fixed size belongs to one arm: α of `GradientDescent`, `Momentum` and `Nesterov` is in rad²/m², so an arm
ten times smaller needs one about a hundred times larger. `GradientDescent("auto")`, the default, chooses it anew at
each update, and `Adam`, `AMSGrad` and `RMSProp` divide it out, so their α is in rad. `DampedLeastSquares` and
`LevenbergMarquardt` solve the linearised arm and need no α. A solve counts as stuck after a window of updates without
progress, which each rule states for itself.
"""


@dataclass(frozen=True)
class Row:
    """How one rule did on one problem: shares and counts; seconds per solve, per update, conformal over quaternion."""

    name: str
    solved: float
    median: float
    most: float
    seconds: float
    per_update: float
    conformal: float


def compared() -> dict[str, UpdateRule]:
    """Every rule with its default settings, and gradient descent with a fixed step."""
    rules: dict[str, UpdateRule] = {f"`{name}`": kind() for name, kind in RULES.items()}
    return {"`gradient_descent`, α = 0.5": GradientDescent(0.5), **rules}


def rows(problem: Problem, rules: dict[str, UpdateRule], rounds: int) -> list[Row]:
    """One row per rule."""
    ends = [_solve_all(problem, rule) for rule in rules.values()]
    tasks = [
        lambda rule=rule, algebra=algebra: _solve_all(problem, rule, algebra)
        for rule in rules.values()
        for algebra in ("quaternion", "conformal")
    ]
    for task in tasks:
        task()  # compiles
    seconds = interleave(tasks, rounds, problem.key).reshape(len(rules), 2, rounds)
    found = []
    for name, solutions, times in zip(rules, ends, seconds, strict=True):
        solved, _ = judge(problem, np.array([s.angles for s in solutions]))
        updates = np.array([s.iterations for s in solutions])
        each = float(np.median(times[0])) / len(solutions)
        found.append(
            Row(
                name=name,
                solved=float(solved.mean()),
                median=_quantile(updates[solved], 0.5),
                most=_quantile(updates[solved], 0.95),
                seconds=each,
                per_update=each / max(float(updates.mean()), 1e-9),
                conformal=float(np.median(times[1] / times[0])),
            )
        )
    return found


def _quantile(updates: NDArray[np.int64], share: float) -> float:
    return float(np.quantile(updates, share, method="higher")) if len(updates) else float("nan")


def _solve_all(problem: Problem, rule: UpdateRule, algebra: str = "quaternion") -> list[Solution]:
    options: dict[str, Any] = {
        "algebra": algebra,
        "rule": rule,
        "tolerance": problem.tolerance,
        "orientation_tolerance": problem.orientation_tolerance,
        "max_iterations": MAX_ITERATIONS,
    }
    turns = problem.orientations
    targets = problem.targets if turns is None else map(Pose, problem.targets, turns)
    return [solve(problem.chain, target, problem.start, **options) for target in targets]


def table(problem: Problem, found: Sequence[Row]) -> str:
    """The rows as Markdown."""
    lines = [
        f"## {problem.title}\n",
        "| rule | solved | iterations, median | 95 % | µs a solve | µs an iteration | conformal |",
        "| --- | ---: | ---: | ---: | ---: | ---: | ---: |",
    ]
    for row in found:
        counts = f"{row.median:.0f} | {row.most:.0f}" if row.solved else "- | -"
        lines.append(
            f"| {row.name} | {100 * row.solved:.1f} % | {counts} | {1e6 * row.seconds:.1f} | "
            f"{1e6 * row.per_update:.2f} | {row.conformal:.2f} |"
        )
    return "\n".join(lines) + "\n"


def main() -> int:
    """Compare, print, and write unless told not to."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5, help="rounds of each problem (default: 5)")
    parser.add_argument("--targets", type=int, default=200, help="targets of each problem (default: 200)")
    parser.add_argument("--output", type=Path, default=DOCS, help="folder of update_rules.md (default: docs)")
    parser.add_argument(
        "--no-write", dest="output", action="store_const", const=None, help="print the page only"
    )
    arguments = parser.parse_args()
    if arguments.rounds < 1 or arguments.targets < 1:
        parser.error("--rounds and --targets must be above 0")
    rules, count = compared(), arguments.targets
    tasks = [problems.table1().first(count), problems.panda_positions(count), problems.panda_poses(count)]
    head = HEAD.format(
        most=MAX_ITERATIONS,
        rounds=arguments.rounds,
        machine=machine(),
        versions=versions(["gaik_core", "numpy", "numba"]),
    )
    settings = "## Settings\n\n" + "\n".join(
        f"- {name}: `{rule!r}`, window {rule.window}" for name, rule in rules.items()
    )
    parts = [head, *(table(task, rows(task, rules, arguments.rounds)) for task in tasks), settings + "\n"]
    text = "\n".join(parts)
    print(text)
    if arguments.output:
        (arguments.output / "update_rules.md").write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
