"""Workspaces of arms whose reach is known, and the command that shows them."""

import json
import math
import subprocess
import sys

import numpy as np
import pytest

from gaik_core import Joint, KinematicChain
from gaik_core.cli.main import main
from gaik_core.errors import GaikError
from gaik_core.workspace import find_workspace, sample_joints

GAIK = [sys.executable, "-c", "import sys; from gaik_core.cli.main import main; sys.exit(main())"]


def turn(name, axis, link, **options):
    return Joint(name, axis=axis, link=link, **options)


def arm(inner, outer, **limits):
    """A turning base that carries two links in an upright plane."""
    return KinematicChain(
        [
            turn("base", (0, 0, 1), (0, 0, 0)),
            turn("shoulder", (0, 1, 0), (inner, 0, 0)),
            turn("elbow", (0, 1, 0), (outer, 0, 0), **limits),
        ],
        name="arm",
    )


def shell(inner, outer):
    return 4.0 / 3.0 * math.pi * (outer**3 - inner**3)


@pytest.mark.parametrize(("inner", "outer"), [(0.3, 0.3), (0.4, 0.2), (0.15, 0.25)])
def test_two_links_on_a_turning_base_reach_a_hollow_ball(inner, outer):
    workspace = find_workspace(arm(inner, outer))
    assert workspace.complete
    assert workspace.dimension == 3
    assert workspace.size == pytest.approx(shell(abs(inner - outer), inner + outer), rel=0.01)
    assert workspace.farthest == pytest.approx(inner + outer, abs=1e-3)
    assert workspace.nearest == pytest.approx(abs(inner - outer), abs=0.5 * workspace.cell)
    np.testing.assert_allclose(workspace.upper, inner + outer, atol=workspace.cell)
    np.testing.assert_allclose(workspace.lower, -inner - outer, atol=workspace.cell)


@pytest.mark.parametrize(("name", "radius"), [("planar2", 0.2), ("planar3", 0.3), ("planar6", 0.3)])
def test_planar_arms_reach_a_disc(name, radius):
    workspace = find_workspace(KinematicChain.load(name))
    assert workspace.dimension == 2
    assert workspace.reached.shape[2] == 1
    assert workspace.size == pytest.approx(math.pi * radius**2, rel=0.01)


def test_many_joints_reach_their_ball_although_few_samples_do():
    # Three links about turning axes: the sampled tips hardly ever lie near the outer edge.
    joints = [turn("yaw", (0, 0, 1), (0, 0, 0))]
    joints += [turn(f"pitch{k}", (0, 1, 0), (0.1, 0, 0)) for k in range(6)]
    workspace = find_workspace(KinematicChain(joints), cells=32, samples=2000)
    assert workspace.complete
    assert workspace.size == pytest.approx(shell(0.0, 0.6), rel=0.03)


def test_the_touch_s_volume_is_the_integral_of_its_jacobian_determinant():
    # Inside its limits no point is reached in two ways, so that joint space maps onto the workspace one to one.
    touch = KinematicChain.load("touch_device")
    values = np.random.default_rng(5).uniform(
        [touch.lower[0], touch.lower[1], -0.81], [touch.upper[0], touch.upper[1], 3.0], size=(40_000, 3)
    )
    turned = touch.axis_angles(values)
    inside = ((turned >= touch.axis_lower) & (turned <= touch.axis_upper)).all(axis=1)
    box = (touch.upper[0] - touch.lower[0]) * (touch.upper[1] - touch.lower[1]) * 3.81
    spread = [abs(np.linalg.det(touch.jacobian(angles))) for angles in values[inside]]
    integral = box * np.sum(spread) / len(values)
    assert find_workspace(touch).size == pytest.approx(integral, rel=0.02)


def test_every_reached_centre_is_reached_within_the_limits():
    touch = KinematicChain.load("touch_device")
    workspace = find_workspace(touch, cells=16, samples=5000)
    cells = np.argwhere(workspace.reached)
    centres = workspace.corner + (cells + 0.5) * workspace.cell
    rows = {tuple(row) for row in np.round(workspace.tips, 12)}
    assert {tuple(row) for row in np.round(centres, 12)} <= rows
    values = sample_joints(touch, 5000, 0)
    assert (values >= touch.lower).all() and (values <= touch.upper).all()
    turned = touch.axis_angles(values)
    assert (turned <= touch.axis_upper).all() and (turned >= touch.axis_lower).all()


def test_a_seed_gives_one_workspace():
    chain = arm(0.3, 0.2)
    first, again, other = (find_workspace(chain, 24, 3000, seed) for seed in (1, 1, 2))
    assert (first.reached == again.reached).all() and (first.tips == again.tips).all()
    assert other.size == pytest.approx(first.size, rel=0.05)


def test_surfaces_and_curves_have_no_volume():
    ball = KinematicChain([turn("yaw", (0, 0, 1), (0, 0, 0)), turn("pitch", (0, 1, 0), (0.5, 0, 0))])
    surface = find_workspace(ball, samples=5000)
    assert (surface.dimension, surface.size) == (2, 0.0)
    assert surface.nearest == pytest.approx(0.5) and surface.farthest == pytest.approx(0.5)
    curve = find_workspace(KinematicChain([turn("yaw", (0, 0, 1), (0.5, 0, 0))]), samples=500)
    assert (curve.dimension, curve.size) == (1, 0.0)
    assert find_workspace(KinematicChain([turn("spin", (0, 0, 1), (0, 0, 0.1))])).dimension == 0


def test_a_slide_needs_limits_and_has_the_volume_of_its_way():
    with pytest.raises(GaikError, match=r"'lift' slides without a limit"):
        find_workspace(KinematicChain([Joint("lift", axis=(0, 0, 1), link=(0, 0, 0), kind="prismatic")]))
    column = KinematicChain(
        [
            turn("yaw", (0, 0, 1), (0, 0, 0)),
            Joint("lift", axis=(0, 0, 1), link=(0, 0, 0), kind="prismatic", lower=0.0, upper=0.4),
            Joint("reach", axis=(1, 0, 0), link=(0, 0, 0), kind="prismatic", lower=0.1, upper=0.5, home=0.1),
        ]
    )
    workspace = find_workspace(column)
    assert workspace.size == pytest.approx(math.pi * (0.5**2 - 0.1**2) * 0.4, rel=0.04)


def test_it_can_be_ended_early():
    told = []

    def carry_on(done, waiting):
        told.append((done, waiting))
        return False

    workspace = find_workspace(arm(0.3, 0.3), carry_on=carry_on)
    assert not workspace.complete
    assert len(told) == 1
    assert 0.0 < workspace.size < shell(0.0, 0.6)


@pytest.mark.parametrize("numbers", [{"cells": 3}, {"samples": 5}])
def test_too_small_numbers_are_refused(numbers):
    with pytest.raises(GaikError, match="or more"):
        find_workspace(arm(0.3, 0.3), **numbers)


# --- the command -----------------------------------------------------------------------------------------------------


def test_the_command_tells_and_draws(capsys, tmp_path):
    image = pytest.importorskip("matplotlib.image")
    assert main(["workspace", "touch_device", "--cells", "24", "--out", str(tmp_path), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["robot"] == "touch_device" and told["complete"] is True
    assert told["volume_m3"] == pytest.approx(0.017, rel=0.05)
    assert told["farthest_m"] < 0.27
    pixels = image.imread(tmp_path / "touch_device.png")[..., :3]
    blue = (pixels[..., 2] > 0.7) & (pixels[..., 0] < 0.6)
    assert blue.sum() > 5000
    assert main(["workspace", "planar3", "--cells", "24", "--out", str(tmp_path)]) == 0
    text = capsys.readouterr().out
    assert "m², in a plane" in text and str(tmp_path / "planar3.png") in text


def test_the_command_reads_files_and_urdfs(capsys, tmp_path):
    robot = tmp_path / "mine.yaml"
    robot.write_text("joints:\n  - {name: turn, axis: [0, 0, 1], link: [0.5, 0, 0]}\n")
    assert main(["workspace", str(robot), "--no-picture"]) == 0
    assert "a curve" in capsys.readouterr().out
    urdf = tmp_path / "mine.urdf"
    urdf.write_text(
        '<robot name="mine"><link name="a"/><link name="b"/><link name="c"/>'
        '<joint name="one" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>'
        '<joint name="two" type="fixed"><parent link="b"/><child link="c"/><origin xyz="0.5 0 0"/></joint></robot>'
    )
    assert main(["workspace", str(urdf), "--base", "a", "--tip", "c", "--no-picture", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["farthest_m"] == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["tuch"], "did you mean 'touch'"),
        (["none.urdf"], "none.urdf: there is no such file"),
        (["touch", "--tip", "hand"], "--tip is for a URDF"),
        (["touch", "--cells", "2"], "cells is 2"),
        (["touch", "--seconds", "0"], "--seconds is 0"),
        (["touch", "--cells", "8", "--at", "0", "nan", "0"], "--at"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(capsys, tmp_path, arguments, words):
    assert main(["workspace", *arguments, "--out", str(tmp_path)]) == 2
    out, err = capsys.readouterr()
    assert not out
    assert err.count("\n") == 1 and words in err
    assert not list(tmp_path.iterdir())


def test_too_short_a_time_is_said_and_gives_a_part(capsys):
    assert main(["workspace", "touch", "--seconds", "1e-6", "--no-picture", "--json"]) == 1
    out, err = capsys.readouterr()
    assert "not complete" in err
    assert json.loads(out)["complete"] is False


def test_bench_runs_the_repository_s_script_and_says_so_where_there_is_none(tmp_path):
    script = tmp_path / "benchmark" / "run.py"
    script.parent.mkdir()
    (tmp_path / "src" / "gaik_core").mkdir(parents=True)
    script.write_text("import sys; print(sys.argv[1:]); sys.exit(3)")
    command = [*GAIK, "bench", "--quick", "--tasks", "T1", "T3", "--rounds", "2", "--no-write"]
    inside = tmp_path / "benchmark"
    done = subprocess.run(command, cwd=inside, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 3
    assert done.stdout == "['--tasks', 'T1', 'T3', '--rounds', '2', '--quick', '--no-write']\n"


def test_bench_needs_the_repository(tmp_path, monkeypatch, capsys):
    import gaik_core.cli.bench as bench

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(bench, "__file__", str(tmp_path / "site-packages" / "gaik_core" / "cli" / "bench.py"))
    assert main(["bench"]) == 2
    assert "benchmark/run.py" in capsys.readouterr().err
