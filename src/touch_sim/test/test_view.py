"""The suite with the page as a user starts and ends it, and the Touch's URDF as the page draws it."""

import os
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path

import numpy as np
import pytest

from gaik_core import KinematicChain
from gaik_ros.viewer.urdf_shapes import UrdfShapes
from touch_sim.description import ORIGIN_FRAME, touch_urdf

PATIENCE = 60.0
SCRIPT = Path(__file__).parents[1] / "scripts" / "view"


def start(*arguments):
    return subprocess.Popen(
        [sys.executable, str(SCRIPT), *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def end(process):
    try:
        output, errors = process.communicate(timeout=PATIENCE)
    finally:
        process.kill()
    return process.returncode, output, errors


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=["SIGINT", "SIGTERM"])
def test_it_serves_its_page_and_ends_quietly(number):
    pytest.importorskip("viser", reason="no viser; install it with: pip install 'viser>=1.1,<2'")
    process = start("--no-browser", "--port", "0", "--rate", "200")
    said = process.stdout.readline()
    assert said.endswith("; Ctrl-C ends it.\n")
    with urllib.request.urlopen(said.split()[4].rstrip(";"), timeout=PATIENCE) as response:
        assert response.status == 200
    process.send_signal(number)
    code, output, errors = end(process)
    assert (code, output) == (0, "")
    assert "Traceback" not in errors


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["--speed", "1"], "unrecognized arguments: --speed 1"),
        (["--port", "many"], "argument --port"),
        (["--port", "-1"], "'port' is -1"),
        (["--rate", "0"], "'rate' is 0.0"),
        (["--robot", "tuch"], "unknown robot 'tuch'"),
        (["--namespace", "1bad"], "1bad"),
        (["--ros-args", "-p", "viewr:port:=0"], "did you mean 'viewer'?"),
        (["--ros-args", "-p", "viewer:port:=9123"], "port is set by the options here, see --help"),
    ],
)
def test_a_wrong_option_is_said_in_one_line(arguments, complaint):
    code, output, errors = end(start("--no-browser", *arguments))
    assert (code, output) == (2, "")
    assert errors.count("\n") == 1
    assert errors.startswith("view: ")
    assert complaint in errors


def test_help_says_what_to_do_on_the_page():
    code, output, errors = end(start("--help"))
    assert (code, errors) == (0, "")
    assert "drag the ball" in output


def test_there_is_an_executable_for_ros2_run():
    assert os.access(SCRIPT, os.X_OK)


def test_the_touch_is_drawn_where_eq_78_puts_it():
    shapes, random = UrdfShapes(touch_urdf()), np.random.default_rng(6)
    chain = KinematicChain.load("touch")
    origin, _ = shapes.pose_in_root(ORIGIN_FRAME, {})
    for angles in random.uniform(-1.5, 1.5, (50, 3)):
        tip, _ = shapes.pose_in_root("tip", dict(zip(chain.joint_names, angles.tolist(), strict=True)))
        # REP-103: x forward (toward the user, the paper's z), y left (the paper's x), z up (its y).
        x, y, z = chain.forward(angles)
        np.testing.assert_allclose(tip - origin, [z, x, y], atol=1e-12)


def test_every_link_of_the_touch_that_is_to_be_seen_has_a_shape():
    seen = {link.name for link in UrdfShapes(touch_urdf()).links if link.shapes}
    assert {"base_link", "upper_arm", "forearm", "tip"} <= seen
