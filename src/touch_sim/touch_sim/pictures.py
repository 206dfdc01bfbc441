"""The pictures of the README and the docs, from one run of the real nodes.

    python -m touch_sim.pictures        make pictures

demo_path.png is the paper's Fig. 21; demo.gif shows the arm while it follows, in the time it took.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.figure import Figure
from numpy.typing import NDArray

from gaik_core import KinematicChain
from gaik_core.experiments.drawing import STYLE, save
from gaik_ros.tracking import Run, tracking_error
from gaik_ros.tracking_figures import DESIRED, FOLLOWED, paths_figure, space_in_mm

Array = NDArray[np.float64]

PATH_PICTURE, MOVING_PICTURE = "demo_path.png", "demo.gif"
PANEL, PATH_DPI = 4.6, 132  # inches and dots per inch: 1214 dots across
SIZE, DPI = (4.2, 3.9), 100
FRAMES = 10  # a second
ARM: dict[str, Any] = {"color": "0.35", "linewidth": 4.0, "marker": "o", "markersize": 6, "zorder": 5}
ONCE_FOLLOWED = "#f0b0a8"  # the path before this one


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the nodes and draw; returns the exit code."""
    parser = argparse.ArgumentParser(
        prog="pictures", description="Run the demo and draw the README's pictures."
    )
    parser.add_argument(
        "--out", type=Path, default=Path("docs/images"), metavar="DIR", help="where to (docs/images)"
    )
    folder: Path = parser.parse_args(arguments).out
    try:
        folder.mkdir(parents=True, exist_ok=True)
        runs = follow()
        files = [draw_path_picture(runs, folder), draw_moving_picture(runs, folder)]
    except (OSError, RuntimeError) as reason:
        print(f"pictures: {reason}", file=sys.stderr)
        return 1
    for run in runs:
        print(f"{run.name}: error {1e3 * tracking_error(run).rms_m:.3f} mm RMS")
    print(f"written: {', '.join(map(str, files))}")
    return 0


def follow() -> tuple[Run, ...]:
    """Follow both paths with the real nodes."""
    from touch_sim.demo_progress import progress_for
    from touch_sim.isolation import follow_isolated
    from touch_sim.suite import SuiteOptions

    return follow_isolated(SuiteOptions(), ("circle", "lemniscate"), progress=progress_for(sys.stderr)).runs


def draw_path_picture(runs: Sequence[Run], folder: Path) -> Path:
    """Write the paths in space; return the file."""
    file = folder / PATH_PICTURE
    save(partial(paths_figure, runs, PANEL), file, PATH_DPI)
    return file


def draw_moving_picture(runs: Sequence[Run], folder: Path, robot: str = "touch_device") -> Path:
    """Write the arm in motion; return the file."""
    file = folder / MOVING_PICTURE
    with mpl.rc_context(STYLE):
        scene = Scene(runs, KinematicChain.load(robot))
        frames = [(number, time) for number, run in enumerate(runs) for time in frame_times(run)]
        animation = FuncAnimation(scene.figure, lambda frame: scene.show(*frame), frames, blit=False)
        animation.save(file, PillowWriter(fps=FRAMES), dpi=DPI)
    return file


def frame_times(run: Run) -> Array:
    """The times (n,) of a run's pictures, in s on its clock."""
    return np.arange(run.course.start, run.course.end, 1.0 / FRAMES)


class Scene:
    """The arm in space, the path it follows, and what it has followed so far."""

    def __init__(self, runs: Sequence[Run], chain: KinematicChain) -> None:
        self._runs, self._chain = runs, chain
        self.figure = Figure(figsize=SIZE)
        self._axes = self.figure.add_axes((0.0, 0.0, 1.0, 0.94), projection="3d")
        self._desired, self._before, self._followed, self._arm = (
            self._axes.plot([], [], [], **style)[0]
            for style in (
                DESIRED | {"linewidth": 1.0},
                {"color": ONCE_FOLLOWED, "linewidth": 1.2},
                FOLLOWED | {"linewidth": 2.0},
                ARM,
            )
        )
        self._show_whole_arm()
        self._axes.legend(handles=[self._desired, self._followed], loc="upper left", frameon=False)

    def _show_whole_arm(self) -> None:
        """Choose axes that hold every pose and path, of one scale."""
        poses = [self._frames(angles) for run in self._runs for angles in run.joint_states.values[::100]]
        tips = [1e3 * run.tip.values[::10] for run in self._runs]
        points = np.concatenate([*poses, *tips])
        low, high = points.min(axis=0), points.max(axis=0)
        space_in_mm(self._axes, (low + high) / 2.0, 0.5 * (high - low).max(), zoom=0.84)

    def _frames(self, angles: Array) -> Array:
        return 1e3 * self._chain.frames(angles)

    def show(self, number: int, time: float) -> None:
        """Show the run of this number at `time` s of its clock."""
        run = self._runs[number]
        lap = run.tip.between(run.course.start, time)
        self._draw(
            self._desired, 1e3 * run.course.desired(np.linspace(run.course.start, run.course.end, 200))
        )
        self._draw(self._followed, 1e3 * lap.values[::10])
        if number:
            self._draw(self._before, 1e3 * self._runs[number - 1].tip.values[::20])
        measured = max(0, int(np.searchsorted(run.joint_states.time, time, side="right")) - 1)
        self._draw(self._arm, self._frames(run.joint_states.values[measured]))
        self._axes.set_title(f"{run.name}, {time - run.course.start:.1f} s")

    @staticmethod
    def _draw(line: Any, points: Array) -> None:
        line.set_data_3d(*points.T)


if __name__ == "__main__":
    sys.exit(main())
