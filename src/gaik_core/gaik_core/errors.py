"""The errors a user can cause, each a ValueError whose message names the culprit, what it was and what it may be."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches


class GaikError(ValueError):
    """What all errors of gaik_core have in common: one line, whatever a file or an array puts into it."""

    def __str__(self) -> str:
        return " ".join(super().__str__().split())


class RobotFileError(GaikError):
    """A robot file that cannot be read; the message begins with the file and the key."""


class UrdfError(GaikError):
    """A URDF that is no chain between the two links, or has what no chain here can have."""


class UnknownNameError(GaikError):
    """A robot, algebra, rule or path that is not there; the message lists those that are."""

    def __init__(self, what: str, name: object, known: Iterable[str]) -> None:
        names = list(known)
        near = get_close_matches(str(name), names, n=1)
        hint = f" (did you mean {near[0]!r}?)" if near else ""
        super().__init__(f"unknown {what} {name!r}{hint}; known: {', '.join(names)}")


class UnknownRobotError(UnknownNameError):
    """A robot that is neither shipped nor a file."""


class ShapeError(GaikError):
    """An array of the wrong shape."""

    def __init__(self, what: str, shape: tuple[int, ...], expected: str) -> None:
        super().__init__(f"{what} has shape {shape}; expected {expected}")


class NotFiniteError(GaikError):
    """A NaN or an infinity where a finite number is needed."""

    def __init__(self, what: str, value: object) -> None:
        super().__init__(f"{what} is {value}; every element must be finite")
