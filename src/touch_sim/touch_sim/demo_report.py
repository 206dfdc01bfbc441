"""The demo's figures as a table for people and as JSON for machines."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from gaik_ros.tracking import tracking_error
from touch_sim.demo_run import Results


def summary(results: Results) -> dict[str, Any]:
    """Return what demo.json holds; all in SI units."""
    errors = {run.name: tracking_error(run) for run in results.runs}
    solve_times = [1e-6 * float(verdict["solve_time_us"]) for verdict in results.verdicts]
    p50, p99 = np.percentile(solve_times, (50.0, 99.0)).tolist()
    return {
        "paths": {name: {"rms_m": error.rms_m, "max_m": error.max_m} for name, error in errors.items()},
        "nodes": {
            name: {"rate_hz": loop.rate_hz, "reached_hz": loop.reached_hz, "period_p99_s": loop.period_p99_s}
            for name, loop in results.nodes.items()
        },
        "ik": {"solved": solved(results), "p50_s": p50, "p99_s": p99},
        "cpu_cores": results.cpu_cores,
    }


def solved(results: Results) -> int:
    """Return how many setpoints the IK node reached."""
    return sum(verdict["result"] == "reached" for verdict in results.verdicts)


def write_json(results: Results, file: Path) -> None:
    """Write the summary."""
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps(summary(results), indent=2) + "\n", encoding="utf-8")


def table(results: Results) -> str:
    """Return the summary as text, in units that people read."""
    figures = summary(results)
    ik = figures["ik"]
    paths = [
        (name, f"{1e3 * error['rms_m']:.3f} mm", f"{1e3 * error['max_m']:.3f} mm")
        for name, error in figures["paths"].items()
    ]
    nodes = [
        (
            name,
            f"{loop['rate_hz']:g} Hz",
            f"{loop['reached_hz']:.1f} Hz",
            f"{1e3 * loop['period_p99_s']:.2f} ms",
        )
        for name, loop in figures["nodes"].items()
    ]
    sent = sum(run.setpoint.time.size for run in results.runs)
    superseded = sum(int(verdict["superseded"]) for verdict in results.verdicts)
    lines = [
        *_columns([("path", "error RMS", "error max"), *paths]),
        "",
        *_columns([("node", "rate set", "reached", "period p99"), *nodes]),
        "",
        f"setpoints   {sent} sent, {ik['solved']} solved"
        + (f", {superseded} superseded by newer ones" if superseded else ""),
        f"IK time     p50 {1e6 * ik['p50_s']:.0f} µs, p99 {1e6 * ik['p99_s']:.0f} µs",
        f"CPU         {100 * figures['cpu_cores']:.0f} % of one core, for all nodes and the recording",
    ]
    return "\n".join(lines)


def _columns(rows: Sequence[Sequence[str]]) -> list[str]:
    """Return the rows as lines, the first column to the left and the others to the right."""
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    return [
        "  ".join(
            cell.ljust(width) if column == 0 else cell.rjust(width)
            for column, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]
