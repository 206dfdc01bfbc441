"""The formulas that run inside a loop, compiled by numba where it is installed.

Each kernel is a short pure function of numbers and arrays that the caller owns; it checks nothing. `quaternion` and
`conformal` hold the two algebras, `kinematics` walks a chain by either, `task` measures the error, `rules` makes one
update, `limits` keeps it inside the joint limits, `descent` is the loop. With ``NUMBA_DISABLE_JIT=1``, or without
numba, the same functions run as plain Python.
"""

from gaik_core.kernels.compiled import drop_stale_caches

drop_stale_caches()
