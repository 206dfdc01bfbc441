"""The outcome of faults for people: lines in a terminal, and the table in docs/faults.md."""

from __future__ import annotations

import os
import platform
from collections.abc import Iterable, Mapping, Sequence
from datetime import date

from rclpy.utilities import get_rmw_implementation_identifier

from gaik_ros.faults.fault import Fault, Outcome
from gaik_ros.faults.invariants import ALIVE, EFFORT, RECOVERY, SPEED

INTRODUCTION = """\
# Faults

What may go wrong around the nodes, what is promised for it, and what was measured when it was played against the
suite with the twin. `ros2 run gaik_ros inject --list` lists the faults; `ros2 run gaik_ros inject NAME` plays one
against a running suite, of any device in any namespace. Made by
`ros2 run gaik_ros inject --all --start-suite --write docs/faults.md`.

In every case, besides what the table promises: every `joint_command` is finite and within the limits of the effort
("effort"); every `joint_reference` is finite, inside the joint limits and never faster than the speed limit
("reference"); all nodes live, and the arm goes where the next good setpoint sends it ("recovery"). Nothing is
restarted but what was ended. Times are bounded by what is promised and a second more, for a busy machine; what was
measured stands here. On a machine that is late the gains fall (ADR 5), so the arm may be further behind than on an
idle one.

One thing no node can mend. Between processes of one host Fast DDS passes messages through shared memory. A process that
is stopped or killed while it holds a lock there can leave others deaf to it and to whatever is started later
(eProsima/Fast-DDS issue 5469). To them it is a cut cable: the timeouts hold, but only a restart helps. Where nodes may
be killed, have them talk over UDP. The tests do, and this page is made after the same:

```bash
export ROS_AUTOMATIC_DISCOVERY_RANGE=SYSTEM_DEFAULT FASTRTPS_DEFAULT_PROFILES_FILE=$PWD/config/fastdds_udp.xml
```
"""


def machine() -> str:
    """One line about where and when."""
    cores = len(os.sched_getaffinity(0))
    load = os.getloadavg()[0]
    return (
        f"Measured on {date.today().isoformat()}: {cores} cores of {platform.machine()}, {platform.system()}, "
        f"Python {platform.python_version()}, {get_rmw_implementation_identifier()}, load {load:.1f} at the end."
    )


def listing(faults: Iterable[Fault]) -> str:
    """What --list prints."""
    rows = []
    for fault in faults:
        notes = [f"needs {need}" for need in sorted(fault.needs)] + (
            ["takes over a minute"] if fault.long else []
        )
        rows.append(f"{fault.name:<30} {fault.does}" + (f" ({', '.join(notes)})" if notes else ""))
    return "\n".join(rows)


def lines(outcome: Outcome) -> str:
    """What is printed of one fault: the promise, and each check with a plus or a minus."""
    fault = outcome.fault
    verdict = "held" if outcome.holds else "BROKEN"
    rows = [f"{fault.name}: {verdict}, {outcome.seconds:.1f} s", f"  does      {fault.does}"]
    rows.append(f"  promised  {fault.promises}")
    rows += [f"  {'+' if check.holds else '-'} {check.promise}: {check.measured}" for check in outcome.checks]
    return "\n".join(rows)


def page(outcomes: Sequence[Outcome], skipped: Mapping[str, str]) -> str:
    """docs/faults.md. `skipped` has the faults that were not played, and why."""
    kept = sum(outcome.holds for outcome in outcomes)
    parts = [INTRODUCTION, machine(), f"{kept} of {len(outcomes)} promises held.", ""]
    parts.append("| fault | what is done | promised | measured | effort | reference | recovery | held |")
    parts.append("| --- | --- | --- | --- | --- | --- | --- | --- |")
    parts.extend(_row(outcome) for outcome in outcomes)
    if skipped:
        parts += ["", "Not played:", "", *(f"- `{name}`: {reason}" for name, reason in skipped.items())]
    return "\n".join(parts) + "\n"


def _row(outcome: Outcome) -> str:
    always = {check.promise: check for check in outcome.checks}
    own = [check for check in outcome.checks if check.promise not in (EFFORT, SPEED, RECOVERY)]
    if always[ALIVE].holds:
        own.remove(always[ALIVE])
    measured = "; ".join(f"{check.promise}: {check.measured}" for check in own)
    columns = (
        f"`{outcome.fault.name}`",
        outcome.fault.does,
        outcome.fault.promises,
        measured,
        always[EFFORT].measured,
        always[SPEED].measured,
        always[RECOVERY].measured,
        "yes" if outcome.holds else "**no**",
    )
    return "| " + " | ".join(column.replace("|", "¦") for column in columns) + " |"
