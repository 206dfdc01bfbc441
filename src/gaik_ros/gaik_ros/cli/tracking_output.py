"""What `plot` and `replay` say of runs: a table for people, JSON for machines, and the paper's Figs. 21 and 22."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from gaik_core.cli.terminal import print_table
from gaik_core.errors import GaikError
from gaik_ros.tracking import Run, tracking_error

PATHS, JOINTS = "fig21_path.png", "fig22_joints.png"


def as_data(run: Run) -> dict[str, Any]:
    """The figures of a run, in SI units."""
    error = tracking_error(run)
    return {
        "name": run.name,
        "start_s": run.course.start,
        "duration_s": run.course.end - run.course.start,
        "setpoints": int(run.setpoint.time.size),
        "tips": error.samples,
        "rms_m": error.rms_m,
        "max_m": error.max_m,
    }


def print_runs(runs: Sequence[dict[str, Any]], begin: float) -> None:
    """The figures as a table, the starts counted from `begin` s."""
    print_table(
        ("run", "from", "for", "setpoints", "error RMS", "error max"),
        [
            (
                run["name"],
                f"{run['start_s'] - begin:.1f} s",
                f"{run['duration_s']:.1f} s",
                str(run["setpoints"]),
                f"{1e3 * run['rms_m']:.3f} mm",
                f"{1e3 * run['max_m']:.3f} mm",
            )
            for run in runs
        ],
    )


def draw(runs: Sequence[Run], folder: Path) -> list[Path]:
    """Draw Figs. 21 and 22 into `folder`; return their files. GaikError: matplotlib is missing."""
    try:
        from gaik_ros.tracking_figures import draw_joints, draw_paths
    except ImportError:
        raise GaikError("figures need matplotlib, which is not installed: pip install matplotlib") from None
    files = [folder / PATHS, folder / JOINTS]
    draw_paths(runs, files[0])
    draw_joints(runs, files[1])
    return files
