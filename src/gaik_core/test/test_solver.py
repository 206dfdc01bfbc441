"""Solving: what the paper's corrected experiments give, the promises of Solution, and what must never happen."""

from dataclasses import replace

import numpy as np
import pytest
from chains import ALGEBRAS, ROBOTS, inside, random_chain, table1_sphere

from gaik_core import (
    RULES,
    Adam,
    GradientDescent,
    Joint,
    KinematicChain,
    LevenbergMarquardt,
    Pointing,
    Pose,
    Status,
    rule_by_name,
    solve,
)
from gaik_core.errors import GaikError, NotFiniteError, ShapeError, UnknownNameError
from gaik_core.quaternion import rotate
from gaik_core.solver import random_starts

TOUCH, DEVICE = KinematicChain.load("touch"), KinematicChain.load("touch_device")
PLANAR, ARM3 = KinematicChain.load("planar2"), KinematicChain.load("arm3")


@pytest.mark.parametrize("algebra", ALGEBRAS)
class TestThePaper:
    """Numbers that were checked independently of this project (the paper's own, corrected)."""

    def descend(self, start, alpha, iterations, algebra):
        rule = GradientDescent(alpha)
        target = [0.0292, 0.1267, 0.0]
        return solve(PLANAR, target, np.radians(start), algebra, rule, 1e-12, iterations)

    def test_section_3_4_with_the_printed_step(self, algebra):
        end = self.descend([-100, 30], 10.0, 30, algebra)
        assert end.iterations == 30 and not end.converged and end.status == Status.ITERATION_LIMIT
        assert end.error == pytest.approx(0.02096, abs=5e-6)
        assert np.degrees(end.angles) == pytest.approx([16.574, 112.618], abs=5e-4)

    def test_section_3_4_with_the_step_that_gives_the_printed_result(self, algebra):
        end = self.descend([-100, 30], 50.0, 30, algebra)
        assert np.degrees(end.angles) == pytest.approx([27.5430, 98.9433], abs=5e-5)
        assert end.error == pytest.approx(5.9e-5, abs=5e-7)

    @pytest.mark.parametrize(
        ("start", "end"),
        [
            ([-100, 30], [27.5715, 98.9008]),
            ([-100, -30], [-233.5277, -98.9008]),
            ([-50, -50], [126.4723, -98.9008]),
        ],
    )
    def test_section_3_4_which_start_leads_where(self, algebra, start, end):
        found = self.descend(start, 50.0, 5000, algebra)
        assert np.degrees(found.angles) == pytest.approx(end, abs=1e-4)

    def test_section_5_3_first_test(self, algebra):
        links = [(0, 0, 0), (0.4, 0, 0), (0, -0.4, 0)]
        arm = KinematicChain(
            [Joint(j.name, j.axis, link) for j, link in zip(ARM3.joints, links, strict=True)]
        )
        start = np.radians([180.0, 0.0, 90.0])
        end = solve(arm, [0.2, 0.4, 0.2], start, algebra, GradientDescent(0.5), 1e-3)
        assert end.iterations == 170
        exact = solve(arm, [0.2, 0.4, 0.2], start, algebra, GradientDescent(0.5), 1e-8, 5000)
        assert np.degrees(exact.angles) == pytest.approx([225.0, 73.0256, 194.4775], abs=1e-4)

    def test_table_1(self, algebra):
        home = np.radians([0.0, 90.0, 0.0])
        updates = [solve(ARM3, p, home, algebra, Adam(0.05), 5e-3).iterations for p in table1_sphere()]
        assert np.mean(updates) == pytest.approx(50.3, abs=0.05)
        assert (min(updates), max(updates)) == (6, 76)

    def test_section_6_2(self, algebra):
        start = np.radians([57.29, -57.29, 0.0])
        end = solve(TOUCH, [0.05, 0.05, 0.0], start, algebra, GradientDescent(20.0), 1e-4)
        assert end.converged and end.iterations == 24
        zero = solve(TOUCH, [0, 0, 0], start, algebra, GradientDescent(20.0), 1e-8, 5000)
        assert np.degrees(zero.angles) == pytest.approx([0, 42.11, 31.16], abs=5e-3)


@pytest.mark.parametrize("name", RULES)
def test_both_algebras_take_the_same_way(name):
    """Iterate by iterate, not at the end: with limits, without, and for every kind of target.

    Not for ever: a rule that swings about its goal, as RMSProp does, doubles any rounding at each swing.
    """
    rng = np.random.default_rng(5)
    rule = rule_by_name(
        name, 0.02 if name in ("momentum", "nesterov") else None
    )  # a step at which none diverges
    arm = random_chain(rng, 7)
    position, orientation = arm.pose(arm.home + 0.3)
    direction = rotate(orientation, [0, 0, 1])
    problems = [
        (DEVICE, DEVICE.forward(inside(DEVICE, rng, 1)[0])),
        (TOUCH, TOUCH.forward(rng.uniform(-1, 1, 3))),
    ]
    problems += [
        (arm, target) for target in (position, Pose(position, orientation), Pointing(position, direction))
    ]
    for robot, target in problems:
        ends = [solve(robot, target, None, algebra, rule, 1e-5, 30, trace=True) for algebra in ALGEBRAS]
        by_quaternions, by_screw_rotors = (end.trace for end in ends)
        assert by_quaternions.angles.shape == by_screw_rotors.angles.shape
        assert np.abs(by_quaternions.angles - by_screw_rotors.angles).max() < 1e-9


@pytest.mark.parametrize("algebra", ALGEBRAS)
@pytest.mark.parametrize("robot", ROBOTS)
class TestSolution:
    def test_says_the_truth(self, robot, algebra):
        chain = KinematicChain.load(robot)
        rng = np.random.default_rng(7)
        converged = 0
        for angles in inside(chain, rng, 30):
            target = chain.forward(angles)
            end = solve(chain, target, algebra=algebra, rule=LevenbergMarquardt(), tolerance=1e-6)
            assert end.error == pytest.approx(np.linalg.norm(target - chain.forward(end.angles)), abs=1e-12)
            assert end.converged == (end.error < 1e-6) == (end.status == Status.CONVERGED)
            converged += end.converged
        assert converged >= 15

    def test_trace_holds_every_iterate(self, robot, algebra):
        chain = KinematicChain.load(robot)
        target = chain.forward(chain.home + 0.1)
        end = solve(chain, target, algebra=algebra, trace=True)
        assert end.trace.angles.shape == (end.iterations + 1, chain.dof)
        assert end.trace.error.shape == (end.iterations + 1,)
        assert np.array_equal(end.trace.angles[0], chain.home)
        assert np.array_equal(end.trace.angles[-1], end.angles)
        distances = np.linalg.norm(target - chain.forward(end.trace.angles), axis=1)
        assert np.allclose(end.trace.error, distances, atol=1e-12)
        without = solve(chain, target, algebra=algebra)
        assert without.trace is None
        assert np.array_equal(without.angles, end.angles) and without.iterations == end.iterations

    def test_zero_iterations_where_the_start_is_good(self, robot, algebra):
        chain = KinematicChain.load(robot)
        start = chain.home.copy()
        end = solve(chain, chain.forward(start), start, algebra)
        assert end.iterations == 0 and end.converged and np.array_equal(end.angles, start)
        assert end.angles is not start


def test_the_start_is_never_changed_nor_wrapped():
    start = np.array([0.2 + 4 * np.pi, 0.6, 0.6])
    kept = start.copy()
    end = solve(TOUCH, [0.03, 0.02, 0.01], start, tolerance=1e-6, rule=LevenbergMarquardt())
    assert np.array_equal(start, kept)
    assert end.converged and abs(end.angles[0] - start[0]) < np.pi


def test_half_the_squared_distance_is_the_loss():
    """One update by α: θ + α Jᵀ e, with no factor 2 (eqs. 34 and 53)."""
    start, target = np.array([0.3, -0.2, 0.4]), np.array([0.05, 0.05, 0.0])
    one = solve(TOUCH, target, start, rule=GradientDescent(20.0), tolerance=1e-9, max_iterations=1)
    step = 20.0 * TOUCH.jacobian(start).T @ (target - TOUCH.forward(start))
    assert np.allclose(one.angles, start + step, atol=1e-15)


class TestUnreachable:
    @pytest.mark.parametrize("rule", [LevenbergMarquardt(), GradientDescent(), Adam(0.05)])
    def test_too_far_is_proved_and_answered_with_the_nearest(self, rule):
        base = np.array([0.0, 0.025, -0.17])
        far = base + np.array([0.1, 0.2, 0.9])
        end = solve(TOUCH, far, [0.1, 0.5, 1.0], rule=rule, max_iterations=20000)
        assert end.status == Status.UNREACHABLE and not end.converged
        assert np.isfinite(end.angles).all()
        assert end.error == pytest.approx(np.linalg.norm(far - base) - 0.27, rel=0.02)

    def test_in_the_hole_around_the_base(self):
        arm = KinematicChain([Joint("a", (0, 0, 1), (0.3, 0, 0)), Joint("b", (0, 0, 1), (0.1, 0, 0))])
        assert solve(arm, [0.05, 0.0, 0.0], [0.1, 0.2]).status == Status.UNREACHABLE
        assert solve(arm, [0.25, 0.0, 0.0], [0.1, 0.2], rule=LevenbergMarquardt()).converged

    def test_what_lengths_cannot_prove_stagnates(self):
        end = solve(PLANAR, [0.05, 0.05, 0.05], [0.3, 0.4], rule=LevenbergMarquardt())
        assert end.status == Status.STAGNATED and end.error == pytest.approx(0.05, abs=1e-5)

    @pytest.mark.parametrize("target", [[1e308, 0, 0], [-1e200, 1e200, 1e-300]])
    @pytest.mark.parametrize("name", RULES)
    def test_absurd_targets_end_finite(self, target, name):
        for chain in (TOUCH, DEVICE, PLANAR):
            end = solve(chain, target, rule=RULES[name](), max_iterations=300)
            assert end.status in (Status.UNREACHABLE, Status.STAGNATED) and np.isfinite(end.angles).all()


class TestLimits:
    @pytest.mark.parametrize("name", RULES)
    def test_hold_at_every_iterate_of_joints_and_axes(self, name):
        rng = np.random.default_rng(3)
        for target in rng.uniform(-0.25, 0.25, (40, 3)):
            end = solve(
                DEVICE, target, rng.uniform(-2, 3, 3), rule=RULES[name](), max_iterations=80, trace=True
            )
            turned = DEVICE.axis_angles(end.trace.angles)
            assert (end.trace.angles >= DEVICE.lower).all() and (end.trace.angles <= DEVICE.upper).all()
            assert (turned >= DEVICE.axis_lower - 1e-9).all() and (turned <= DEVICE.axis_upper + 1e-9).all()

    def test_limited_where_only_limits_stand_between(self):
        beyond = TOUCH.forward([1.3, 0.5, 0.5])
        end = solve(DEVICE, beyond, rule=LevenbergMarquardt())
        assert end.status == Status.LIMITED and end.angles[0] == pytest.approx(0.98)
        assert solve(DEVICE, beyond, rule=LevenbergMarquardt(), limits=False).converged

    def test_reachable_targets_are_found_despite_limits(self):
        angles = inside(DEVICE, np.random.default_rng(11), 300)
        ends = [
            solve(DEVICE, p, rule=LevenbergMarquardt(), tolerance=1e-6, restarts=20)
            for p in DEVICE.forward(angles)
        ]
        assert all(end.converged for end in ends)


class TestRestarts:
    def test_find_what_one_descent_misses_and_are_repeatable(self):
        rng = np.random.default_rng(1)
        chain = random_chain(rng, 6)
        targets = [Pose(*chain.pose(angles)) for angles in rng.uniform(-np.pi, np.pi, (30, 6))]
        rule = LevenbergMarquardt()
        alone = [solve(chain, target, rule=rule, tolerance=1e-4).converged for target in targets]
        ends = [solve(chain, target, rule=rule, tolerance=1e-4, restarts=20) for target in targets]
        assert sum(alone) < sum(end.converged for end in ends)
        assert any(end.restarts > 0 for end in ends) and max(end.restarts for end in ends) <= 20
        again = solve(chain, targets[0], rule=rule, tolerance=1e-4, restarts=20)
        assert np.array_equal(again.angles, ends[0].angles)

    @pytest.mark.parametrize(("lower", "upper"), [(4.0, np.inf), (-np.inf, -4.0), (-1.0, np.inf)])
    def test_begin_inside_limits_of_one_side(self, lower, upper):
        home = min(max(0.0, lower), upper)
        chain = KinematicChain([Joint("a", (0, 0, 1), (1, 0, 0), lower=lower, upper=upper, home=home)])
        starts = random_starts(chain, 200, 0)
        assert (starts >= lower).all() and (starts <= upper).all()
        assert np.ptp(starts) > 5.0  # of a turn, so that no direction is left out

    @pytest.mark.parametrize("width", [1e2, 1e16, 1e308])
    def test_limits_so_wide_that_they_say_nothing_are_as_none(self, width):
        arm = KinematicChain.load("arm5")
        wide = KinematicChain([replace(joint, lower=-width, upper=width) for joint in arm.joints])
        assert np.array_equal(random_starts(wide, 50, 3), random_starts(arm, 50, 3))
        assert np.abs(random_starts(wide, 50, 3) - arm.home).max() <= np.pi

    def test_stay_within_the_budget(self):
        end = solve(PLANAR, [0.05, 0.05, 0.05], restarts=1000, max_iterations=77, rule=LevenbergMarquardt())
        assert end.iterations <= 77 and not end.converged

    def test_unreachable_is_not_tried_again(self):
        assert solve(TOUCH, [9, 9, 9], restarts=5).restarts == 0


class TestBadArguments:
    @pytest.mark.parametrize(
        ("changes", "error", "message"),
        [
            ({"target": [0, 0]}, ShapeError, r"target has shape \(2,\); expected \(3,\)"),
            ({"target": [0, np.nan, 0]}, NotFiniteError, "target is"),
            ({"target": "here"}, GaikError, "target is 'here'"),
            ({"start": [0, 0]}, ShapeError, r"start has shape \(2,\); expected \(3,\)"),
            ({"start": [0, np.inf, 0]}, NotFiniteError, "start is"),
            ({"algebra": "octonion"}, UnknownNameError, "known: quaternion, conformal"),
            ({"tolerance": 0.0}, GaikError, "tolerance is 0.0; expected a number above 0"),
            ({"tolerance": -1}, GaikError, "tolerance is -1"),
            ({"tolerance": np.nan}, GaikError, "tolerance is nan"),
            ({"tolerance": "1"}, GaikError, "tolerance is '1'"),
            ({"max_iterations": -1}, GaikError, "max_iterations is -1"),
            ({"max_iterations": 1.5}, GaikError, "max_iterations is 1.5"),
            ({"restarts": -1}, GaikError, "restarts is -1"),
            ({"restarts": 10**13}, GaikError, "restarts is 10000000000000; there is no memory"),
            ({"restarts": 2, "seed": -1}, GaikError, "seed is -1"),
            ({"restarts": 2, "seed": [1]}, GaikError, r"seed is \[1\]"),
            ({"tolerance": np.array([1e-3, 1e-2])}, GaikError, "tolerance is .*; expected a number above 0"),
            ({"rule": "adam"}, GaikError, "rule is 'adam'; expected an update rule"),
            ({"rule": LevenbergMarquardt}, GaikError, "rule is .*; expected an update rule"),
            ({"chain": "touch"}, GaikError, r"chain is 'touch'.*KinematicChain\.load\('touch'\)"),
            ({"trace": True, "max_iterations": 10**30}, GaikError, "max_iterations is 1000.*no memory"),
            ({"target": Pose([0, 0, 0], [0, 0, 0, 0])}, GaikError, "orientation is"),
            (
                {"target": Pose([0, 0, 0]), "orientation_tolerance": 0},
                GaikError,
                "orientation_tolerance is 0",
            ),
            ({"target": Pointing([0, 0, 0], [0, 0, 0])}, GaikError, "direction is"),
            ({"trace": True, "restarts": 2}, GaikError, "restarts is 2; expected 0 with trace"),
            ({"trace": True, "target": [0, np.nan, 0]}, NotFiniteError, "target is"),
        ],
    )
    def test_are_named(self, changes, error, message):
        arguments = {"chain": TOUCH, "target": [0, 0, 0], **changes}
        with pytest.raises(error, match=message):
            solve(**arguments)

    def test_zero_iterations_are_allowed(self):
        end = solve(TOUCH, [0.05, 0.05, 0.0], max_iterations=0)
        assert end.iterations == 0 and end.status == Status.ITERATION_LIMIT


@pytest.mark.parametrize("trace", [False, True])
@pytest.mark.parametrize(
    ("good", "bad"),
    [({"max_iterations": 7}, {"max_iterations": 7.0}), ({"max_iterations": 1}, {"max_iterations": True})],
)
def test_what_is_no_count_is_refused_after_an_equal_count_was_taken(good, bad, trace):
    """Checked arguments are kept: what only compares equal to them must be checked itself."""
    target = TOUCH.forward(TOUCH.home)
    solve(TOUCH, target, **good, trace=trace)
    with pytest.raises(GaikError, match="max_iterations"):
        solve(TOUCH, target, **bad, trace=trace)


def test_a_tolerance_that_has_no_hash_is_taken():
    assert solve(TOUCH, TOUCH.forward(TOUCH.home), tolerance=np.array(1e-4)).converged
