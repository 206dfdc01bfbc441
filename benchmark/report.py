"""The page docs/benchmarks.md."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from aims import Aim, aims
from environment import machine, versions
from measure import Result
from registry import version_of
from scaling import Scaling

HEAD = """# Benchmarks

`make bench` writes this page. Everything runs in one process, in turn, round by round; a ratio is the median over the
rounds of the times measured side by side. A turn that is shorter than 0.1 s is first rehearsed and then repeated to
fill them, so that each is timed in a loop of its own. Each solver gets the same arm, targets, start and tolerance.
Success is counted by gaik's forward kinematics of its answers, and "inside limits" by the robot's joint limits,
whatever the solver itself reports.

A solve goes from NumPy to NumPy: a target as an array, or a pose as the solver's documentation has it, and the joints
as an array. gaik is timed so through its public functions with all their checks. Of the peers only PyKDL wants types of
its own; a second row gives its time without the conversions, and counts for no aim. A solver that has restarts may try
{restarts} of them on the Panda; nobody has any on T1 and T3. The loops of Pinocchio, MuJoCo, mink and pink are those of
their own examples with full steps, in Python. PyTorch Kinematics is given all its targets at once, in the 32 bits it
prefers, and the one start.

- Machine: {machine}
- Versions: {versions}
- Rounds: {rounds}

To run it again: `make bench`. It makes an environment of its own under `out/bench`, of every peer that pip can install
there. PyKDL is not on PyPI; on Debian and Ubuntu it is `apt install python3-pykdl`, built for numpy before 2, and is
found from an environment of the system's version of Python. PyTorch is left to whoever wants to download it:
`out/bench/bin/pip install torch pytorch-kinematics==0.10.0`.
"""


@dataclass
class Task:
    """One task's results.

    Attributes:
        key, title: of the task.
        results: of everyone, the fastest first.
        refused: who could not take part, and why.
        reference: whose time is 1 in the column of ratios.
    """

    key: str
    title: str
    results: Sequence[Result]
    refused: dict[str, str] = field(default_factory=dict)
    reference: str = "gaik LM"


def page(
    tasks: Sequence[Task], scaling: Scaling | None, missing: dict[str, str], rounds: int, restarts: int
) -> str:
    """The whole page as Markdown."""
    used = sorted({result.package for task in tasks for result in task.results})
    listed = ", ".join(f"{package} {version_of(package)}" for package in used)
    head = HEAD.format(
        machine=machine(),
        versions=f"{listed}, {versions(['numpy', 'numba'])}",
        rounds=rounds,
        restarts=restarts,
    )
    parts = [head, _absent(missing), "![Times of all solvers](images/benchmarks.png)\n"]
    parts += [_table(task) for task in tasks]
    if scaling is not None:
        parts.append(_scaling(scaling))
    parts += [_aims(tasks), _losses(tasks)]
    return "\n".join(part for part in parts if part)


def _absent(missing: dict[str, str]) -> str:
    if not missing:
        return ""
    return "Not installed, so not measured:\n\n" + "".join(
        f"- {name}: {why}\n" for name, why in missing.items()
    )


def _table(task: Task) -> str:
    """A row for each solver; bold is gaik."""
    reference = next((r for r in task.results if r.name == task.reference), task.results[0])
    unit = "targets/s" if task.key == "T4" else "µs each"
    algebra = task.key.startswith("T5")
    checks = ("right", "operands") if algebra else ("solved", "inside limits", "targets")
    lines = [
        f"## {task.key}: {task.title}\n",
        f"| solver | {unit} | × {reference.name} | {' | '.join(checks)} |",
        "| --- | ---: | ---: |" + " ---: |" * len(checks),
    ]
    for r in task.results:
        cells = [f"**{r.name}**" if r.package == "gaik_core" else r.name, _speed(task.key, r)]
        cells += [f"{r.ratio(reference):.2f}", f"{100 * r.solved:.1f} %"]
        cells += [str(r.targets)] if algebra else [f"{100 * r.inside:.1f} %", str(r.targets)]
        lines.append(f"| {' | '.join(cells)} |")
    lines += [f"\nNot measured: {name}: {why}." for name, why in task.refused.items()]
    return "\n".join(lines) + "\n"


def _speed(key: str, result: Result) -> str:
    if key == "T4":
        return f"{1 / result.median:,.0f}".replace(",", " ")
    return f"{1e6 * result.median:.1f}"


def _scaling(scaling: Scaling) -> str:
    lines = [
        "## Time per iteration over the number of joints\n",
        "Serial arms of revolute joints with axes across each other; µs per iteration, the fastest of the rounds.\n",
        "| joints | " + " | ".join(scaling.names) + " |",
        "| ---: |" + " ---: |" * len(scaling.names),
    ]
    for joints, times in zip(scaling.joints, scaling.seconds, strict=True):
        lines.append(f"| {joints} | " + " | ".join(f"{1e6 * time:.2f}" for time in times) + " |")
    lines.append("\n![Time per iteration](images/scaling.png)\n")
    return "\n".join(lines)


def _aims(tasks: Sequence[Task]) -> str:
    found: list[Aim] = [aim for task in tasks for aim in aims(task.key, task.results)]
    lines = ["## Aims\n", "| aim | measured | met |", "| --- | --- | --- |"]
    lines += [f"| {aim.text} | {aim.measured} | {'yes' if aim.met else '**no**'} |" for aim in found]
    return "\n".join(lines) + "\n"


def _losses(tasks: Sequence[Task]) -> str:
    """Every peer that was faster than the reference, or that solved more."""
    lines = []
    for task in tasks:
        ours = next((r for r in task.results if r.name == task.reference), None)
        for r in task.results:
            if ours is None or r.package == "gaik_core":
                continue
            if r.ratio(ours) < 1.0:
                lines.append(f"- {task.key}: {r.name} is faster: {r.ratio(ours):.2f} of {ours.name}'s time.")
            if r.solved > ours.solved:
                lines.append(
                    f"- {task.key}: {r.name} solves more: {100 * r.solved:.1f} % against {100 * ours.solved:.1f} %."
                )
    return "## Where gaik loses\n\n" + ("\n".join(lines) if lines else "Nowhere in this run.") + "\n"
