"""The way into a solve from Python: all but target and angles in one array, since each that crosses costs 60 ns.

The array holds HEADER numbers (algebra, kind of target, rule, how long each part is, what ends the descent) and after
them the rule's settings and the five arrays of the chain, row by row.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gaik_core.kernels.compiled import compiled, inlined, uncounted
from gaik_core.kernels.descent import IMPROVEMENT, Outcome, Stop, room, solve_once, solve_with_restarts
from gaik_core.kernels.kinematics import Chain

Array = NDArray[np.float64]

HEADER, AXES = 13, 4  # how long the header is, and where it says how many axes there are
AXIS, COUPLING, ENDS, HELD = 11, 3, 12, 3  # columns of a chain's arrays


def pack_problem(algebra: int, chain: Chain, kind: int, stop: Stop, rule: int, settings: Array) -> Array:
    """What a solve takes but for target and angles; read-only."""
    axes, couplings, _, limits, held = chain
    header = np.array(
        [algebra, kind, rule, len(settings), len(axes), len(couplings), limits.shape[1], len(held), *stop],
        dtype=np.float64,
    )
    packed = np.concatenate([header, settings, *(array.ravel() for array in chain)])
    packed.flags.writeable = False
    return packed


@inlined
def unpack_problem(packed: Array) -> tuple[int, Chain, int, Stop, int, Array]:
    """Algebra, chain, kind of target, stop, rule and its settings, as `solve_once` takes them."""
    algebra, kind, rule = int(packed[0]), int(packed[1]), int(packed[2])
    axes, couplings, limited, held = int(packed[AXES]), int(packed[5]), int(packed[6]), int(packed[7])
    stop = (packed[8], packed[9], packed[10], int(packed[11]), int(packed[12]))
    a = HEADER + int(packed[3])
    b = a + AXIS * axes
    c = b + COUPLING * couplings
    d = c + ENDS
    e = d + 2 * limited
    f = e + HELD * held
    chain = (
        packed[a:b].reshape((axes, AXIS)),
        packed[b:c].reshape((couplings, COUPLING)),
        packed[c:d],
        packed[d:e].reshape((2, limited)),
        packed[e:f].reshape((held, HELD)),
    )
    return algebra, chain, kind, stop, rule, packed[HEADER:a]


@uncounted
def _solve_once(
    packed: Array, target: Array, angles: Array, trace_angles: Array, trace_errors: Array, work: Array
) -> Outcome:
    algebra, chain, kind, stop, rule, settings = unpack_problem(packed)
    return solve_once(
        algebra, chain, kind, target, stop, rule, settings, angles, IMPROVEMENT, trace_angles, trace_errors, work,
    )  # fmt: skip


@uncounted
def _solve_with_restarts(
    packed: Array, target: Array, angles: Array, starts: Array, work: Array
) -> tuple[int, int, float, float, int]:
    algebra, chain, kind, stop, rule, settings = unpack_problem(packed)
    return solve_with_restarts(algebra, chain, kind, target, stop, rule, settings, angles, starts, work)


@compiled
def solve_packed(packed: Array, target: Array, angles: Array) -> Outcome:
    """`solve_once` without a trace; `angles` in place."""
    work = np.empty(room(int(packed[AXES]), angles.shape[0]))
    no_trace = work[:0].reshape((0, 2))
    return _solve_once(packed, target, angles, no_trace, no_trace, work)


@compiled
def solve_packed_with_trace(
    packed: Array, target: Array, angles: Array, trace_angles: Array, trace_errors: Array
) -> Outcome:
    """`solve_once`; `angles` in place."""
    work = np.empty(room(int(packed[AXES]), angles.shape[0]))
    return _solve_once(packed, target, angles, trace_angles, trace_errors, work)


@compiled
def solve_packed_with_restarts(
    packed: Array, target: Array, angles: Array, starts: Array
) -> tuple[int, int, float, float, int]:
    """`solve_with_restarts`; `angles` in place."""
    work = np.empty(room(int(packed[AXES]), angles.shape[0]))
    return _solve_with_restarts(packed, target, angles, starts, work)
