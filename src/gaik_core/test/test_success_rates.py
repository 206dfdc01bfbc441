"""How often a solve with restarts finds what can be found: 1000 random reachable targets of a Panda."""

import numpy as np
import pytest
from shipped_urdfs import urdf_of

from gaik_core import KinematicChain, LevenbergMarquardt, Pose, solve


@pytest.fixture(scope="module")
def panda():
    path = urdf_of("example-robot-data", "panda.urdf")
    return KinematicChain.from_urdf(path, base="panda_link0", tip="panda_link8")


@pytest.fixture(scope="module")
def postures(panda):
    return np.random.default_rng(2026).uniform(panda.lower, panda.upper, (1000, panda.dof))


@pytest.mark.parametrize("algebra", ["quaternion", "conformal"])
def test_positions_at_1_mm(panda, postures, algebra):
    options = {"algebra": algebra, "rule": LevenbergMarquardt(), "tolerance": 1e-3, "restarts": 20}
    ends = [solve(panda, target, **options) for target in panda.forward(postures)]
    assert sum(end.converged for end in ends) >= 999
    angles = np.array([end.angles for end in ends])
    assert (angles >= panda.lower).all() and (angles <= panda.upper).all()


@pytest.mark.parametrize("algebra", ["quaternion", "conformal"])
def test_poses_at_1_mm_and_1_mrad(panda, postures, algebra):
    options = {"rule": LevenbergMarquardt(), "tolerance": 1e-3, "orientation_tolerance": 1e-3, "restarts": 20}
    targets = [Pose(*panda.pose(angles)) for angles in postures]
    ends = [solve(panda, target, algebra=algebra, **options) for target in targets]
    assert sum(end.converged for end in ends) >= 995
