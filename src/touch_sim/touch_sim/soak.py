"""Run the suite for a long time and see that its memory stays flat and its loops keep their periods.

    python -m touch_sim.soak --minutes 20        make soak MINUTES=20

Exit code 0 where the memory is flat, 1 where it is not: where the median of the last fifth of the run is more than
1 % above that of the second fifth. The first fifth is left to caches that fill and threads that start.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rclpy.logging import LoggingSeverity
from rclpy.node import Node
from std_srvs.srv import Trigger

from gaik_ros.faults.remote import Remote
from gaik_ros.pid_controller import PidController
from gaik_ros.run import running
from touch_sim.command_line import Parser, within
from touch_sim.isolation import isolated_context
from touch_sim.loop_meter import LoopMeter
from touch_sim.suite import Suite, SuiteOptions

SAMPLES = 40  # of one run, at the most
SHORTEST = 1.0  # s between two
FLAT = 0.01  # of the memory: growth up to this is none
MEBIBYTE = 2.0**20


@dataclass(frozen=True)
class Sample:
    """One span of the run: its end in s, the memory at it in MiB, and the controller's periods in it, s."""

    time: float
    memory: float
    p50: float
    p99: float
    longest: float
    rate: float  # Hz

    def __str__(self) -> str:
        return (
            f"{self.time:7.0f} s  {self.memory:8.2f} MiB  {self.rate:7.1f} Hz  "
            f"p50 {1e3 * self.p50:6.3f} ms  p99 {1e3 * self.p99:7.3f} ms  max {1e3 * self.longest:7.1f} ms"
        )


def resident() -> float:
    """Return the resident memory of this process in MiB."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / MEBIBYTE


def growth(memory: Sequence[float]) -> float:
    """Return by what share the last fifth of the samples is above the second; 0 for fewer than five samples."""
    fifth = len(memory) // 5
    if fifth == 0:
        return 0.0
    return float(np.median(memory[-fifth:]) / np.median(memory[fifth : 2 * fifth]) - 1.0)


def soak(seconds: float, report: Callable[[Sample], None]) -> list[Sample]:
    """Run the suite on the circle for `seconds` and return its samples; each is reported as it is taken."""
    options = SuiteOptions(namespace=f"soak_{os.getpid()}")
    samples: list[Sample] = []
    with isolated_context() as context:
        suite = Suite(options, context)
        for node in suite.nodes:
            node.get_logger().set_level(LoggingSeverity.ERROR)  # a busy machine is not what is looked for
        meter = LoopMeter(next(node.loop for node in suite.nodes if isinstance(node, PidController)))
        user = Node("user", context=context, namespace=options.namespace)
        with running([*suite.nodes, user], context):
            Remote(user).call(Trigger, "trajectory_publisher/start", Trigger.Request())
            meter.clear()
            span, began = max(SHORTEST, seconds / SAMPLES), time.monotonic()
            while (passed := time.monotonic() - began) < seconds:
                time.sleep(min(span, seconds - passed))
                samples.append(_sample(meter, time.monotonic() - began))
                report(samples[-1])
    return samples


def _sample(meter: LoopMeter, now: float) -> Sample:
    periods = meter.periods()
    meter.clear()
    p50, p99 = np.percentile(periods, (50.0, 99.0))
    return Sample(now, resident(), float(p50), float(p99), float(periods.max()), float(1.0 / periods.mean()))


def main(args: Sequence[str] | None = None) -> int:
    """Entry point of the program; returns the exit code."""
    parser = Parser("soak", "Run the suite for a long time and report memory and periods.", "")
    parser.add_argument("--minutes", type=within(float, 0.01, 100_000), default=20.0, help="how long (20)")
    given = parser.parse_args(args)
    try:
        samples = soak(60.0 * given.minutes, lambda sample: print(sample, flush=True))
    except KeyboardInterrupt:
        return 130
    grown = growth([sample.memory for sample in samples])
    flat = grown <= FLAT
    print(
        f"memory {'is flat' if flat else 'GROWS'}: {100.0 * grown:+.2f} % from the second fifth to the last"
    )
    return 0 if flat else 1


if __name__ == "__main__":
    sys.exit(main())
