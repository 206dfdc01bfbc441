"""The verdict on a setpoint in words, for people: lengths in mm, times in µs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from gaik_ros.continuous_ik import Result

ANOTHER_BRANCH = "another branch"  # stands in ik_node's message where it refused one


@dataclass(frozen=True)
class Words:
    """One word, a sentence that says more, and whether all is well."""

    headline: str
    sentence: str
    good: bool


NOTHING_YET = Words("No setpoint yet", "Drag the ball, or start a path.", True)


def verdict_in_words(values: Mapping[str, str], message: str = "") -> Words:
    """The words for a verdict, from the keys and values of `~/status` and its message.

    A verdict of another make, without the keys that gaik_ros.verdict writes, is given as its message.
    """
    try:
        return _words(Result(values["result"]), values, message)
    except (KeyError, ValueError):
        return Words("Verdict", message or "empty", False)


def _words(result: Result, values: Mapping[str, str], message: str) -> Words:
    if result in (Result.REFUSED, Result.WAITING):
        return Words(result.value.capitalize(), f"{_sentence_case(message)}.", False)
    where = _millimetres(values["x"], values["y"], values["z"])
    effort = f"{_count(values['iterations'], 'update')} in {float(values['solve_time_us']):.0f} µs"
    if result is Result.REACHED:
        branch = " An answer on another branch was refused." if ANOTHER_BRANCH in message else ""
        return Words("Reached", f"{where}, to {_length(float(values['error_m']))}: {effort}.{branch}", True)
    off = f"the nearest found is {_length(float(values['error_m']))} off ({effort})"
    if result is Result.UNREACHABLE:
        return Words("Out of reach", f"The links are too short for {where}: {off}.", False)
    if result is Result.LIMITED:
        joints = values["joint"].replace(",", " and ") if values.get("joint") else "a joint"
        return Words("Held off by a limit", f"{where}: {joints} at the limit; {off}.", False)
    return Words("Stagnated", f"{where}: the solver came no nearer; {off}.", False)


def nearest_point(values: Mapping[str, str]) -> tuple[float, float, float] | None:
    """Where the tip goes instead, m; None where it goes to the setpoint itself."""
    try:
        return float(values["nearest_x"]), float(values["nearest_y"]), float(values["nearest_z"])
    except (KeyError, ValueError):
        return None


def _millimetres(*metres: str) -> str:
    return "(" + ", ".join(f"{round(1e3 * float(value), 1) + 0.0:.1f}" for value in metres) + ") mm"


def _length(metres: float) -> str:
    """A length in the unit that suits it."""
    if metres >= 1e-4:
        return f"{1e3 * metres:.1f} mm"
    return f"{1e6 * metres:.1f} µm" if metres >= 1e-7 else "less than 0.1 µm"


def _count(number: str, noun: str) -> str:
    return f"{number} {noun}" if number == "1" else f"{number} {noun}s"


def _sentence_case(text: str) -> str:
    return text[:1].upper() + text[1:].rstrip(".")
