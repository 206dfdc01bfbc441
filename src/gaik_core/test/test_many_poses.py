"""Batches and paths of poses and directions: each answer is one that `solve` gives, and no joint jumps on the way."""

import numpy as np
import pytest
from chains import ALGEBRAS, random_chain

from gaik_core import (
    KinematicChain,
    LevenbergMarquardt,
    Motor,
    Pointing,
    Pose,
    Quaternion,
    Status,
    solve,
    solve_batch,
    solve_path,
)
from gaik_core.errors import GaikError

ARM = random_chain(np.random.default_rng(4), 7)
FINE = {"rule": LevenbergMarquardt(), "tolerance": 1e-6, "orientation_tolerance": 1e-6}


def poses(angles):
    return [Pose(*ARM.pose(each)) for each in angles]


def pointings(angles):
    """The tool's axis z where those angles have it."""
    return [Pointing(p, Quaternion(q).rotate([0.0, 0.0, 1.0])) for p, q in map(ARM.pose, angles)]


def motors(angles):
    positions, orientations = ARM.pose(angles)
    return Motor.from_rotation_translation(orientations, positions)


@pytest.mark.parametrize("algebra", ALGEBRAS)
@pytest.mark.parametrize("make", [poses, pointings, motors])
def test_batch_is_each_solve_by_itself(make, algebra):
    targets = make(np.random.default_rng(1).uniform(-1.0, 1.0, (40, 7)))
    batch = solve_batch(ARM, targets, algebra=algebra, restarts=5, workers=2, **FINE)
    assert batch.converged.mean() > 0.9
    for i, target in enumerate(targets):
        one = solve(ARM, target, algebra=algebra, restarts=5, **FINE)
        assert batch.status[i] == one.status and batch.iterations[i] == one.iterations
        assert batch.angles[i] == pytest.approx(one.angles, abs=1e-9)
        assert (batch.error[i], batch.orientation_error[i]) == pytest.approx(
            (one.error, one.orientation_error)
        )


@pytest.mark.parametrize("algebra", ALGEBRAS)
@pytest.mark.parametrize("make", [poses, pointings, motors])
def test_path_follows_and_does_not_flip(make, algebra):
    """Coarse steps, each of which is walked in pieces where the joints would jump."""
    way = np.linspace(np.full(7, 0.2), np.full(7, 1.2), 9)
    path = solve_path(ARM, make(way), way[0], algebra=algebra, largest_step=0.3, **FINE)
    assert path.converged.all()
    assert (path.error < 1e-6).all() and (path.orientation_error < 1e-6).all()
    assert np.abs(np.diff(path.angles, axis=0)).max() < 0.6


def test_a_quaternion_and_its_negative_are_one_orientation_on_a_path():
    """Half way between q and -q there is no rotation, and none is to be made."""
    positions, orientations = ARM.pose(np.linspace(np.full(7, 0.2), np.full(7, 0.8), 6))
    signs = np.array([1.0, -1.0, 1.0, -1.0, -1.0, 1.0])[:, None]
    plain, turned = (
        solve_path(
            ARM,
            [Pose(p, q) for p, q in zip(positions, given, strict=True)],
            np.full(7, 0.2),
            largest_step=0.1,
            **FINE,
        )
        for given in (orientations, signs * orientations)
    )
    assert plain.converged.all() and np.allclose(plain.angles, turned.angles, atol=1e-9)


def test_a_path_of_poses_says_where_it_cannot_follow():
    planar = KinematicChain.load("planar3")
    tipped = [Pose(*planar.pose([0.1, 0.2, 0.3])), Pose([0.1, 0.1, 0.0], [0.0, 1.0, 0.0, 0.0])]
    path = solve_path(planar, tipped, [0.1, 0.2, 0.3], rule=LevenbergMarquardt())
    assert path.converged.tolist() == [True, False]
    assert path.status[1] == Status.STAGNATED and np.isfinite(path.angles).all()


@pytest.mark.parametrize("many", [solve_batch, solve_path])
@pytest.mark.parametrize(
    ("targets", "message"),
    [
        (Pose([0, 0, 0]), "targets is one Pose; expected a sequence of them"),
        (Motor.identity(), "targets is one Motor; expected a sequence of them"),
        (
            [Pose([0, 0, 0]), Pointing([0, 0, 0], [0, 0, 1])],
            "targets are Pointings and Poses or Motors; expected one kind",
        ),
        ([Pose([0, 0, 0]), [0, 0, 0]], "targets are positions and Poses or Motors"),
        ([Pose([0, 0, 0]), Pose([0, 0, np.nan])], r"targets\[1\]: position is"),
        ([Pose([0, 0, 0]), "there"], r"targets\[1\]: target is 'there'"),
    ],
)
def test_what_is_no_sequence_of_one_kind_is_said(many, targets, message):
    with pytest.raises(GaikError, match=message):
        many(ARM, targets)


@pytest.mark.parametrize("many", [solve_batch, solve_path])
def test_their_tolerance_and_weight_are_checked(many):
    for name in ("orientation_tolerance", "orientation_weight"):
        with pytest.raises(GaikError, match=f"{name} is 0"):
            many(ARM, [Pose([0, 0, 0])], **{name: 0})
