"""`ros2 run gaik_ros inject`: play faults against a running suite, or one of its own, and see what is promised held.

Exit code 0 where every promise held, 1 where one did not, 2 for a wrong argument or a suite that is not there.
"""

from __future__ import annotations

import argparse
import os
import signal
import sys
from collections.abc import Sequence
from pathlib import Path

from gaik_core.cli.parser import Parser
from gaik_ros.faults.catalogue import FAULTS, fault_by_name
from gaik_ros.faults.fault import Fault, Outcome, StageError
from gaik_ros.faults.report import lines, listing, page
from gaik_ros.faults.rig import rig
from gaik_ros.run import ROS_ARGUMENT_ERRORS, check_namespace, explained
from gaik_ros.signals import INTERRUPTED

HELD, BROKEN, WRONG = 0, 1, 2


def _arguments(args: Sequence[str] | None) -> argparse.Namespace:
    parser = Parser(
        prog="inject",
        description="Play faults against a running suite and say whether what is promised holds. The arm moves: let "
        "nobody else send setpoints meanwhile.",
        epilog="Exit code: 0 all promises held, 1 one did not, 2 a wrong argument or no suite.",
    )
    parser.add_argument("faults", nargs="*", metavar="FAULT", help="names of faults, as --list has them")
    parser.add_argument(
        "--list", action="store_true", help="list the faults and what they need; so does no argument"
    )
    parser.add_argument("--all", action="store_true", help="all faults that can be played here")
    parser.add_argument("--quick", action="store_true", help="with --all: but those that take over a minute")
    parser.add_argument("--namespace", default="", help="the suite's namespace (none)")
    parser.add_argument(
        "--start-suite",
        action="store_true",
        help="start a suite with the twin, in a namespace of its own if none is given, and end it after",
    )
    parser.add_argument(
        "--cable",
        default="",
        metavar="TOPIC",
        help="the device's joint_states come on TOPIC (by -r joint_states:=TOPIC) and go through the injector",
    )
    parser.add_argument(
        "--write", type=Path, metavar="FILE", help="write the table of docs/faults.md to FILE"
    )
    given = parser.parse_args(args)
    if given.cable and given.start_suite:
        parser.error(
            "--cable is for a suite that runs; with --start-suite the cable is put in where it is needed"
        )
    if given.all and given.faults:
        parser.error("give names of faults or --all, not both")
    return given


def _chosen(given: argparse.Namespace) -> list[Fault]:
    if given.all:
        return [fault for fault in FAULTS if not (given.quick and fault.long)]
    return [fault_by_name(name) for name in given.faults]


def _play(given: argparse.Namespace, faults: Sequence[Fault]) -> int:
    # By the process's number, so that two that are started at once do not hear each other.
    namespace = check_namespace(given.namespace or (f"faults_{os.getpid()}" if given.start_suite else ""))
    outcomes: list[Outcome] = []
    skipped: dict[str, str] = {}
    if given.write is not None:
        _make_sure_of(given.write)
    with rig(namespace, given.start_suite, given.cable) as ours:
        if not given.all:
            for fault in faults:
                ours.require(fault)  # before any is played
        for fault in faults:
            lack = ours.lacks(fault) if given.all else ""
            if lack:
                skipped[fault.name] = lack
                print(f"{fault.name}: not played, {lack}", flush=True)
                continue
            outcome = ours.play(fault)
            outcomes.append(outcome)
            print(lines(outcome), flush=True)
    if given.write is not None:
        given.write.write_text(page(outcomes, skipped))
    held = sum(outcome.holds for outcome in outcomes)
    print(f"{held} of {len(outcomes)} held" + (f", {len(skipped)} not played" if skipped else ""))
    return HELD if held == len(outcomes) else BROKEN


def _make_sure_of(file: Path) -> None:
    """Make the file now if it is not there: hours later it would be late to hear that it cannot be written."""
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        file.open("a").close()
    except OSError as reason:
        raise ValueError(f"--write: {file} cannot be written: {reason.strerror or reason}") from None


def main(args: Sequence[str] | None = None) -> int:
    """Entry point of the executable."""
    given = _arguments(args)
    try:
        faults = _chosen(given)
        if given.list or not faults:
            print(listing(FAULTS))
            return HELD
        signal.signal(
            signal.SIGTERM, signal.getsignal(signal.SIGINT)
        )  # ends as Ctrl-C does: nothing is left running
        return _play(given, faults)
    except (StageError, ValueError, *ROS_ARGUMENT_ERRORS) as error:
        print(f"inject: {explained(error)}", file=sys.stderr)
        return WRONG
    except KeyboardInterrupt:
        return INTERRUPTED


if __name__ == "__main__":
    sys.exit(main())
