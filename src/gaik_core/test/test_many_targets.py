"""Batches and paths: each answer is the one that `solve` gives, however many there are and wherever they run."""

import os

import numpy as np
import pytest
from chains import ALGEBRAS, inside, random_chain, table1_sphere

from gaik_core import (
    Adam,
    Joint,
    KinematicChain,
    LevenbergMarquardt,
    Solution,
    Status,
    solve,
    solve_batch,
    solve_path,
)
from gaik_core.errors import GaikError, NotFiniteError, ShapeError
from gaik_core.kernels.lane_kinematics import sine_cosine

TOUCH, DEVICE, ARM3 = (KinematicChain.load(name) for name in ("touch", "touch_device", "arm3"))


def limited_arm():
    """Seven axes with limits, one of them sliding, one coupled: what lanes can do, and no more."""
    rng = np.random.default_rng(9)
    joints = [
        Joint(
            f"j{i}",
            tuple(rng.normal(size=3)),
            tuple(0.3 * rng.normal(size=3)),
            kind="prismatic" if i == 3 else "revolute",
            lower=-1.5,
            upper=1.2,
            coupling={"j0": 0.5} if i == 4 else {},
        )
        for i in range(7)
    ]
    return KinematicChain(joints, name="limited")


def uncoupled_arm():
    """Four joints that turn or slide one axis each, from zero on: lanes need not sum anything."""
    rng = np.random.default_rng(5)
    kinds = ["revolute", "prismatic", "revolute", "revolute"]
    joints = [
        Joint(
            f"j{i}",
            tuple(rng.normal(size=3)),
            tuple(0.3 * rng.normal(size=3)),
            kind=kind,
            lower=-2.0,
            upper=1.0,
        )
        for i, kind in enumerate(kinds)
    ]
    return KinematicChain(joints, name="uncoupled")


CHAINS = [
    TOUCH,
    DEVICE,
    ARM3,
    limited_arm(),
    uncoupled_arm(),
    random_chain(np.random.default_rng(3), 9, prismatic=True),
]


@pytest.mark.parametrize("rule", [LevenbergMarquardt(), Adam()], ids=["lanes", "one by one"])
@pytest.mark.parametrize("algebra", ALGEBRAS)
@pytest.mark.parametrize("chain", CHAINS, ids=lambda chain: f"{chain.name}-{chain.dof}")
def test_batch_is_each_solve_by_itself(chain, algebra, rule):
    rng = np.random.default_rng(1)
    targets = np.vstack([chain.forward(inside(chain, rng, 90)), rng.normal(size=(10, 3))])
    starts = inside(chain, rng, 100)
    options = {"algebra": algebra, "rule": rule, "tolerance": 1e-5, "max_iterations": 150, "restarts": 2}
    batch = solve_batch(chain, targets, starts, **options, workers=2)
    assert isinstance(batch, Solution) and batch.angles.shape == (100, chain.dof)
    alike = 0
    for i in range(100):
        one = solve(chain, targets[i], starts[i], **options)
        assert batch.converged[i] == one.converged and batch.status[i] == one.status
        assert batch.error[i] == pytest.approx(
            np.linalg.norm(targets[i] - chain.forward(batch.angles[i])), abs=1e-12
        )
        alike += batch.iterations[i] == one.iterations and np.allclose(batch.angles[i], one.angles, atol=1e-6)
    assert alike >= 95  # a solve that wanders long enough doubles rounding into another way


def test_lanes_leave_to_one_solve_what_they_cannot_do():
    arm = limited_arm()
    far = np.full((40, 3), 9.0)
    assert (solve_batch(arm, far, rule=LevenbergMarquardt()).status == Status.UNREACHABLE).all()
    beyond = solve_batch(DEVICE, np.tile(TOUCH.forward([1.3, 0.5, 0.5]), (40, 1)), rule=LevenbergMarquardt())
    assert (beyond.status == Status.LIMITED).all()


def test_batch_holds_limits():
    arm = limited_arm()
    targets = np.random.default_rng(2).uniform(-1, 1, (200, 3))
    for rule in (LevenbergMarquardt(), Adam()):
        angles = solve_batch(arm, targets, rule=rule, max_iterations=100).angles
        assert (angles >= arm.lower).all() and (angles <= arm.upper).all()


def test_the_answer_does_not_hang_on_the_size_of_the_batch():
    """Fewer targets than lanes are solved one by one; this one stagnates before it would be reached."""
    limits = {"lower": -1.5, "upper": 1.5}
    arm = KinematicChain(
        [
            Joint("a", (0, 0, 1), (0.0, 0.1, -0.4), **limits),
            Joint("b", (0, 1, 0), (-0.3, 0.0, -0.2), **limits),
            Joint("c", (1, 0, 0), (0.5, 0.2, -0.5), **limits),
        ]
    )
    target, options = (
        [-0.08952199, 0.35801341, -1.09101969],
        {"rule": LevenbergMarquardt(), "tolerance": 1e-4},
    )
    one = solve(arm, target, **options)
    for size in (1, 15, 16, 40):
        batch = solve_batch(arm, np.tile(target, (size, 1)), **options)
        assert (batch.status == one.status).all() and (batch.iterations == one.iterations).all()
        assert batch.angles == pytest.approx(np.tile(one.angles, (size, 1)), abs=1e-6)


def test_where_the_system_cannot_say_which_processors_are_free(monkeypatch):
    monkeypatch.delattr(os, "sched_getaffinity")  # as on macOS and Windows
    assert solve_batch(TOUCH, np.tile([0.05, 0.05, 0.0], (500, 1)), rule=LevenbergMarquardt()).converged.all()


def test_workers_change_nothing():
    targets = np.random.default_rng(2).uniform(-0.2, 0.2, (1000, 3))
    alone, shared = (solve_batch(TOUCH, targets, rule=LevenbergMarquardt(), workers=n) for n in (1, 2))
    assert np.array_equal(alone.angles, shared.angles) and np.array_equal(alone.iterations, shared.iterations)


def test_sine_and_cosine_of_the_lanes():
    values = np.concatenate(
        [np.linspace(-60, 60, 20001), np.pi / 4 * np.arange(-400, 401), [0.0, -0.0, 1e-300, 9e4]]
    )
    found = np.array([sine_cosine(value) for value in values])
    expected = np.stack([np.sin(values), np.cos(values)], axis=1)
    either_sign = np.stack([found - expected, found + expected])
    assert np.abs(either_sign).max(axis=2).min(axis=0).max() < 3e-16


def test_table_1_in_one_batch():
    batch = solve_batch(ARM3, table1_sphere(), np.radians([0.0, 90.0, 0.0]))
    assert batch.converged.all() and np.mean(batch.iterations) == pytest.approx(50.3, abs=0.05)


def test_start_may_be_one_for_each():
    starts = np.random.default_rng(0).uniform(0, 1, (50, 3))
    for rule in (LevenbergMarquardt(), Adam()):
        batch = solve_batch(TOUCH, TOUCH.forward(starts), starts, rule=rule)
        assert (batch.iterations == 0).all() and np.array_equal(batch.angles, starts)


def test_path_is_each_solve_started_from_the_one_before():
    targets = TOUCH.forward(np.linspace([0, 0.5, 0.5], [0.5, 0.9, 0.2], 20))
    path = solve_path(TOUCH, targets, [0, 0.5, 0.5], tolerance=1e-6, rule=LevenbergMarquardt())
    assert path.converged.all() and path.angles.shape == (20, 3) and path.error.shape == (20,)
    start = np.array([0, 0.5, 0.5])
    for target, angles in zip(targets, path.angles, strict=True):
        end = solve(TOUCH, target, start, tolerance=1e-6, rule=LevenbergMarquardt())
        assert np.allclose(end.angles, angles, atol=1e-12)
        start = end.angles


@pytest.mark.parametrize("rule", [LevenbergMarquardt(), LevenbergMarquardt(damping=1e-6, bias=1e-12)])
def test_path_does_not_flip_to_another_branch(rule):
    """Straight ways across the workspace, coarse, and by a rule that leaps: no joint jumps while the arm can follow."""
    rng = np.random.default_rng(4)
    leaps = 0
    for _ in range(60):
        ends = inside(DEVICE, rng, 2)
        targets = np.linspace(*TOUCH.forward(ends), 6)
        path = solve_path(TOUCH, targets, ends[0], rule=rule, tolerance=1e-6)
        fine = solve_path(TOUCH, np.linspace(*TOUCH.forward(ends), 2001), ends[0], rule=rule, tolerance=1e-6)
        if fine.converged.all() and np.abs(np.diff(fine.angles, axis=0)).max() < 0.1:
            leaps += 1
            assert path.converged.all() and np.allclose(path.angles, fine.angles[::400], atol=1e-3)
    assert leaps >= 30


def test_path_says_where_it_cannot_follow():
    """One joint, and a target on the other side of its circle: only a jump leads there."""
    crank = KinematicChain([Joint("crank", (0, 0, 1), (1.0, 0.0, 0.0))])
    path = solve_path(
        crank, [[1.0, 0.0, 0.0], [-1.0, 0.01, 0.0]], [0.0], rule=LevenbergMarquardt(), tolerance=0.02
    )
    assert path.converged.tolist() == [True, False]
    assert path.status[1] != Status.CONVERGED and path.angles[1] == path.angles[0]
    assert path.error[1] == pytest.approx(np.linalg.norm([-1.0, 0.01] - crank.forward(path.angles[1])[:2]))


@pytest.mark.parametrize("many", [solve_path, solve_batch])
class TestBadArguments:
    def test_of_many_targets(self, many):
        with pytest.raises(ShapeError, match=r"targets has shape \(3,\); expected \(m, 3\)"):
            many(TOUCH, [0, 0, 0])
        with pytest.raises(
            NotFiniteError, match=r"^targets\[2\] is \[0.0, 0.0, nan\]; every element must be finite$"
        ):
            many(TOUCH, [[0, 0, 0], [0, 0, 0], [0, 0, np.nan], [np.inf, 0, 0]])
        with pytest.raises(GaikError, match="tolerance is 0"):
            many(TOUCH, [[0, 0, 0]], tolerance=0)
        with pytest.raises(ShapeError, match="start has shape"):
            many(TOUCH, [[0, 0, 0]], [0, 0])
        with pytest.raises(NotFiniteError, match="start"):
            many(TOUCH, [[0, 0, 0]], [0, 0, np.inf])

    def test_none_at_all_is_no_error(self, many):
        nothing = many(TOUCH, np.empty((0, 3)))
        assert nothing.angles.shape == (0, 3) and nothing.converged.shape == (0,)
