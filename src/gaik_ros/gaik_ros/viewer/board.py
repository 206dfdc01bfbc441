"""How the suite's nodes are, from what they say of themselves on /diagnostics."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from gaik_ros.health import STALE
from gaik_ros.viewer.strip_chart import StripChart

SILENT = 3.0  # s: a node that says nothing for so long is taken for gone; it speaks once a second
PERIODS = ("period_p50_s", "period_p99_s", "period_max_s")


@dataclass(frozen=True)
class Part:
    """What a node says of one part of itself."""

    level: bytes
    message: str
    values: Mapping[str, str]
    time: float  # s, when it was heard


@dataclass(frozen=True)
class NodeHealth:
    """A node in one line. `level` is STALE where it is not heard."""

    name: str
    level: bytes
    message: str
    rate: float  # Hz, of its loop; NaN where unknown


class Board:
    """The newest words of `nodes`, given by their full names without the leading slash. Times in s are handed in."""

    def __init__(self, nodes: Sequence[str], window: float) -> None:
        """`window` in s: how long the loops' periods are remembered."""
        self._parts: dict[str, dict[str, Part]] = {node: {} for node in nodes}
        self.periods = {node: StripChart(len(PERIODS), window) for node in nodes}

    def hear(self, name: str, level: bytes, message: str, values: Mapping[str, str], now: float) -> None:
        """Note a status, called `namespace/node: part`; those of other nodes are passed over."""
        node, _, part = name.partition(": ")
        if node not in self._parts:
            return
        self._parts[node][part] = Part(level, message, values, now)
        if part == "loop":
            self.periods[node].add(now, [_number(values, key) for key in PERIODS])

    def health(self, now: float) -> list[NodeHealth]:
        """All nodes, in their order."""
        return [self._health_of(node, now) for node in self._parts]

    def _health_of(self, node: str, now: float) -> NodeHealth:
        parts = {name: part for name, part in self._parts[node].items() if now - part.time <= SILENT}
        if not parts:
            return NodeHealth(node, STALE, "not heard", math.nan)
        level = max(part.level for part in parts.values())
        said = [part.message for part in parts.values() if part.level == level]
        message = "ok" if level == b"\x00" else "; ".join(said)
        rate = _number(parts["loop"].values, "reached_hz") if "loop" in parts else math.nan
        return NodeHealth(node, level, message, rate)


def _number(values: Mapping[str, str], key: str) -> float:
    try:
        return float(values[key])
    except (KeyError, ValueError):
        return math.nan
