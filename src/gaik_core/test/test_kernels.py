"""Compiled and plain runs of the same kernels give the same numbers, and the cache notices a changed source."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest

from gaik_core import kernels

SOLVES = """
import json
from gaik_core import RULES, KinematicChain, Pose, solve
ends = []
for robot in ("touch", "touch_device", "arm5"):
    chain = KinematicChain.load(robot)
    target = chain.forward(chain.home + 0.2)
    for name, rule in RULES.items():
        for algebra in ("quaternion", "conformal"):
            end = solve(chain, target, None, algebra, rule(), 1e-4, 15)
            ends.append([*end.angles, end.error, end.iterations])
print(json.dumps(ends))
"""


def solves(**environment):
    done = subprocess.run(
        [sys.executable, "-c", SOLVES],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(done.stdout)


def test_plain_python_gives_the_same_numbers():
    compiled, plain = solves(NUMBA_DISABLE_JIT="0"), solves(NUMBA_DISABLE_JIT="1")
    assert len(compiled) == len(plain)
    for one, other in zip(compiled, plain, strict=True):
        assert one == pytest.approx(other, rel=1e-9, abs=1e-12)


MANY = """
import numpy as np
from gaik_core import KinematicChain, LevenbergMarquardt, solve, solve_batch, solve_path
rule, draw = LevenbergMarquardt(), np.random.default_rng(0)
for robot in ("touch_device", "arm5"):
    chain = KinematicChain.load(robot)
    targets = chain.forward(draw.uniform(-0.5, 0.5, (200, chain.dof)) + chain.home)
    def all_ends():
        return np.concatenate([
            [solve(chain, t, rule=rule, restarts=3).angles for t in targets],
            [solve(chain, 9.0 * t, rule=rule, restarts=3, max_iterations=50).angles for t in targets],
            [solve(chain, t, rule=rule, trace=True).angles for t in targets],
            solve_path(chain, targets, rule=rule).angles, solve_batch(chain, targets, rule=rule, restarts=3).angles])
    first = all_ends()
    for _ in range(20):
        assert (all_ends() == first).all()
"""


def test_thousands_of_solves_leave_memory_whole():
    """Kernels that count no references would free what they do not own: the allocator then ends the process."""
    done = subprocess.run(
        [sys.executable, "-c", MANY],
        env={**os.environ, "MALLOC_PERTURB_": "165"},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr


def test_without_numba_it_warns_once_and_works():
    code = f"import sys; sys.modules['numba'] = None\n{SOLVES}"
    done = subprocess.run(
        [sys.executable, "-W", "always", "-c", code], capture_output=True, text=True, check=True
    )
    assert done.stderr.count("numba is not installed") == 1
    assert np.allclose([e[-2] for e in json.loads(done.stdout)], [e[-2] for e in solves()], atol=1e-9)


def test_machine_code_older_than_a_source_is_dropped(tmp_path, monkeypatch):
    from gaik_core.kernels import compiled

    (tmp_path / "__pycache__").mkdir()
    source, stale, fresh = tmp_path / "a.py", tmp_path / "__pycache__/b.nbi", tmp_path / "__pycache__/c.nbi"
    for path, age in ((stale, 100), (source, 50), (fresh, 0)):
        path.touch()
        os.utime(path, (1e9 - age, 1e9 - age))
    monkeypatch.setattr(compiled, "__file__", str(tmp_path / "compiled.py"))
    kernels.drop_stale_caches()
    assert fresh.exists() and not stale.exists()
