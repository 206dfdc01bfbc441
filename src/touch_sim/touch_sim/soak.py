"""Run the suite for a long time, and report memory and periods over it.

    python -m touch_sim.soak --minutes 20        make soak MINUTES=20

Memory is flat where the straight line through the second half of its samples rises by less than a megabyte in ten
minutes: the first half holds what is filled once, such as caches and the middleware's histories.
"""

from __future__ import annotations

import argparse
import csv
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import numpy as np

from gaik_ros.run import running
from touch_sim.isolation import isolated_context
from touch_sim.loop_meter import LoopMeter
from touch_sim.suite import Suite, SuiteOptions

FLAT = 1.0  # MB in ten minutes
NOT_FLAT, BAD_OPTION, INTERRUPTED = 1, 2, 130


@dataclass(frozen=True)
class Sample:
    """The suite at one moment: memory in MB, and the controller's loop since the sample before."""

    minutes: float
    memory_mb: float
    reached_hz: float
    period_p99_ms: float
    longest_ms: float


def slope(samples: Sequence[Sample]) -> float:
    """MB in ten minutes by which memory rises over the second half of the samples, by least squares."""
    half = samples[len(samples) // 2 :]
    if len(half) < 2:
        return 0.0
    return 10.0 * float(np.polyfit([s.minutes for s in half], [s.memory_mb for s in half], 1)[0])


def memory_mb() -> float:
    """Resident memory of this process in MB, as Linux tells it."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * 4096 / 1e6


def soak(minutes: float, every: float) -> list[Sample]:
    """Let the twin follow the circle for that long, and print a sample every so many seconds."""
    samples: list[Sample] = []
    with isolated_context() as context:
        going_round = {"trajectory_publisher": {"autostart": True, "loop": True}}
        suite = Suite(SuiteOptions(namespace="soak"), context, going_round)
        meter = LoopMeter(suite.controller.loop)  # type: ignore[attr-defined]  # a PidController
        with running(suite.nodes, context):
            began = time.monotonic()
            print("minutes  memory MB  reached Hz  p99 ms  longest ms", flush=True)
            while (elapsed := time.monotonic() - began) < 60.0 * minutes:
                meter.clear()
                time.sleep(min(every, 60.0 * minutes - elapsed + 0.01))
                periods = meter.periods()
                samples.append(
                    Sample(
                        (time.monotonic() - began) / 60.0,
                        memory_mb(),
                        1.0 / float(periods.mean()),
                        1e3 * float(np.percentile(periods, 99.0)),
                        1e3 * float(periods.max()),
                    )
                )
                print(
                    "{:7.1f}  {:9.1f}  {:10.1f}  {:6.2f}  {:10.2f}".format(*asdict(samples[-1]).values()),
                    flush=True,
                )
    return samples


def main(arguments: Sequence[str] | None = None) -> int:
    """Entry point; 0 where memory is flat, 1 where it is not."""
    parser = argparse.ArgumentParser(prog="soak", description=__doc__.splitlines()[0])
    parser.add_argument("--minutes", type=float, default=20.0, help="how long (default: %(default)g)")
    parser.add_argument(
        "--every", type=float, default=30.0, metavar="S", help="between samples (default: %(default)g)"
    )
    parser.add_argument("--out", type=Path, default=Path("out"), help="where soak.csv goes (default: out)")
    options = parser.parse_args(arguments)
    if not (options.minutes > 0.0 and options.every > 0.0):
        parser.error(f"--minutes is {options.minutes:g}, --every {options.every:g}; expected both above 0")
    try:
        samples = soak(options.minutes, options.every)
    except KeyboardInterrupt:
        return INTERRUPTED
    options.out.mkdir(parents=True, exist_ok=True)
    with (options.out / "soak.csv").open("w", newline="") as file:
        table = csv.DictWriter(file, [field.name for field in fields(Sample)])
        table.writeheader()
        table.writerows(asdict(sample) for sample in samples)
    rise = slope(samples)
    print(
        f"memory rises by {rise:.2f} MB in ten minutes: {'flat' if rise < FLAT else 'not flat'} (below {FLAT:g} is)"
    )
    return 0 if rise < FLAT else NOT_FLAT


if __name__ == "__main__":
    sys.exit(main())
