"""Every fault of the injector, played against a suite of processes: what is promised must hold.

GAIK_NIGHTLY=1 adds those that take a minute and more. Times are bounded generously; what the promises are about is
counted in messages.
"""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from spin_all_nodes import suites

from gaik_core import KinematicChain
from gaik_ros.faults.catalogue import FAULTS, fault_by_name
from gaik_ros.faults.facts import admissible, posture
from gaik_ros.faults.report import lines
from gaik_ros.faults.rig import rig
from touch_sim.suite import SuiteOptions

NIGHTLY = os.environ.get("GAIK_NIGHTLY") == "1"
ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "faults.md"
PATIENCE = 240.0  # s


def parameter(fault):
    skipped = pytest.mark.skipif(
        fault.long and not NIGHTLY, reason="takes over a minute: GAIK_NIGHTLY=1 plays it"
    )
    return pytest.param(fault, id=fault.name, marks=skipped)


# A quarter of the usual rate leaves the machine to the other tests; docs/faults.md is of the full rate.
RATE = ["-p", "rate:=250.0"]


@pytest.fixture(scope="module", autouse=True)
def no_shared_memory():
    """Processes are stopped and killed here, which Fast DDS's shared memory may not survive (docs/faults.md)."""
    with pytest.MonkeyPatch.context() as environment:
        environment.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "SYSTEM_DEFAULT")
        environment.setenv("FASTRTPS_DEFAULT_PROFILES_FILE", str(ROOT / "config" / "fastdds_udp.xml"))
        yield


@pytest.fixture(scope="module")
def ours(no_shared_memory):
    with rig("faults", start_suite=True, arguments={"touch_sim": RATE, "pid_controller": RATE}) as ready:
        yield ready


def assert_broken(suite, fault, promises):
    """Only these `promises` are broken. Workers share the cores, and times are measured: an error is one twice."""
    outcome = suite.play(fault)
    if [check.promise for check in outcome.broken] != promises:
        print(lines(outcome))
        outcome = suite.play(fault)
    assert [check.promise for check in outcome.broken] == promises, lines(outcome)


@pytest.mark.parametrize("fault", [parameter(fault) for fault in FAULTS])
def test_what_is_promised_holds(ours, fault):
    assert_broken(ours, fault, [])


def test_a_broken_promise_is_noticed():
    careless = {"pid_controller": ["-p", "gains.antiwindup:=false"]}
    with rig("broken", start_suite=True, arguments=careless) as broken:
        assert_broken(broken, fault_by_name("saturation"), ["no windup"])


def inject(*arguments):
    command = [sys.executable, "-m", "gaik_ros.faults.inject", *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=False)


def test_the_list_names_every_fault():
    done = inject("--list")
    assert done.returncode == 0
    assert {line.split()[0] for line in done.stdout.splitlines()} == {fault.name for fault in FAULTS}


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["nan_setpiont"], "nan_setpiont"),
        (["--fast"], "--fast"),
        (["--all", "nan_setpoint"], "not both"),
        (
            ["nan_setpoint", "--namespace", "nobody"],
            "no service /nobody/ik_node/get_parameters.*--start-suite",
        ),
        (["nan_setpoint", "--namespace", "bad ns"], "bad ns"),
        (["nan_setpoint", "--start-suite", "--write", "/proc/x"], "--write: /proc/x cannot be written"),
    ],
)
def test_a_wrong_argument_is_one_line_and_exit_code_2(arguments, complaint):
    done = inject(*arguments)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("\n") == 1
    assert re.search(complaint, done.stderr)


def test_against_a_running_suite_it_plays_what_can_be_played():
    with suites(SuiteOptions(namespace="left", rate=200.0)):
        played = inject("nan_setpoint", "bad_parameters", "--namespace", "left")
        impossible = inject("bad_parameters", "kill_ik_node", "--namespace", "left")
        silent = inject("states_nan", "--namespace", "left", "--cable", "nothing/here")
    assert played.returncode == 0, played.stdout + played.stderr
    assert "2 of 2 held" in played.stdout
    for done, reason in (
        (impossible, "kill_ik_node .*--start-suite"),
        (silent, "nothing comes on nothing/here"),
    ):
        assert (done.returncode, done.stdout) == (2, "")  # before any is played
        assert re.search(reason, done.stderr)


def test_it_does_not_fight_for_the_arm_with_who_sends_setpoints_already():
    with suites(SuiteOptions(namespace="right", rate=200.0)) as (user,):
        user.start("circle")
        done = inject("nan_setpoint", "--namespace", "right")
    assert (done.returncode, done.stdout) == (2, "")
    assert "setpoints come from trajectory_publisher: stop them first" in done.stderr


def test_the_page_has_every_fault_and_none_was_broken():
    rows = [line.split("|") for line in PAGE.read_text().splitlines() if line.startswith("| `")]
    assert {row[1].strip(" `") for row in rows} == {fault.name for fault in FAULTS}
    assert {row[-2].strip() for row in rows} == {"yes"}


@pytest.mark.parametrize("robot", KinematicChain.names())
def test_the_postures_of_every_robot_are_inside_its_limits(robot):
    chain = KinematicChain.load(robot)
    for turn in (0.0, 0.4, 0.75):
        assert admissible(chain, posture(chain, turn))
