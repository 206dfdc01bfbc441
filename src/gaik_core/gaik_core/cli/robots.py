"""`gaik robots`: the robots shipped, or one of them in detail."""

from __future__ import annotations

import math
from argparse import ArgumentParser, Namespace
from typing import Any

import numpy as np

from gaik_core import KinematicChain
from gaik_core.cli.command import Command
from gaik_core.cli.robot import add_robot, load_robot
from gaik_core.cli.terminal import BOLD, coloured, print_json, print_table


def configure(parser: ArgumentParser) -> None:
    """Its arguments."""
    add_robot(parser, optional=True)
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(arguments: Namespace) -> int:
    """List them, or describe one."""
    if arguments.robot is None:
        chains = [KinematicChain.load(name) for name in KinematicChain.names()]
        if arguments.json:
            print_json([describe(chain) for chain in chains])
        else:
            print_table(
                ("robot", "joints", "reach (m)", "limits", "description"), [_row(chain) for chain in chains]
            )
    elif arguments.json:
        print_json(describe(load_robot(arguments)))
    else:
        _print_one(load_robot(arguments))
    return 0


def _row(chain: KinematicChain) -> tuple[str, ...]:
    return (
        chain.name,
        str(chain.dof),
        f"{chain.reach:.3f}",
        "yes" if chain.limited else "no",
        chain.description,
    )


def describe(chain: KinematicChain) -> dict[str, Any]:
    """A robot as plain data; a limit that is not there is None."""
    return {
        "name": chain.name,
        "description": chain.description,
        "reach_m": chain.reach if math.isfinite(chain.reach) else None,
        "joints": [
            {
                "name": name,
                "home": float(chain.home[i]),
                "lower": _finite(chain.lower[i]),
                "upper": _finite(chain.upper[i]),
            }
            for i, name in enumerate(chain.joint_names)
        ],
        "axes": [
            {
                "name": joint.name,
                "type": joint.kind,
                "axis": list(joint.axis),
                "link_m": list(joint.link),
                "coupling": dict(joint.coupling),
                "lower": _finite(joint.axis_lower),
                "upper": _finite(joint.axis_upper),
            }
            for joint in chain.joints
        ],
        "tip_at_home_m": chain.forward(chain.home).tolist(),
    }


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _print_one(chain: KinematicChain) -> None:
    print(coloured(chain.name, BOLD) + (f": {chain.description}" if chain.description else ""))
    print(
        f"reach {chain.reach:.4g} m; tip at home {np.array2string(chain.forward(chain.home), precision=4)} m\n"
    )
    rows = [
        (
            joint.name,
            joint.kind,
            _vector(joint.axis),
            _vector(joint.link),
            _interval(joint.lower, joint.upper),
            f"{joint.home:g}",
        )
        for joint in chain.joints
    ]
    print_table(("joint", "type", "axis", "link (m)", "limits (rad, m)", "home (rad, m)"), rows)
    for joint in chain.joints:
        if joint.coupling:
            terms = " ".join(f"{factor:+g} {other}" for other, factor in joint.coupling.items())
            bound = _interval(joint.axis_lower, joint.axis_upper)
            print(
                f"\nthe axis of {joint.name} turns by its own value {terms}"
                + (f", within {bound}" if bound else "")
            )


def _vector(values: tuple[float, float, float]) -> str:
    return "[" + ", ".join(f"{value + 0.0:g}" for value in values) + "]"


def _interval(lower: float, upper: float) -> str:
    return f"[{lower:g}, {upper:g}]" if math.isfinite(lower) or math.isfinite(upper) else ""


COMMAND = Command(
    "list the robots, or describe one",
    ("gaik robots", "gaik robots touch_device", "gaik robots arm5 --json"),
    configure,
    run,
)
