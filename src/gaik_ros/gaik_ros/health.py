"""Loop health on /diagnostics: what is measured is turned into a level by thresholds that are parameters."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.clock import Clock, ClockType
from rclpy.node import Node

from gaik_ros import qos
from gaik_ros.deadline_loop import DeadlineLoop
from gaik_ros.parameters import Parameter, ParameterSet
from gaik_ros.periods import PeriodReport

OK, WARN, ERROR, STALE = b"\x00", b"\x01", b"\x02", b"\x03"  # DiagnosticStatus.OK, …

LOOP_PARAMETERS = (
    Parameter(
        "diagnostics.rate_warn", 0.98, "", "share of the set rate below which the loop warns", 0.0, 1.0
    ),
    Parameter(
        "diagnostics.rate_error", 0.8, "", "share of the set rate below which it is an error", 0.0, 1.0
    ),
    Parameter("diagnostics.period_p99_warn", 0.02, "s", "99th percentile of the period that warns", 0.0),
    Parameter("diagnostics.period_max_error", 0.2, "s", "longest period that is not yet an error", 0.0),
)
"""Rows for the table of every node that has a loop."""

MOST_SILENT = 2.0  # periods without a tick after which a loop does not run


@dataclass(frozen=True)
class Health:
    """The state of one part of a node: its level, one line, and figures by name."""

    level: bytes
    message: str
    values: Mapping[str, object] = field(default_factory=dict)


Check = Callable[[], Health]


def worst(findings: Sequence[tuple[bytes, str]], good: str = "ok") -> tuple[bytes, str]:
    """The highest level of `findings` and the messages that have it; `good` where there are none."""
    level = max((level for level, _ in findings), default=OK)
    if level == OK:
        return OK, good
    return level, "; ".join(message for found, message in findings if found == level)


def loop_health(report: PeriodReport, rate: float, values: ParameterSet, silence: float = math.inf) -> Health:
    """The health of a loop set to `rate` Hz from one window's report; the last tick was `silence` s ago."""
    findings, good = [], f"{report.rate:.1f} Hz" if report.ticks else "no period is over yet"
    if report.ticks == 0:
        if silence > MOST_SILENT / rate:
            findings.append((ERROR, "the loop does not run"))
    else:
        share = report.rate / rate
        if share < values["diagnostics.rate_error"]:
            findings.append((ERROR, f"runs at {report.rate:.1f} of {rate:g} Hz"))
        elif share < values["diagnostics.rate_warn"]:
            findings.append((WARN, f"runs at {report.rate:.1f} of {rate:g} Hz"))
        if report.periods.maximum > max(values["diagnostics.period_max_error"], 1.5 / rate):
            findings.append((ERROR, f"stalled for {report.periods.maximum:.3f} s"))
        elif report.periods.p99 > max(values["diagnostics.period_p99_warn"], 1.5 / rate):
            findings.append((WARN, f"99th percentile of the period is {report.periods.p99:.4f} s"))
    level, message = worst(findings, good)
    figures = {
        "rate_hz": rate,
        "reached_hz": report.rate,
        "period_p50_s": report.periods.p50,
        "period_p99_s": report.periods.p99,
        "period_max_s": report.periods.maximum,
        "overruns": report.overruns,
    }
    return Health(level, message, figures)


def status_message(name: str, health: Health) -> DiagnosticStatus:
    """The DiagnosticStatus of one part."""
    values = [KeyValue(key=key, value=_text(value)) for key, value in health.values.items()]
    return DiagnosticStatus(
        level=health.level, name=name, message=health.message, hardware_id="", values=values
    )


def _text(value: object) -> str:
    if isinstance(value, float):
        return f"{value:.6g}" if math.isfinite(value) else str(value)
    return str(value)


class HealthReporter:
    """Publishes a node's checks on /diagnostics once a second; names are `namespace/node: part`."""

    def __init__(
        self,
        node: Node,
        values: ParameterSet,
        loop: DeadlineLoop | None = None,
        checks: Mapping[str, Check] | None = None,
    ) -> None:
        """`checks` by the name of the part; `loop` adds the part "loop"."""
        self._node = node
        self._checks = dict(checks or {})
        if loop is not None:
            self._checks["loop"] = lambda: self._loop_health(loop, values)
        self._publisher = node.create_publisher(DiagnosticArray, "/diagnostics", qos.DIAGNOSTICS)
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = node.create_timer(1.0, self.report, clock=self._steady)
        self._began = time.monotonic()
        self.last_loop: PeriodReport | None = None

    def _loop_health(self, loop: DeadlineLoop, values: ParameterSet) -> Health:
        report = loop.periods.take()
        silence = time.monotonic() - (loop.periods.last or self._began)
        # In most of its windows a loop of less than 1 Hz has no tick: the report before stands until it is late.
        if report.ticks or self.last_loop is None or silence > MOST_SILENT / loop.rate:
            self.last_loop = report
        return loop_health(self.last_loop, loop.rate, values, silence)

    def report(self) -> None:
        """Publish now."""
        name = self._node.get_fully_qualified_name().lstrip("/")
        message = DiagnosticArray()
        message.header.stamp = self._node.get_clock().now().to_msg()
        message.status = [status_message(f"{name}: {part}", check()) for part, check in self._checks.items()]
        self._publisher.publish(message)
