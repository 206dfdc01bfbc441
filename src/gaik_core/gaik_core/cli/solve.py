"""`gaik solve`: angles that bring a robot's tip to a target."""

from __future__ import annotations

import math
from argparse import ArgumentParser, Namespace
from itertools import zip_longest
from typing import Any, Literal

import numpy as np

from gaik_core import (
    ALGEBRAS,
    RULES,
    KinematicChain,
    Pointing,
    Pose,
    Solution,
    UpdateRule,
    rule_by_name,
    solve,
)
from gaik_core.cli.command import Command
from gaik_core.cli.robot import add_robot, load_robot
from gaik_core.cli.terminal import GREEN, RED, coloured, print_json, print_table
from gaik_core.errors import GaikError
from gaik_core.targets import Target


def configure(parser: ArgumentParser) -> None:
    """Its arguments."""
    add_robot(parser)
    for axis in "xyz":
        parser.add_argument(
            axis, type=float, metavar=axis.upper(), help=f"where the tip should be, along {axis} (m)"
        )
    _add_target(parser)
    start = parser.add_mutually_exclusive_group()
    start.add_argument(
        "--start",
        nargs="+",
        type=float,
        metavar="RAD",
        help="start, a value per joint, m where it slides (default: its home)",
    )
    start.add_argument(
        "--start-deg",
        nargs="+",
        type=float,
        metavar="DEG",
        help="the same in degrees; m where a joint slides",
    )
    _add_method(parser)
    parser.add_argument("--no-limits", action="store_true", help="pass over the joint limits")
    parser.add_argument("--json", action="store_true", help="print JSON")


def _add_target(parser: ArgumentParser) -> None:
    more = parser.add_mutually_exclusive_group()
    more.add_argument(
        "--direction",
        nargs=3,
        type=float,
        metavar=("X", "Y", "Z"),
        help="point the tool's axis along this direction",
    )
    more.add_argument(
        "--orientation",
        nargs=4,
        type=float,
        metavar=("W", "X", "Y", "Z"),
        help="turn the tip's frame so, a quaternion",
    )
    parser.add_argument(
        "--tool-axis", nargs=3, type=float, metavar=("X", "Y", "Z"), default=(0.0, 0.0, 1.0),
        help="the tool's axis in the tip's frame, for --direction (default: 0 0 1)",
    )  # fmt: skip


def _add_method(parser: ArgumentParser) -> None:
    parser.add_argument("--algebra", default="quaternion", choices=ALGEBRAS, help="default: %(default)s")
    parser.add_argument(
        "--rule",
        default="levenberg_marquardt",
        choices=RULES,
        metavar="RULE",
        help=f"update rule: {', '.join(RULES)} (default: %(default)s)",
    )
    parser.add_argument(
        "--learning-rate", type=_learning_rate, metavar="RATE", help="of the rule, where it has one"
    )
    parser.add_argument("--tolerance", type=float, default=1e-6, metavar="M", help="default: %(default)g m")
    parser.add_argument(
        "--orientation-tolerance", type=float, default=1e-4, metavar="RAD", help="default: %(default)g rad"
    )
    parser.add_argument(
        "--max-iterations", type=int, default=1000, metavar="N", help="default: %(default)s updates"
    )
    parser.add_argument(
        "--restarts", type=int, default=0, metavar="N", help="other starts to try when stuck (default: 0)"
    )
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="of the restarts (default: 0)")


def _learning_rate(text: str) -> float | Literal["auto"]:
    return "auto" if text == "auto" else float(text)


def run(arguments: Namespace) -> int:
    """Solve and print; 1 where the target was not reached."""
    chain = load_robot(arguments)
    solution = solve(
        chain,
        target(arguments),
        start(chain, arguments),
        arguments.algebra,
        rule(arguments),
        arguments.tolerance,
        arguments.max_iterations,
        limits=False if arguments.no_limits else None,
        restarts=arguments.restarts,
        seed=arguments.seed,
        orientation_tolerance=arguments.orientation_tolerance,
    )
    if arguments.json:
        print_json(as_data(chain, arguments, solution))
    else:
        print_solution(chain, arguments, solution)
    return 0 if solution.converged else 1


def position(arguments: Namespace) -> list[float]:
    """Where the tip should be (m)."""
    return [arguments.x, arguments.y, arguments.z]


def target(arguments: Namespace) -> Target:
    """What is asked for: a position, with a direction or an orientation."""
    if arguments.direction is not None:
        return Pointing(position(arguments), arguments.direction, arguments.tool_axis)
    if arguments.orientation is not None:
        return Pose(position(arguments), arguments.orientation)
    return position(arguments)


def start(chain: KinematicChain, arguments: Namespace) -> list[float] | None:
    """Values to start from (rad, or m where a joint slides); None for the robot's home."""
    if arguments.start_deg is not None:
        # Of too many values the solve complains.
        slides = [joint.kind == "prismatic" for joint in chain.joints if not joint.passive]
        return [
            value if slide else math.radians(value)
            for value, slide in zip_longest(arguments.start_deg, slides[: len(arguments.start_deg)])
        ]
    result: list[float] | None = arguments.start
    return result


def rule(arguments: Namespace) -> UpdateRule:
    """The update rule asked for."""
    if arguments.learning_rate is not None and not hasattr(RULES[arguments.rule], "learning_rate"):
        raise GaikError(f"--learning-rate: the rule {arguments.rule} has none")
    return rule_by_name(arguments.rule, arguments.learning_rate)


def as_data(chain: KinematicChain, arguments: Namespace, solution: Solution) -> dict[str, Any]:
    """The solution as plain data."""
    return {
        "robot": chain.name,
        "target_m": position(arguments),
        "algebra": arguments.algebra,
        "rule": arguments.rule,
        "status": str(solution.status),
        "converged": bool(solution.converged),
        "iterations": int(solution.iterations),
        "restarts": int(solution.restarts),
        "error_m": float(solution.error),
        "orientation_error_rad": float(solution.orientation_error),
        "angles": {
            name: float(value) for name, value in zip(chain.joint_names, solution.angles, strict=True)
        },
        "tip_m": chain.forward(solution.angles, arguments.algebra).tolist(),
    }


def print_solution(chain: KinematicChain, arguments: Namespace, solution: Solution) -> None:
    """The solution for people."""
    status = coloured(str(solution.status).replace("_", " "), GREEN if solution.converged else RED)
    where = ", ".join(f"{value:g}" for value in position(arguments))
    left = f"{solution.error:.2g} m"
    if arguments.direction is not None or arguments.orientation is not None:
        left += f" and {solution.orientation_error:.2g} rad"
    print(f"{chain.name} to [{where}] m: {status} after {solution.iterations} updates, {left} left")
    kinds = {joint.name: joint.kind for joint in chain.joints}
    rows = [
        (name, f"{value:.6f}", f"{np.degrees(value):.4f}" if kinds[name] == "revolute" else "")
        for name, value in zip(chain.joint_names, solution.angles, strict=True)
    ]
    unit = "rad" if all(kinds[name] == "revolute" for name in chain.joint_names) else "rad, m"
    print_table(("joint", f"value ({unit})", "(deg)"), rows)


COMMAND = Command(
    "find the angles that bring a robot's tip to a point",
    (
        "gaik solve touch 0.05 0.05 0",
        "gaik solve touch 0.05 0.05 0 --start-deg 57.29 -57.29 0 --rule gradient_descent --learning-rate 20 "
        "--tolerance 1e-4",
        "gaik solve touch_device 0.05 0.05 0 --algebra conformal --restarts 20 --json",
        "gaik solve arm5 4 1 2 --direction 1 0 0 --tool-axis 1 0 0",
    ),
    configure,
    run,
)
