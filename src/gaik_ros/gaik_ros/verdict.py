"""The verdict on a setpoint as a DiagnosticStatus; `verdict_message` lists its keys."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from numpy.typing import NDArray

from gaik_ros.continuous_ik import Answer, Result
from gaik_ros.health import OK, WARN

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Verdict:
    """What became of one setpoint."""

    sequence: int  # number of the setpoint among those received, from 1
    setpoint: Array  # (3,) m
    result: Result
    message: str
    superseded: int = 0  # setpoints that a newer one replaced before their turn, since the last verdict
    solve_time: float = 0.0  # s
    answer: Answer | None = None


def describe(answer: Answer) -> str:
    """One line about an answer."""
    if answer.result is Result.REACHED:
        return "reached; an answer on another branch was refused" if answer.branch_refused else "reached"
    where = ", ".join(f"{value:.4f}" for value in answer.nearest)
    why = f" ({answer.joint} on its limit)" if answer.joint else ""
    return f"{answer.result}{why}: the nearest found is [{where}] m, {answer.error:.4f} m off"


def verdict_message(name: str, verdict: Verdict) -> DiagnosticStatus:
    """The DiagnosticStatus; OK only where the setpoint was reached."""
    x, y, z = verdict.setpoint.tolist()
    answer = verdict.answer
    values = {
        "sequence": str(verdict.sequence),
        "x": repr(x),
        "y": repr(y),
        "z": repr(z),
        "result": verdict.result.value,
        "error_m": f"{answer.error:.9g}" if answer else "nan",
        "iterations": str(answer.iterations if answer else 0),
        "solve_time_us": f"{1e6 * verdict.solve_time:.1f}",
        "superseded": str(verdict.superseded),
    }
    if answer and answer.result is not Result.REACHED:
        for axis, value in zip("xyz", answer.nearest.tolist(), strict=True):
            values[f"nearest_{axis}"] = f"{value:.9g}"
        if answer.joint:
            values["joint"] = answer.joint
    return DiagnosticStatus(
        level=OK if verdict.result is Result.REACHED else WARN,
        name=name,
        message=verdict.message,
        values=[KeyValue(key=key, value=value) for key, value in values.items()],
    )
