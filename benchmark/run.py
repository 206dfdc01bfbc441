"""Run the benchmark T1 to T5 against whatever peers are installed: `python benchmark/run.py --help`."""

from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path

import problems
from algebra import measure_algebra
from algebra_problem import algebra_problem
from batch import measure_batch
from measure import measure
from plots import plot_scaling, plot_tasks
from registry import BATCH_PEERS, OURS, PACKAGES, PEERS, Field, is_named, load
from report import Task, page
from scaling import measure_scaling

SINGLE = {
    "T1": problems.table1,
    "T2": problems.panda_positions,
    "T2p": problems.panda_poses,
    "T3": problems.touch_circle,
}
TASKS = (*SINGLE, "T4", "T5", "scaling")
DOCS = Path(__file__).parent.parent / "docs"


def main() -> int:
    """Measure, print the page, and write it with its pictures unless told not to."""
    arguments = _arguments()
    warnings.filterwarnings("ignore", module=r"(roboticstoolbox|ikpy|spatialmath|pink|mink|qpsolvers)(\..*)?")
    ours, peers = load(OURS), load(PEERS, arguments.peers)
    tasks = [_single(key, ours, peers, arguments) for key in SINGLE if key in arguments.tasks]
    missing = dict(peers.missing)
    if "T4" in arguments.tasks:
        problem = problems.panda_batch(arguments.batch)
        at_batch = load(BATCH_PEERS, arguments.peers)
        missing |= at_batch.missing
        results = measure_batch(problem, at_batch.classes, arguments.rounds)
        best = next(r.name for r in results if r.package == "gaik_core")
        tasks.append(Task("T4", problem.title, results, reference=best))
    if "T5" in arguments.tasks:
        packages = load(PACKAGES)
        missing |= packages.missing
        moved, multiplied = measure_algebra(algebra_problem(), packages.classes, arguments.rounds)
        tasks.append(Task("T5a", "motor · point · ~motor in G(4,1)", moved, reference="gaik"))
        tasks.append(Task("T5b", "full product of two multivectors of G(4,1)", multiplied, reference="gaik"))
    scaling = measure_scaling(arguments.rounds) if "scaling" in arguments.tasks else None
    text = page(tasks, scaling, missing, arguments.rounds, problems.RESTARTS)
    print(text)
    if arguments.output:
        images = arguments.output / "images"
        images.mkdir(parents=True, exist_ok=True)
        (arguments.output / "benchmarks.md").write_text(text)
        if tasks:
            plot_tasks(tasks, images / "benchmarks.png")
        if scaling is not None:
            plot_scaling(scaling, images / "scaling.png")
    return 0


def _single(key: str, ours: Field, peers: Field, arguments: argparse.Namespace) -> Task:
    problem = SINGLE[key]()
    if arguments.quick:
        problem = problem.first(100)
    results, refused = measure(problem, ours.classes + peers.classes, arguments.rounds, arguments.budget)
    return Task(key, problem.title, results, refused)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--tasks", nargs="+", choices=TASKS, default=list(TASKS), metavar="TASK", help=" ".join(TASKS)
    )
    parser.add_argument(
        "--peers", nargs="+", metavar="NAME", help="only peers whose name contains one of these"
    )
    parser.add_argument("--rounds", type=int, default=9, help="rounds of each task (default: 9)")
    parser.add_argument(
        "--budget", type=float, default=0.5, help="seconds a solver may take a round (default: 0.5)"
    )
    parser.add_argument("--batch", type=int, default=100_000, help="targets of T4 (default: 100000)")
    parser.add_argument("--quick", action="store_true", help="100 targets a task, 3 rounds, nothing written")
    parser.add_argument(
        "--output", type=Path, default=DOCS, help="folder of benchmarks.md and images (default: docs)"
    )
    parser.add_argument(
        "--no-write", dest="output", action="store_const", const=None, help="print the page only"
    )
    arguments = parser.parse_args()
    if arguments.rounds < 1 or arguments.budget <= 0 or arguments.batch < 1:
        parser.error("--rounds, --budget and --batch must be above 0")
    known = (*PEERS, *BATCH_PEERS)
    for word in arguments.peers or ():
        if not any(is_named(entry, word) for entry in known):
            names = ", ".join(" ".join(entry) for entry in known)
            parser.error(f"--peers: no peer's name contains {word!r}; the peers: {names}")
    if arguments.quick:
        arguments.rounds, arguments.budget, arguments.batch, arguments.output = 3, 0.1, 2000, None
    return arguments


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)  # 128 + SIGINT
