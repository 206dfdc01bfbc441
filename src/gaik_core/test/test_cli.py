"""The `gaik` command as its users meet it: in this process where that shows the same, else as a program of its own."""

import fcntl
import json
import math
import os
import pty
import re
import signal
import struct
import subprocess
import sys
import termios
import time
from pathlib import Path

import numpy as np
import pytest

from gaik_core import KinematicChain
from gaik_core.cli.main import main

GAIK = [sys.executable, "-c", "import sys; from gaik_core.cli.main import main; sys.exit(main())"]


def fails(capsys, arguments, *parts, code=2):
    """The command leaves with a code, and says why in one line on standard error."""
    try:
        assert main(arguments) == code
    except SystemExit as leaving:  # argparse leaves by itself
        assert leaving.code == code
    out, err = capsys.readouterr()
    assert not out
    assert err.count("\n") == 1 and err.startswith("gaik")
    for part in parts:
        assert part in err


def on_a_terminal(arguments, environment=()):
    """What the program writes where both its outputs are a terminal."""
    master, slave = pty.openpty()
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 30, 100, 0, 0))
    process = subprocess.Popen(
        [*GAIK, *arguments],
        stdout=slave,
        stderr=slave,
        env={**os.environ, "TERM": "xterm", **dict(environment)},
    )
    os.close(slave)
    parts = []
    try:
        while part := os.read(master, 4096):
            parts.append(part)
    except OSError:  # how Linux reports the end of a terminal
        pass
    os.close(master)
    assert process.wait(300) == 0
    return b"".join(parts).decode()


SLIDER = """
<robot name="slider">
  <link name="base"/><link name="carriage"/><link name="tool"/>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="carriage"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="0.5" effort="1" velocity="1"/></joint>
  <joint name="turn" type="continuous"><parent link="carriage"/><child link="tool"/><axis xyz="0 0 1"/></joint>
</robot>
"""


# --- all of it -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("command", ["reproduce", "robots", "solve", "workspace"])
def test_help_has_examples_that_work_as_typed(command, capsys, tmp_path, monkeypatch):
    with pytest.raises(SystemExit) as leaving:
        main([command, "--help"])
    assert leaving.value.code == 0
    text = capsys.readouterr().out
    examples = re.findall(rf"^  gaik ({command}.*)$", text, re.M)
    assert examples
    monkeypatch.chdir(tmp_path)
    for example in examples:
        arguments = example.split()
        if command != "reproduce" or "fig18" in arguments:  # the others are run elsewhere, and take longer
            assert main(arguments) == 0


def test_all_commands_are_listed(capsys):
    with pytest.raises(SystemExit):
        main(["--help"])
    text = capsys.readouterr().out
    for command in ("bench", "reproduce", "robots", "solve", "workspace"):
        assert re.search(rf"^    {command} +\w", text, re.M)


def test_no_command_shows_the_help_and_fails(capsys):
    assert main([]) == 2
    assert "commands:" in capsys.readouterr().out


def test_unknown_words_are_answered_in_one_line(capsys):
    fails(capsys, ["slove"], "'slove'", "did you mean 'solve'")
    fails(capsys, ["solve", "tuch", "0", "0", "0"], "'tuch'", "did you mean 'touch'")
    fails(capsys, ["solve", "touch", "0", "0", "0", "--rule", "adm"], "--rule", "'adm'", "adam")
    fails(capsys, ["solve", "touch", "0", "0"], "required: Z")
    fails(capsys, ["robots", "nobody"], "'nobody'", "touch_device")
    fails(capsys, ["reproduce", "fig8"], "'fig8'", "fig18")
    fails(capsys, ["robots", "--colour"], "--colour")


def test_bad_numbers_are_answered_in_one_line(capsys):
    fails(capsys, ["solve", "touch", "a", "0", "0"], "'a'")
    fails(capsys, ["solve", "touch", "nan", "0", "0"], "finite")
    fails(capsys, ["solve", "touch", "0", "-inf", "0"], "finite")
    fails(capsys, ["solve", "touch", "0", "0", "0", "--start", "1", "2"], "start", "(3,)")
    fails(capsys, ["solve", "touch", "0", "0", "0", "--tolerance", "-1"], "tolerance", "-1")
    fails(capsys, ["solve", "touch", "0", "0", "0", "--learning-rate", "1"], "--learning-rate")
    fails(
        capsys, ["solve", "touch", "0", "0", "0", "--rule", "adam", "--learning-rate", "-1"], "learning_rate"
    )


def test_files_that_cannot_be_written_or_read_are_named(capsys, tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("")
    fails(capsys, ["reproduce", "fig18", "--out", str(blocked / "out")], str(blocked))
    fails(capsys, ["robots", str(tmp_path / "none.yaml")], "none.yaml")
    fails(capsys, ["reproduce", "fig18", "--docs", str(tmp_path)], "--docs")


def test_colour_only_on_a_terminal_that_wants_it(capsys):
    assert "\x1b[" in on_a_terminal(["robots"])
    assert "\x1b[" not in on_a_terminal(["robots"], {"NO_COLOR": "1"}.items())
    assert main(["robots"]) == 0
    assert "\x1b[" not in capsys.readouterr().out


def test_progress_only_on_a_terminal(tmp_path):
    pytest.importorskip("matplotlib")
    arguments = ["reproduce", "fig14", "fig18", "--out", str(tmp_path)]
    shown = on_a_terminal(arguments)
    assert "fig18: " in shown and "1/2" in shown
    done = subprocess.run([*GAIK, *arguments], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0
    assert done.stderr == ""


def test_a_reader_that_leaves_early_is_no_error():
    done = subprocess.run(
        ["bash", "-c", 'set -o pipefail; "$@" robots --json | head -n 1', "bash", *GAIK],
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0
    assert done.stdout == "[\n"
    assert done.stderr == ""


def test_ctrl_c_ends_quietly_with_130_and_leaves_whole_files(tmp_path):
    image = pytest.importorskip("matplotlib.image")
    process = subprocess.Popen(
        [*GAIK, "reproduce", "--out", str(tmp_path)], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    deadline = time.monotonic() + 300
    while not list(tmp_path.glob("*.png")) and time.monotonic() < deadline:
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=300)
    assert process.returncode == 130
    assert (out, err) == (b"", b"")
    for file in tmp_path.glob("*.png"):
        assert image.imread(file).size
    assert not [file for file in tmp_path.iterdir() if file.suffix != ".png"]


# --- others' commands and experiments --------------------------------------------------------------------------------

PLUGIN = """
from gaik_core.cli import Command
from gaik_core.experiments import Comparison, Experiment, Findings


def run(arguments):
    print(arguments.word)
    return 0


ECHO = Command("say a word", ("gaik echo word",), lambda parser: parser.add_argument("word"), run)
FIG99 = Experiment("fig99", "9", "Ours", "About.", lambda: Findings([Comparison("length", "m", 1.0, 2.0, 2.0)]))
"""


@pytest.fixture
def plugin(tmp_path, monkeypatch):
    """A package on the path that adds a command, an experiment, and one of each that cannot be imported."""
    (tmp_path / "gaik_test_plugin.py").write_text(PLUGIN)
    info = tmp_path / "gaik_test_plugin-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: gaik_test_plugin\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(
        "[gaik.commands]\necho = gaik_test_plugin:ECHO\nlost = gaik_test_plugin_lost:COMMAND\n"
        "[gaik.experiments]\nfig99 = gaik_test_plugin:FIG99\nfig98 = gaik_test_plugin_lost:FIG98\n"
    )
    monkeypatch.syspath_prepend(tmp_path)


@pytest.mark.usefixtures("plugin")
def test_other_packages_add_commands(capsys):
    assert main(["echo", "hello"]) == 0
    assert capsys.readouterr().out == "hello\n"
    with pytest.raises(SystemExit):
        main(["--help"])
    text = capsys.readouterr().out
    assert "say a word" in text and "not available" in text
    fails(capsys, ["lost"], "lost is not available", "gaik_test_plugin_lost")
    assert main(["robots"]) == 0


@pytest.mark.usefixtures("plugin")
def test_other_packages_add_experiments(capsys, tmp_path):
    pytest.importorskip("matplotlib")
    out = str(tmp_path / "out")
    assert main(["reproduce", "fig99", "--out", out]) == 0
    assert "length: 2.0000 m (the paper: 1.0000)" in capsys.readouterr().out
    assert main(["reproduce", "fig98", "fig99", "--out", out]) == 1
    captured = capsys.readouterr()
    assert "fig98 was left out" in captured.err and captured.err.count("\n") == 1
    assert "length" in captured.out


@pytest.mark.usefixtures("plugin")
def test_names_are_completed_in_the_shell(tmp_path):
    pytest.importorskip("argcomplete")
    for typed, expected in (
        ("gaik ec", {"echo"}),
        ("gaik solve touch_", {"touch_device"}),
        ("gaik reproduce fig9", {"fig9", "fig98", "fig99"}),
    ):
        answer = tmp_path / "answer"
        environment = {
            **os.environ,
            # In front, not instead: an installed tree may be found by PYTHONPATH alone.
            "PYTHONPATH": os.pathsep.join(filter(None, [str(tmp_path), os.environ.get("PYTHONPATH")])),
            "_ARGCOMPLETE": "1",
            "_ARGCOMPLETE_STDOUT_FILENAME": str(answer),
            "COMP_LINE": typed,
            "COMP_POINT": str(len(typed)),
        }
        subprocess.run(GAIK, env=environment, timeout=300, capture_output=True)
        assert {word.strip() for word in answer.read_text().split("\v")} == expected


# --- solve and robots ------------------------------------------------------------------------------------------------


def solved(capsys, *arguments):
    """The answer of `gaik solve … --json`."""
    code = main(["solve", *arguments, "--json"])
    answer = json.loads(capsys.readouterr().out)
    assert code == (0 if answer["converged"] else 1)
    return answer


@pytest.mark.parametrize("algebra", ["quaternion", "conformal"])
def test_solve_brings_the_tip_there(capsys, algebra):
    answer = solved(capsys, "touch", "0.05", "0.05", "-1e-3", "--algebra", algebra)
    touch = KinematicChain.load("touch")
    assert list(answer["angles"]) == list(touch.joint_names)
    tip = touch.forward(list(answer["angles"].values()))
    assert np.linalg.norm(tip - [0.05, 0.05, -0.001]) == pytest.approx(answer["error_m"], abs=1e-12)
    assert answer["error_m"] < 1e-6


def test_solve_takes_the_papers_settings(capsys):
    options = ["--rule", "gradient_descent", "--learning-rate", "20", "--tolerance", "1e-4"]
    degrees = solved(capsys, "touch", "0.05", "0.05", "0", "--start-deg", "57.29", "-57.29", "0", *options)
    radians = solved(
        capsys,
        "touch",
        "0.05",
        "0.05",
        "0",
        "--start",
        *[str(math.radians(a)) for a in (57.29, -57.29, 0)],
        *options,
    )
    assert degrees["iterations"] == radians["iterations"] == 24
    assert degrees["angles"] == radians["angles"]


def test_a_urdf_is_solved_and_described_and_a_slide_starts_in_metres(capsys, tmp_path):
    robot = tmp_path / "slider.urdf"
    robot.write_text(SLIDER)
    options = ["--tip", "tool", "--max-iterations", "0", "--start-deg", "0.3", "90"]
    start = solved(capsys, str(robot), "0", "0", "0.4", *options)["angles"]
    assert start == {"lift": 0.3, "turn": pytest.approx(math.pi / 2)}
    assert solved(capsys, str(robot), "0", "0", "0.4")["converged"]
    assert main(["robots", str(robot), "--tip", "carriage"]) == 0
    said = capsys.readouterr().out
    assert "lift" in said and "turn" not in said
    fails(capsys, ["solve", "touch", "0", "0", "0", "--tip", "tool"], "--tip is for a URDF")


def test_solve_says_what_cannot_be_reached(capsys):
    assert solved(capsys, "touch", "5", "0", "0")["status"] == "unreachable"
    assert solved(capsys, "touch_device", "0", "0.05", "0.2", "--restarts", "3")["converged"] is False
    assert main(["solve", "touch", "5", "0", "0"]) == 1
    assert "unreachable" in capsys.readouterr().out


def test_solve_passes_over_limits_when_told(capsys):
    waist = KinematicChain.load("touch_device").upper[0]
    far = ["touch_device", "-0.25", "0.02", "-0.17"]
    assert solved(capsys, *far)["angles"]["waist"] <= waist
    free = solved(capsys, *far, "--no-limits", "--restarts", "20")
    assert free["converged"]
    assert free["angles"]["waist"] > waist


def test_solve_points_and_turns_the_tool(capsys):
    arm = KinematicChain.load("arm5")
    answer = solved(capsys, "arm5", "4", "1", "2", "--direction", "1", "0", "0", "--tool-axis", "1", "0", "0")
    assert answer["orientation_error_rad"] < 1e-4
    angles = list(answer["angles"].values())
    position, orientation = arm.pose(angles)
    target = [str(value) for value in position]
    same = solved(
        capsys,
        "arm5",
        *target,
        "--orientation",
        *[str(value) for value in orientation],
        "--start",
        *[str(a + 0.05) for a in angles],
    )
    assert same["converged"] and same["orientation_error_rad"] < 1e-4


def test_robots_lists_and_describes(capsys):
    assert main(["robots", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert [robot["name"] for robot in listed] == KinematicChain.names()
    assert main(["robots", "touch_device", "--json"]) == 0
    device = json.loads(capsys.readouterr().out)
    assert device in listed
    assert [joint["name"] for joint in device["joints"]] == ["waist", "shoulder", "elbow"]
    assert device["joints"][0]["upper"] == 0.98
    assert device["axes"][2]["coupling"] == {"shoulder": -1.0}
    assert main(["robots"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == len(listed) + 1
    assert main(["robots", "touch_device"]) == 0
    text = capsys.readouterr().out
    assert "[-0.98, 0.98]" in text and "-1 shoulder" in text


def test_robots_reads_a_file(capsys, tmp_path):
    file = Path(tmp_path / "mine.yaml")
    file.write_text("joints:\n  - {name: turn, axis: [0, 0, 1], link: [0.5, 0, 0]}\n")
    assert main(["robots", str(file)]) == 0
    assert "turn" in capsys.readouterr().out
    file.write_text("joints:\n  - {name: turn, axis: [0, 0, 1], lenk: [0.5, 0, 0]}\n")
    fails(capsys, ["robots", str(file)], "mine.yaml", "lenk")
