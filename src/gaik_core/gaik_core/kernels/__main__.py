"""Compile every kernel now rather than at its first call: ``python -m gaik_core.kernels``."""

import numpy as np

from gaik_core import KinematicChain, LevenbergMarquardt, solve, solve_batch, solve_path


def main() -> None:
    """Solve one small problem in every way that has machine code of its own."""
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


if __name__ == "__main__":
    main()
