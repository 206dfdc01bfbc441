"""What the demo leaves: two figures, demo.json, a bag if wanted, and a table for the terminal."""

from __future__ import annotations

from pathlib import Path

from gaik_ros.recorded_bag import write_recordings
from gaik_ros.tracking_figures import draw_joints, draw_paths
from touch_sim.demo_report import table, write_json
from touch_sim.demo_run import Results
from touch_sim.description import touch_urdf

BAG = "run"


def write(results: Results, folder: Path) -> str:
    """Write figures and JSON into `folder`; return the table, with the names of the files."""
    paths, joints, figures = (folder / n for n in ("fig21_path.png", "fig22_joints.png", "demo.json"))
    draw_paths(results.runs, paths)
    draw_joints(results.runs, joints)
    write_json(results, figures)
    return f"{table(results)}\n\nwritten: {paths}, {joints}, {figures}"


def write_bag(results: Results, namespace: str, folder: Path) -> str:
    """Write all that was heard as a bag into `folder`, in the place of an earlier one; return a line that says so.

    Raises BagError where a bag cannot be written there.
    """
    file = write_recordings(folder / BAG, results.recordings, namespace, touch_urdf(), replace=True)
    return f"recorded: {file} (gaik plot {file})"
