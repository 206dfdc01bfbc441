"""`gaik workspace`: what an arm can reach, as numbers and as a picture."""

from __future__ import annotations

import time
from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gaik_core.cli.command import Command
from gaik_core.cli.robot import add_robot, load_robot
from gaik_core.cli.terminal import BOLD, coloured, complain, print_json, print_table, progress
from gaik_core.errors import GaikError

if TYPE_CHECKING:
    from gaik_core.chain import KinematicChain
    from gaik_core.workspace import Workspace


def configure(parser: ArgumentParser) -> None:
    """Its arguments."""
    add_robot(parser)
    parser.add_argument(
        "--cells",
        type=int,
        default=64,
        metavar="N",
        help="cells along the longest side (default: %(default)s)",
    )
    parser.add_argument(
        "--samples", type=int, default=200_000, metavar="N", help="poses to begin with (default: %(default)s)"
    )
    parser.add_argument(
        "--seed", type=int, default=0, metavar="N", help="of the poses (default: %(default)s)"
    )
    parser.add_argument(
        "--seconds", type=float, default=30.0, metavar="S", help="stop then (default: %(default)g s)"
    )
    parser.add_argument(
        "--at",
        nargs=3,
        type=float,
        metavar=("X", "Y", "Z"),
        help="where the sections cut (m; default: the middle)",
    )
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("out/workspace"),
        metavar="DIR",
        help="for the PNG (default: %(default)s)",
    )
    parser.add_argument("--no-picture", action="store_true", help="the numbers alone")
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(arguments: Namespace) -> int:
    """Find it, draw it, and print the numbers; 1 where the time did not suffice."""
    chain = load_robot(arguments)
    began = time.monotonic()
    workspace = find(chain, arguments)
    data = as_data(chain, workspace, arguments)
    file = None if arguments.no_picture else draw(chain, workspace, arguments)
    data["picture"] = None if file is None else str(file)
    if not workspace.complete:
        complain(
            f"gaik workspace: not complete after {arguments.seconds:g} s, what is told is a part; --seconds gives more"
        )
    if arguments.json:
        print_json(data)
    else:
        print_numbers(chain, data, time.monotonic() - began)
    return 0 if workspace.complete else 1


def find(chain: KinematicChain, arguments: Namespace) -> Workspace:
    """The workspace, with a bar of the centres tried."""
    from gaik_core.workspace import find_workspace

    if not arguments.seconds > 0.0:
        raise GaikError(f"--seconds is {arguments.seconds:g}; it may be above 0")
    end = time.monotonic() + arguments.seconds
    with progress(0, "cell") as bar:

        def carry_on(done: int, waiting: int) -> bool:
            bar.total = done + waiting
            bar.update(done - bar.n)
            return bool(time.monotonic() < end)

        return find_workspace(chain, arguments.cells, arguments.samples, arguments.seed, carry_on)


def as_data(chain: KinematicChain, workspace: Workspace, arguments: Namespace) -> dict[str, Any]:
    """The numbers, in SI units."""
    return {
        "robot": chain.name,
        "dimension": workspace.dimension,
        "volume_m3": workspace.size if workspace.dimension == 3 else 0.0,
        "area_m2": workspace.size if workspace.dimension == 2 else None,
        "lower_m": workspace.lower.tolist(),
        "upper_m": workspace.upper.tolist(),
        "nearest_m": workspace.nearest,
        "farthest_m": workspace.farthest,
        "first_axis_m": workspace.anchor.tolist(),
        "cell_m": workspace.cell,
        "cells_reached": int(workspace.reached.sum()),
        "complete": workspace.complete,
        "seed": arguments.seed,
    }


def draw(chain: KinematicChain, workspace: Workspace, arguments: Namespace) -> Path:
    """Draw the sections; return the file. GaikError: matplotlib is missing."""
    import numpy as np

    try:
        from gaik_core.experiments.drawing import save
        from gaik_core.workspace_drawing import draw_workspace
    except ImportError:
        raise GaikError(
            "the picture needs matplotlib, which is not installed: pip install matplotlib, or --no-picture"
        ) from None
    middle = 0.5 * (workspace.lower + workspace.upper)
    at = middle if arguments.at is None else np.array(arguments.at)
    if not np.isfinite(at).all():
        raise GaikError(f"--at is {arguments.at}; every coordinate must be finite")
    file: Path = arguments.out / f"{chain.name}.png"
    save(lambda: draw_workspace(chain, workspace, at), file)
    return file


def print_numbers(chain: KinematicChain, data: dict[str, Any], seconds: float) -> None:
    """The numbers for people."""
    print(coloured(chain.name, BOLD) + (f": {chain.description}" if chain.description else ""))
    rows = [("reachable", size_text(data))]
    for axis, low, high in zip("xyz", data["lower_m"], data["upper_m"], strict=True):
        rows.append((axis, f"{low:.4f} to {high:.4f} m"))
    rows.append(("from the first axis", f"{data['nearest_m']:.4f} to {data['farthest_m']:.4f} m"))
    print_table(("", "value"), rows)
    written = f"; picture: {data['picture']}" if data["picture"] else ""
    print(f"{data['cells_reached']} cells of {1e3 * data['cell_m']:.3g} mm in {seconds:.1f} s{written}")


def size_text(data: dict[str, Any]) -> str:
    """The volume or the area, or what it is where it has neither."""
    if data["dimension"] == 3:
        return f"{data['volume_m3']:.5g} m³"
    if data["area_m2"]:
        return f"{data['area_m2']:.5g} m², in a plane"
    return "a surface" if data["dimension"] == 2 else "a curve"


COMMAND = Command(
    "find what an arm can reach: numbers and a picture",
    (
        "gaik workspace touch_device",
        "gaik workspace arm5 --cells 32 --no-picture --json",
        "gaik workspace touch_device --at 0 0.05 0 --out out/sections",
    ),
    configure,
    run,
)
