"""What the demo leaves: two figures, demo.json, and a table for the terminal."""

from __future__ import annotations

from pathlib import Path

from gaik_ros.tracking_figures import draw_joints, draw_paths
from touch_sim.demo_report import table, write_json
from touch_sim.demo_run import Results


def write(results: Results, folder: Path) -> str:
    """Write figures and JSON into `folder`; return the table, with the names of the files."""
    paths, joints, figures = (folder / n for n in ("fig21_path.png", "fig22_joints.png", "demo.json"))
    draw_paths(results.runs, paths)
    draw_joints(results.runs, joints)
    write_json(results, figures)
    return f"{table(results)}\n\nwritten: {paths}, {joints}, {figures}"
