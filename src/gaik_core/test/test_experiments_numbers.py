"""The experiments give numbers computed independently of this project, and both algebras the same iterates."""

import numpy as np
import pytest

from gaik_core import KinematicChain
from gaik_core.experiments import experiment_names, load_experiment
from gaik_core.experiments.arms import scaled_to_reach
from gaik_core.experiments.nearest import distance_to_nearest, solutions
from gaik_core.experiments.registry import OWN
from gaik_core.experiments.two_joints import TARGET, closed_form

FOUND = {}

# Computed in float64 by other programs, from the paper alone.
REFERENCES = [
    ("fig4", "joints after 30 updates, α = 10 as printed", [16.574, 112.618], 5e-4),
    ("fig4", "joints after 30 updates, α = 50", [27.5430, 98.9433], 5e-5),
    ("fig4", "joints at the minimum", [27.5715, 98.9008], 5e-5),
    ("fig4", "error after 30 updates, α = 10", 0.02096, 5e-6),
    ("fig4", "error after 30 updates, α = 50", 5.9e-5, 5e-7),
    ("fig5", "minima found in one turn of both joints", 2, 0),
    ("fig5", "first minimum", [27.5715, 98.9008], 1e-4),
    ("fig5", "second minimum", [126.4723, -98.9008], 1e-4),
    ("fig6", "joints at the minimum", [126.4723, -98.9008], 5e-5),
    ("fig7", "descent from [-50, -50] deg ends at", [126.4723, -98.9008], 5e-5),
    ("fig9", "positions reached, of all", 25, 0),
    ("fig11", "points reached", 126, 0),
    ("fig12", "points reached", 126, 0),
    ("fig14", "joints at the end", [225.0, 73.0256, 194.4775], 5e-5),
    ("fig14", "updates to 1 mm", 170, 0),
    ("fig15", "joints at the end", [225.0, 73.0256, 194.4775], 5e-5),
    ("table1", "mean updates, Adam, Fibonacci", 50.3, 0.05),
    ("table1", "mean updates, Adam, random surface", 50.0, 1.0),
    ("table1", "mean updates, Adam, longitude-latitude grid", 48.3, 0.05),
    ("table1", "fewest updates, Adam, Fibonacci", 6, 0),
    ("table1", "most updates, Adam, Fibonacci", 76, 0),
    ("table1", "share reached, Adam, Fibonacci", 1.0, 0),
    ("fig18", "joints at the end", [-16.39, 56.51, 49.54], 0.01),
    ("fig18", "updates to 0.1 mm", 24, 0),
    ("fig19", "position of the corrected start", [-0.0614, -0.2236, -0.1306], 5e-5),
    ("fig19", "position of the printed start", [-0.0180, -0.0480, -0.1584], 5e-5),
    ("fig19", "position of the printed solution", [0.05, 0.05, 0.0], 5e-5),
]


def findings(name):
    """Of one run of an experiment."""
    if name not in FOUND:
        FOUND[name] = load_experiment(name).run()
    return FOUND[name]


@pytest.mark.parametrize(("name", "quantity", "expected", "tolerance"), REFERENCES)
def test_the_known_numbers_come_out_by_both_algebras(name, quantity, expected, tolerance):
    (row,) = [row for row in findings(name).comparisons if row.quantity == quantity]
    assert np.allclose(row.quaternion, expected, rtol=0.0, atol=tolerance)
    assert np.allclose(row.conformal, expected, rtol=0.0, atol=tolerance)


@pytest.mark.parametrize("name", [name for name in OWN if name != "errata"])
def test_both_algebras_make_the_same_iterates_at_every_step(name):
    iterates = findings(name).iterates
    assert iterates
    for what, pair in iterates.items():
        assert pair.quaternion.shape == pair.conformal.shape, what
        assert len(pair.quaternion) > 5, what
        assert np.abs(pair.quaternion - pair.conformal).max() < 1e-9, what


@pytest.mark.parametrize("name", OWN)
def test_every_erratum_is_borne_out(name):
    for erratum in findings(name).errata:
        assert erratum.confirmed, erratum


def test_every_erratum_of_equations_and_experiments_is_measured():
    where = {erratum.where for name in OWN for erratum in findings(name).errata}
    for expected in (
        "eq. 3",
        "eqs. 6, 7",
        "eq. 10",
        "eq. 28",
        "eq. 39",
        "eqs. 57, 63",
        "eq. 59",
        "eqs. 66-68",
        "eqs. 71-78",
    ):
        assert expected in where
    assert {"3.4, start", "3.4, α", "3.4, Fig. 6", "6.2, start", "6.2, target"} <= where


def test_table1_tries_every_rule_and_lists_those_that_enlarge_a_rounding():
    from gaik_core import RULES

    tried = findings("table1").iterates
    unstable = {row[0] for row in findings("table1").tables[1].rows if row[3] != "yes"}
    assert {what.split(",")[0] for what in tried} | unstable == set(RULES)
    assert "adam" not in unstable and "gradient_descent" not in unstable


def test_the_gradient_velocity_nears_the_pseudo_inverse_as_beta_grows():
    differences = [
        row.quaternion for row in findings("velocity").comparisons if row.quantity.startswith("rates")
    ]
    assert sorted(differences, reverse=True) == differences
    assert differences[-1] < 5.0 < differences[0]  # %


def test_the_nearest_solution_is_not_always_found():
    from gaik_core.experiments import velocity

    found = velocity.measure_nearest(KinematicChain.load("planar2"), 60)
    assert 0.5 < found.share < 1.0
    assert (found.went >= found.nearest - 1e-3).all()


def test_the_closed_forms_reach_their_target():
    arm = KinematicChain.load("planar2")
    assert np.allclose(arm.forward(closed_form(TARGET)), TARGET, atol=1e-12)
    for name in ("planar2", "planar3"):
        chain = KinematicChain.load(name)
        target = np.array([0.05, 0.11, 0.0])
        angles = solutions(chain, target)
        assert np.allclose(chain.forward(angles), target, atol=1e-12)
        assert distance_to_nearest(chain, target, angles[0] + 2.0 * np.pi) < 1e-12


def test_scaling_an_arm_scales_every_position():
    arm = KinematicChain.load("touch")
    angles = np.array([0.3, -0.2, 0.9])
    assert np.allclose(
        scaled_to_reach(arm, 2.0 * arm.reach).forward(angles), 2.0 * arm.forward(angles), atol=1e-15
    )


def test_names_list_every_experiment_once():
    names = experiment_names()
    assert len(names) == len(set(names))
    assert set(OWN) <= set(names)
