"""The same descent by quaternions and by screw rotors: two ways to compute it, one way through the joints."""

import numpy as np

from gaik_core import GradientDescent, KinematicChain, solve

touch = KinematicChain.load("touch")
start = np.radians([57.29, -57.29, 0.0])  # section 6.2, corrected

traces = [
    solve(touch, [0.05, 0.05, 0.0], start, algebra, GradientDescent(20.0), tolerance=1e-4, trace=True).trace
    for algebra in ("quaternion", "conformal")
]
for update, (q, c) in enumerate(zip(*(trace.error for trace in traces), strict=True)):
    print(f"update {update:2d}: {q * 1e3:7.3f} mm by quaternions, {c * 1e3:7.3f} mm by screw rotors")
print(f"the joints differ by {np.abs(traces[0].angles - traces[1].angles).max():.0e} rad at most")
