"""`gaik reproduce`: the paper's experiments as pictures, numbers and one page."""

from __future__ import annotations

import json
import os
import time
from argparse import ArgumentParser, Namespace
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gaik_core.cli.command import Command
from gaik_core.cli.terminal import BOLD, coloured, complain, print_json, progress
from gaik_core.errors import GaikError, UnknownNameError
from gaik_core.experiments import experiment_names, load_experiment

if TYPE_CHECKING:
    from gaik_core.experiments.page import Result

NUMBERS, PAGE, IMAGES = "reproduction.json", "reproduction.md", "images/paper"
DOTS_PER_INCH, SMALL_DOTS_PER_INCH = 150, 72


def configure(parser: ArgumentParser) -> None:
    """Its arguments."""
    names: Any = parser.add_argument(
        "experiments", nargs="*", metavar="EXPERIMENT", help="default: all of them"
    )
    names.completer = lambda **_: experiment_names()
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("out/paper"),
        metavar="DIR",
        help="for PNG and JSON (default: %(default)s)",
    )
    parser.add_argument(
        "--docs", type=Path, metavar="DIR", help=f"also write DIR/{PAGE}, with small pictures in DIR/{IMAGES}"
    )
    parser.add_argument("--list", action="store_true", help="list the experiments and leave")
    parser.add_argument("--json", action="store_true", help="print the numbers as JSON")


def run(arguments: Namespace) -> int:
    """Run the experiments asked for; 1 where one of them failed."""
    known = experiment_names()
    if arguments.list:
        print("\n".join(known))
        return 0
    names = list(dict.fromkeys(arguments.experiments)) or known
    for name in names:
        if name not in known:
            raise UnknownNameError("experiment", name, known)
    if arguments.docs is not None and arguments.experiments:
        raise GaikError("--docs writes the page of all experiments; leave their names out")
    began = time.monotonic()
    results = run_all(names, arguments.out)
    numbers = write_numbers(results, arguments.out / NUMBERS)
    if not arguments.experiments:
        write_page(results, arguments.out, "{}.png")
        if arguments.docs is not None:
            draw_all(results, arguments.docs / IMAGES, SMALL_DOTS_PER_INCH)
            write_page(results, arguments.docs, IMAGES + "/{}.png")
    if arguments.json:
        print_json(numbers)
    else:
        print_summary(results, arguments.out, time.monotonic() - began)
    return 0 if len(results) == len(names) else 1


def run_all(names: Sequence[str], out: Path) -> list[Result]:
    """Run and draw each experiment; one that cannot be run is said so and left out."""
    _need_matplotlib()
    out.mkdir(parents=True, exist_ok=True)
    results: list[Result] = []
    with progress(len(names), "experiment") as bar:
        for name in names:
            bar.set_description(name)
            try:
                experiment = load_experiment(name)
                results.append((experiment, experiment.run()))
                draw_all(results[-1:], out, DOTS_PER_INCH)
            except (GaikError, ImportError, RuntimeError) as error:
                bar.clear()
                complain(f"gaik reproduce: {name} was left out: {error}")
            bar.update()
    return results


def _need_matplotlib() -> None:
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise GaikError(
            "reproduce draws with matplotlib, which is not installed: pip install matplotlib"
        ) from None


def draw_all(results: Sequence[Result], folder: Path, dpi: int) -> None:
    """A PNG for each experiment that has a picture."""
    from gaik_core.experiments.drawing import save

    for experiment, findings in results:
        if findings.draw is not None:
            save(findings.draw, folder / f"{experiment.name}.png", dpi)


def write_numbers(results: Sequence[Result], file: Path) -> dict[str, Any]:
    """Add these experiments to the JSON file, in which others of an earlier run stay; return these."""
    from gaik_core.experiments.numbers import as_data

    numbers = {experiment.name: as_data(experiment, findings) for experiment, findings in results}
    try:
        before = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        before = {}
    kept = before if isinstance(before, dict) else {}
    write(file, json.dumps(kept | numbers, indent=1, ensure_ascii=False, allow_nan=False) + "\n")
    return numbers


def write_page(results: Sequence[Result], folder: Path, image: str) -> None:
    """The page beside its pictures, whose address has the experiment's name in the place of {}."""
    from gaik_core.experiments.page import page

    images = {
        experiment.name: image.format(experiment.name) for experiment, findings in results if findings.draw
    }
    write(folder / PAGE, page(results, images))


def write(file: Path, text: str) -> None:
    """Write a file whole or not at all."""
    file.parent.mkdir(parents=True, exist_ok=True)
    part = file.with_name(f".{file.name}.{os.getpid()}")
    part.write_text(text, encoding="utf-8")
    part.replace(file)


def print_summary(results: Sequence[Result], out: Path, seconds: float) -> None:
    """A line per experiment, and where all went."""
    from gaik_core.experiments.page import shown

    for experiment, findings in results:
        first = findings.comparisons[0]
        line = f"{coloured(experiment.name.ljust(9), BOLD)} {first.quantity}: {shown(first.quaternion, first.decimals)}"
        line += f" {first.unit}".rstrip()
        if first.printed is not None:
            line += f" (the paper: {shown(first.printed, first.decimals)})"
        if findings.iterates:
            line += f"; the algebras' iterates differ by {findings.gap:.0e} rad"
        print(line)
        for erratum in findings.errata:
            if not erratum.confirmed:
                complain(
                    f"gaik reproduce: the erratum of {erratum.where} was not confirmed: {erratum.measured}"
                )
    print(f"{len(results)} experiments in {seconds:.1f} s; pictures, {NUMBERS} and the rest in {out}")


COMMAND = Command(
    "run the paper's experiments: pictures, numbers, and ours beside what the paper prints",
    (
        "gaik reproduce",
        "gaik reproduce fig18",
        "gaik reproduce fig4 table1 --out /tmp/paper",
        "gaik reproduce --docs docs",
    ),
    configure,
    run,
)
