"""Compile every kernel now rather than at its first call: ``python -m gaik_core.kernels``."""

from gaik_core import KinematicChain, LevenbergMarquardt, solve


def main() -> None:
    """Solve one small problem in every way that has machine code of its own."""
    chain = KinematicChain.load("touch_device")
    target = chain.forward(chain.home)
    for restarts in (0, 1):
        solve(chain, target, rule=LevenbergMarquardt(), restarts=restarts)
    chain.jacobian(chain.home)
    chain.frames(chain.home)


if __name__ == "__main__":
    main()
