"""Compile every kernel now rather than at its first call: ``python -m gaik_core.kernels``."""

import numpy as np

from gaik_core import KinematicChain, LevenbergMarquardt, solve, solve_batch, solve_path
from gaik_core.cga import up
from gaik_core.versors import Translator


def main() -> None:
    """Solve one small problem, and multiply, in every way that has machine code of its own."""
    rule = LevenbergMarquardt()
    chain = KinematicChain.load("planar3")
    target = chain.forward(chain.home)
    many = np.tile(target, (64, 1))
    solve(chain, target, rule=rule, restarts=1)
    solve(chain, target, rule=rule, posture=chain.home)
    solve(chain, target, rule=rule, trace=True)
    solve_path(chain, many, rule=rule)
    solve_batch(chain, many, rule=rule)
    chain.jacobian(chain.home)
    chain.frames(chain.home)
    motor, points = Translator.from_vector([0.0, 0.0, 1.0]), up(many)
    motor.apply(points[0])
    motor * points[0]
    motor * points


if __name__ == "__main__":
    main()
