"""All nodes in one process on real ROS 2, and what a user sees of them.

Bounds on times and rates are generous, so that a busy machine fails none: what is asserted would be far outside
them if it were broken.
"""

import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from spin_all_nodes import answered, follow, suites, wait_until

from gaik_core import KinematicChain
from gaik_core.paths import path_by_name
from gaik_ros.tracking import tip_distances
from touch_sim.suite import SuiteOptions
from touch_sim.tracking import setpoint_numbers

NAMES = ("waist", "shoulder", "elbow")
NODES = ("touch_sim", "pid_controller", "ik_node", "trajectory_publisher")
SLOW = {"rate": 200.0}  # enough where not the rate is what is tested

TOPICS = {
    "setpoint": "geometry_msgs/msg/Point",
    "joint_reference": "sensor_msgs/msg/JointState",
    "ik_node/status": "diagnostic_msgs/msg/DiagnosticStatus",
    "joint_command": "sensor_msgs/msg/JointState",
    "joint_states": "sensor_msgs/msg/JointState",
    "tip": "geometry_msgs/msg/PointStamped",
}
SERVICES = {
    "trajectory_publisher/start": "std_srvs/srv/Trigger",
    "trajectory_publisher/stop": "std_srvs/srv/Trigger",
    "ik_node/solve_from_here": "std_srvs/srv/Trigger",
    "pid_controller/enable": "std_srvs/srv/SetBool",
    "pid_controller/reset": "std_srvs/srv/Trigger",
    "touch_sim/reset": "std_srvs/srv/Trigger",
}
ROS_OWN = {"/rosout", "/parameter_events", "/diagnostics"}


@pytest.fixture(scope="module")
def followed():
    return follow(SuiteOptions(), ["circle", "lemniscate"])


def test_every_setpoint_is_answered_and_reached(followed):
    sent = sum(run.setpoint.time.size for run in followed.runs)
    assert sent >= 2 * 630
    assert answered(followed.verdicts) >= sent
    assert {verdict["result"] for verdict in followed.verdicts} == {"reached"}
    sequence = [int(verdict["sequence"]) for verdict in followed.verdicts]
    assert sequence == sorted(set(sequence))
    assert max(float(verdict["error_m"]) for verdict in followed.verdicts) < 1e-6


@pytest.mark.parametrize("index", [0, 1])
def test_the_tip_is_within_bounds_of_the_path(followed, index):
    run = followed.runs[index]
    distances = tip_distances(run)
    # 0.8 and 1.0 mm on an idle machine. Where others take the processor away for 20 ms and more, the loop is open
    # for so long and the tip off for a moment: the median does not feel that, and a tenth of the time is left for it.
    assert np.median(distances) < 0.002
    assert np.percentile(distances, 90) < 0.01
    assert distances.size > 0.7 * 6300


@pytest.mark.parametrize("index", [0, 1])
def test_the_measured_tip_is_that_of_the_measured_joints(followed, index):
    run = followed.runs[index]
    stamps, of_tip, of_state = np.intersect1d(run.tip.time, run.joint_states.time, return_indices=True)
    assert stamps.size > 0.7 * run.tip.time.size
    tips = KinematicChain.load("touch_device").forward(run.joint_states.values[of_state])
    np.testing.assert_allclose(tips, run.tip.values[of_tip], rtol=0, atol=1e-12)


@pytest.mark.parametrize("name", NODES)
def test_the_rates_are_held(followed, name):
    loop = followed.nodes[name]
    assert loop.rate_hz == (1000.0 if name in ("touch_sim", "pid_controller") else 100.0)
    # To 0.1 % on an idle machine. Ticks lost in stalls of more than 50 ms are not made up for.
    assert 0.7 * loop.rate_hz < loop.reached_hz < 1.02 * loop.rate_hz


def test_feed_forward_takes_most_of_the_lag_away(followed):
    lead = follow(SuiteOptions(feed_forward=True), ["lemniscate"]).runs[0]
    assert np.median(tip_distances(lead)) < 0.001  # 0.1 mm, of 1.0
    assert np.median(tip_distances(lead)) < 0.8 * np.median(tip_distances(followed.runs[1]))


def test_topics_and_services_have_their_names_and_types():
    with suites(SuiteOptions(namespace="left", **SLOW)) as (left,):
        node = left.node
        wanted = {f"/left/{name}": [kind] for name, kind in TOPICS.items()}
        wait_until(lambda: wanted.items() <= dict(node.get_topic_names_and_types()).items(), "topics lack")
        wanted = {f"/left/{name}": [kind] for name, kind in SERVICES.items()}
        wait_until(
            lambda: wanted.items() <= dict(node.get_service_names_and_types()).items(), "services lack"
        )
        names = {name for name, _ in node.get_topic_names_and_types()}
        assert {name for name in names if not name.startswith("/left/")} <= ROS_OWN
        assert set(NODES) <= set(node.get_node_names())


def test_joint_names_and_order_are_the_robots():
    with suites(SuiteOptions(**SLOW)) as (user,):
        user.send(0.05, 0.05, 0.0)
        wait_until(lambda: user.recorder.count("joint_reference") > 5, "no reference comes")
        recording = user.recorder.take()
    for topic in ("joint_states", "joint_reference"):
        messages = recording.messages(topic)
        assert {tuple(message.name) for message in messages} == {NAMES}
        assert all(len(message.position) == len(message.velocity) == 3 for message in messages)


def test_one_setpoint_by_hand_is_carried_out_to_the_end_and_held():
    target = np.array([0.05, 0.05, 0.0])
    with suites(SuiteOptions(**SLOW)) as (user,):
        user.send(*target)
        wait_until(
            lambda: np.linalg.norm(user.recorder.tip_now() - target) < 1e-4, "the tip does not get there"
        )
        time.sleep(0.5)
        user.recorder.take()
        wait_until(lambda: user.recorder.count("tip") > 100, "no tip comes")
        recording = user.recorder.take()
    assert np.linalg.norm(recording.tips().values - target, axis=1).max() < 2e-4
    # The paper's solution for this target (6.2), in rad.
    held = np.degrees(recording.joints("joint_states", NAMES).values[-1])
    np.testing.assert_allclose(held, [-16.39, 56.51, 49.54], atol=0.05)


def test_an_unreachable_setpoint_gets_its_verdict_and_a_finite_reference():
    with suites(SuiteOptions(**SLOW)) as (user,):
        user.send(1.0, 0.0, 0.0)
        wait_until(lambda: user.recorder.count("ik_node/status") > 0, "no verdict comes")
        user.send(float("nan"), 0.0, 0.0)
        wait_until(lambda: user.recorder.count("ik_node/status") > 1, "no verdict comes")
        user.send(0.0, 0.0, 0.0)
        wait_until(lambda: user.recorder.count("ik_node/status") > 2, "no verdict comes")
        wait_until(lambda: np.linalg.norm(user.recorder.tip_now()) < 1e-4, "the tip does not come back")
        recording = user.recorder.take()
    results = [verdict["result"] for verdict in recording.verdicts()]
    assert results == ["unreachable", "refused", "reached"]
    assert np.isfinite(recording.joints("joint_reference", NAMES).values).all()


def test_two_suites_side_by_side_do_not_hear_each_other():
    period = 4.0
    sides = {"left": "circle", "right": "lemniscate"}
    options = [SuiteOptions(namespace=name, period=period, **SLOW) for name in sides]
    with suites(*options) as users:
        heard = []
        users[0].node.create_subscription(DiagnosticArray, "/diagnostics", heard.append, 100)
        for user, path in zip(users, sides.values(), strict=True):
            user.send(*path_by_name(path).position(0.0))
        for user, path in zip(users, sides.values(), strict=True):
            first = path_by_name(path).position(0.0)
            wait_until(
                lambda user=user, first=first: np.linalg.norm(user.recorder.tip_now() - first) < 1e-4,
                "the tip does not come to its first point",
            )
            user.recorder.take()
        for user, path in zip(users, sides.values(), strict=True):
            user.start(path)
        for user in users:
            wait_until(lambda user=user: user.recorder.count("setpoint") > 100 * period, "no setpoints")
        wait_until(lambda: len({part(message) for message in heard}) == 8, "a node says nothing of itself")
        recordings = [user.recorder.take() for user in users]

    assert {part(message) for message in heard} == {f"{side}/{node}" for side in sides for node in NODES}
    for path, recording in zip(map(path_by_name, sides.values()), recordings, strict=True):
        setpoints = recording.setpoints()
        numbers = setpoint_numbers(setpoints.values, path, 100.0, period)  # refuses a foreign setpoint
        start = (setpoints.time - numbers / 100.0).min()
        tips = recording.tips().between(start, start + period)
        desired = path.position(2.0 * np.pi * (tips.time - start) / period)
        # The other's path is 16 mm away at every time, 39 in the median.
        assert np.median(np.linalg.norm(tips.values - desired, axis=1)) < 0.01
        answers = np.array([[float(v[axis]) for axis in "xyz"] for v in recording.verdicts()])
        own = {tuple(point) for point in setpoints.values}
        assert all(tuple(answer) in own for answer in answers[1:])


def part(message):
    """Which node a diagnostic message is from."""
    return message.status[0].name.split(":")[0]


def test_the_script_without_launch_says_that_all_is_well():
    script = Path(__file__).with_name("spin_all_nodes.py")
    command = [sys.executable, str(script), "--seconds", "3", "--namespace", "left"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    for name in NODES:
        assert name in done.stdout
