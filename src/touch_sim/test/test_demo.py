"""The demo as a user runs it, and its parts on runs that need no ROS."""

import json
import re
import signal
import subprocess
import sys
import time

import matplotlib.image
import numpy as np
import pytest
import rclpy
from rclpy.context import Context
from rclpy.node import Node

from gaik_core import KinematicChain
from gaik_core.paths import path_by_name
from gaik_ros.pid import Gains
from gaik_ros.tracking import tracking_error
from touch_sim.demo_output import write
from touch_sim.demo_report import summary, table
from touch_sim.demo_run import Results
from touch_sim.loop_meter import LoopRate
from touch_sim.simulation import Settings, simulate

NODES = ("touch_sim", "pid_controller", "ik_node", "trajectory_publisher")
DEMO = [sys.executable, "-m", "touch_sim.demo"]
PATIENCE = 240  # s; a fresh machine compiles first


@pytest.fixture(scope="module")
def simulated():
    touch = KinematicChain.load("touch_device")
    settings = Settings(gains=Gains(feed_forward=0.05))
    runs = tuple(simulate(touch, name, path_by_name(name), settings) for name in ("circle", "lemniscate"))
    verdicts = tuple(
        {"result": result, "solve_time_us": str(100.0 + k), "superseded": "0"}
        for k, result in enumerate(["reached"] * 1258 + ["unreachable"] * 2)
    )
    return Results(runs, {name: LoopRate(1000.0, 999.5, 1.2e-3) for name in NODES}, verdicts, 0.35)


def wait_for_publisher(topic):
    context = Context()
    rclpy.init(context=context)
    node = Node("looking", context=context)
    try:
        end = time.monotonic() + PATIENCE
        while not node.count_publishers(topic):
            assert time.monotonic() < end
            time.sleep(0.05)
    finally:
        node.destroy_node()
        rclpy.shutdown(context=context)


def check_schema(figures, paths):
    """The keys of demo.json, and no others."""
    assert set(figures) == {"paths", "nodes", "ik", "cpu_cores"}
    assert set(figures["paths"]) == set(paths)
    assert all(set(error) == {"rms_m", "max_m"} for error in figures["paths"].values())
    assert set(figures["nodes"]) == set(NODES)
    rates = {"rate_hz", "reached_hz", "period_p99_s"}
    assert all(set(node) == rates for node in figures["nodes"].values())
    assert set(figures["ik"]) == {"solved", "p50_s", "p99_s"}
    assert np.isfinite(figures["cpu_cores"])


def test_the_summary_is_of_what_was_run(simulated):
    figures = summary(simulated)
    check_schema(figures, ("circle", "lemniscate"))
    for run in simulated.runs:
        assert figures["paths"][run.name]["rms_m"] == tracking_error(run).rms_m
    assert figures["ik"]["solved"] == 1258
    assert figures["ik"]["p50_s"] == pytest.approx(729.5e-6)
    assert json.loads(json.dumps(figures)) == figures


def test_the_table_says_the_same_to_people(simulated):
    text = table(simulated)
    error = summary(simulated)["paths"]["lemniscate"]
    assert re.search(rf"lemniscate +{1e3 * error['rms_m']:.3f} mm +{1e3 * error['max_m']:.3f} mm", text)
    assert "1260 sent, 1258 solved" in text
    assert re.search(r"pid_controller +1000 Hz +999\.5 Hz +1\.20 ms", text)
    assert "35 % of one core" in text


@pytest.mark.parametrize("count", [1, 2])
def test_the_figures_show_both_curves(simulated, tmp_path, count):
    shown = Results(simulated.runs[:count], simulated.nodes, simulated.verdicts, simulated.cpu_cores)
    words = write(shown, tmp_path / "new" / "folder")
    for name in ("fig21_path.png", "fig22_joints.png"):
        file = tmp_path / "new" / "folder" / name
        assert str(file) in words
        pixels = matplotlib.image.imread(file)[..., :3]
        assert min(pixels.shape[:2]) > 600
        red = (pixels[..., 0] > 0.9) & (pixels[..., 1:] < 0.1).all(axis=-1)
        black = (pixels < 0.1).all(axis=-1)
        assert red.sum() > 500
        assert black.sum() > 500


@pytest.mark.slow
def test_the_demo_follows_and_reports(tmp_path):
    done = subprocess.run(
        [*DEMO, "--path", "circle", "--period", "3", "--feed-forward", "--out", str(tmp_path)],
        capture_output=True, text=True, timeout=PATIENCE, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    figures = json.loads((tmp_path / "demo.json").read_text())
    check_schema(figures, ["circle"])
    assert (tmp_path / "fig21_path.png").stat().st_size > 10_000
    assert (tmp_path / "fig22_joints.png").stat().st_size > 10_000
    assert figures["ik"]["solved"] > 200
    # A tip that stood still would be 70 mm off; what a busy machine costs is far from that.
    assert figures["paths"]["circle"]["rms_m"] < 0.025
    assert f"{1e3 * figures['paths']['circle']['rms_m']:.3f} mm" in done.stdout
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--bogus"], "unrecognized arguments: --bogus"),
        (["--laps", "0"], "--laps: '0'; expected a whole number from 1 to 1000"),
        (["--rate", "fast"], "--rate: 'fast'; expected a number"),
        (["--path", "squre"], "'squre'"),
        (["--robot", "tuch"], "unknown robot 'tuch'"),
        (["--robot", "planar3"], "does not reach the circle"),
        (["--algebra", "octonion"], "quaternion, conformal"),
        (["--rule", "newton"], "levenberg_marquardt"),
        (["--namespace", "1st"], "namespace"),
        (["--out", "/proc/nowhere"], "/proc/nowhere"),
        (["--ros-args", "-p", "pid_controler:gains.p:=5.0"], "did you mean 'pid_controller'?"),
        (["--ros-args", "-p", "arm:gains.p:=5.0"], "no node 'arm' here, but touch_sim, pid_controller"),
        (["--ros-args", "-p", "pid_controller:rate:=500.0"], "rate is set by the options here, see --help"),
        (["--ros-args", "-p", "lap_time:=5.0"], "lap_time is set by the options here"),
        (["--ros-args", "foo"], "unknown ROS arguments ['foo']"),
    ],
)
def test_a_wrong_option_is_one_line_and_exit_code_2(options, words, tmp_path):
    command = [*DEMO, "--out", str(tmp_path), *options]
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert done.returncode == 2, done.stderr
    assert words in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert not done.stdout


@pytest.mark.slow
def test_a_device_that_is_at_work_is_left_alone(tmp_path):
    """Neither a suite that runs in the namespace nor a demo that began at the same time shares its device."""
    twin = subprocess.Popen(
        [sys.executable, "-m", "touch_sim.touch_sim_node", "--ros-args", "-r", "__ns:=/taken"],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    command = [*DEMO, "--path", "circle", "--period", "1", "--out", str(tmp_path), "--namespace", "taken/"]
    try:
        wait_for_publisher("/taken/joint_states")
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=False)
    finally:
        twin.kill()
        twin.wait()
    assert done.returncode == 2
    (line,) = done.stderr.strip().splitlines()
    assert line == (
        "demo: another node publishes joint_states in the namespace /taken: end it, or give another --namespace"
    )


@pytest.mark.slow
def test_two_demos_at_once_do_not_share_a_device(tmp_path):
    command = [*DEMO, "--path", "circle", "--period", "6", "--namespace", "shared"]
    both = [
        subprocess.Popen(
            [*command, "--out", str(tmp_path / name)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        for name in "ab"
    ]
    ends = [process.communicate(timeout=PATIENCE)[1] for process in both]
    assert sum(process.returncode == 0 for process in both) <= 1
    said = "".join(ends)
    assert "another node publishes joint_" in said and "Traceback" not in said


@pytest.mark.parametrize("module", ["rclpy", "matplotlib", "gaik_core", "numpy"])
def test_a_missing_module_is_one_line_with_the_command_that_brings_it(module, tmp_path):
    code = f"import sys; sys.modules[{module!r}] = None; from touch_sim.demo import main; sys.exit(main())"
    command = [sys.executable, "-c", code, "--out", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert done.returncode == 1
    (line,) = done.stderr.strip().splitlines()
    assert f"module {module} is missing" in line
    assert "-m pip install" in line


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_demo_ends_quietly(number, tmp_path):
    demo = subprocess.Popen(
        [*DEMO, "--laps", "50", "--out", str(tmp_path)], stderr=subprocess.PIPE, text=True
    )
    try:
        while "following the circle" not in (line := demo.stderr.readline()):
            assert line, "the demo ended by itself"
        time.sleep(0.5)
        demo.send_signal(number)
        _, said = demo.communicate(timeout=PATIENCE)
    finally:
        demo.kill()
    assert demo.returncode == 130
    assert "interrupted" in said
    assert "Traceback" not in said
