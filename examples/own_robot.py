"""A robot of one's own, from YAML: where it can reach, and a path that it follows."""

from pathlib import Path

import numpy as np

from gaik_core import KinematicChain, LevenbergMarquardt, solve, solve_path
from gaik_core.paths import Circle

scara = KinematicChain.load(Path(__file__).with_name("own_robot.yaml"))
rule = LevenbergMarquardt()

for target in ([0.3, 0.1, 0.2], [0.3, 0.1, 0.05], [0.6, 0.0, 0.2]):
    end = solve(scara, target, rule=rule, tolerance=1e-6)
    print(f"{target} -> {end.status}, {end.error * 1e3:.2f} mm away, joints {end.angles.round(3)}")

lap = solve_path(
    scara, Circle(radius=0.05, tilt=0.0, centre=(0.3, 0.0, 0.2)).points(), rule=rule, tolerance=1e-6
)
largest = np.abs(np.diff(lap.angles, axis=0)).max()
print(
    f"circle: {lap.converged.sum()} of 126 points, no joint moves more than {largest:.3f} from one to the next"
)
