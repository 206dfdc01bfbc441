"""What gain and what delay the sampled loop of one joint bears, and what a stiff joint leaves: PID and twin, stepped.

The paper prints three gains (6.3) and says nothing of the derivative's filter or of the axis they were tuned on.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gaik_ros.pid import Gains, Pid
from touch_sim.dynamics import JointDynamics, JointModel
from touch_sim.joint_limits import JointLimits

Array = NDArray[np.float64]

DT = 1e-3  # s, the loop's step
ERROR = 1e-3  # rad, the first one
WATCHED = 2.0  # s; the slowest loop looked at here settles ten times over
LIMIT = 1e6  # N·m: as good as none
TIME_CONSTANT = 0.05  # s, τ of the twin

GRID: Array = np.arange(0.25, 80.0, 0.25)  # 1/s, loop gains K/τ that are tried
MOST_DELAY = 30  # steps


def largest_gain(filter_time: float, delay: int) -> float:
    """Return the largest K/τ in 1/s up to which each loop comes to rest, to 0.25; 0 where none does."""
    return _last_settled(GRID, settles(GRID, np.full(GRID.shape, delay), filter_time))


def longest_delay(filter_time: float, mobility: float = 1.0 / TIME_CONSTANT) -> float:
    """Return the longest delay of the joint's angle in s up to which the loop of K/τ = `mobility` comes to rest.

    -1 ms where it does not even without delay.
    """
    delays = np.arange(MOST_DELAY + 1)
    settled = settles(np.full(delays.shape, mobility), delays, filter_time)
    return _last_settled(np.asarray(DT * delays), settled, otherwise=-DT)


def _last_settled(values: Array, settled: NDArray[np.bool_], otherwise: float = 0.0) -> float:
    count = len(values) if settled.all() else int(np.argmin(settled))
    return float(values[count - 1]) if count else otherwise


def settles(mobility: ArrayLike, delay: ArrayLike, filter_time: float) -> NDArray[np.bool_]:
    """Whether loops (n,) of K/τ = `mobility` in 1/s come to rest from a small error, by the paper's gains.

    The controller knows the angle of `delay` steps (n,) ago; `filter_time` in s is the derivative's, 0 for none.
    """
    mobility, delay = np.broadcast_arrays(np.asarray(mobility, dtype=float), np.asarray(delay, dtype=int))
    joints = np.arange(mobility.size)
    steps = round(WATCHED / DT)
    angles = np.full((steps + 1, mobility.size), ERROR)
    gains = Gains(filter_time=filter_time, output_min=-LIMIT, output_max=LIMIT)
    pid, twin = Pid(mobility.size, gains, blend_time=0.0), _twin(mobility * TIME_CONSTANT, ERROR, LIMIT)
    for now in range(steps):
        known = angles[np.maximum(now - delay, 0), joints]
        twin.step(pid.step(-known, DT), DT)
        angles[now + 1] = twin.angles
    return np.asarray(np.abs(angles[-steps // 4 :]).max(axis=0) < 0.5 * ERROR)


def remaining_share(stiffness: float, seconds: float = 5.0) -> float:
    """Return the share of a small step that is left after so many seconds with κ = `stiffness`."""
    pid, twin = Pid(1, Gains(), blend_time=0.0), _twin(np.ones(1), 0.0, LIMIT, stiffness)
    for _ in range(round(seconds / DT)):
        twin.step(pid.step(ERROR - twin.angles, DT), DT)
    return float(1.0 - twin.angles[0] / ERROR)


def _twin(gain: Array, start: float, effort_limit: float, stiffness: float = 0.0) -> JointDynamics:
    free = np.full(gain.shape, np.inf)
    model = JointModel(gain, TIME_CONSTANT, stiffness, effort_limit)
    return JointDynamics(model, JointLimits.of_joints(-free, free), np.full(gain.shape, start))
