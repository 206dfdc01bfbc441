"""The viewer as a node among others: what it hears, what it does not disturb, and to whom it listens."""

import re
import signal
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

import numpy as np
import pytest
import rclpy
from rclpy.serialization import serialize_message
from ros_bench import NAMES, Bench, overrides, wait_until

from gaik_core import KinematicChain
from gaik_ros.conversions import joint_state
from gaik_ros.ik_node import IkNode
from gaik_ros.pid_controller import PidController
from gaik_ros.reference_page import section
from gaik_ros.run import running
from gaik_ros.trajectory_publisher import TrajectoryPublisher
from gaik_ros.viewer.node import TABLE, Viewer
from gaik_ros.viewer.suite_client import NodeNames, SuiteClient, SuiteError

viser = pytest.importorskip("viser", reason="no viser; install it with: pip install 'viser>=1.1,<2'")

CHAIN = KinematicChain.load("touch_device")
SCRIPT = Path(__file__).parents[1] / "scripts" / "viewer"
PATIENCE = 60.0
NODES = NodeNames("trajectory_publisher", "ik_node", "pid_controller", "touch_sim")


def viewer_in(context, **values):
    namespace = values.pop("namespace", "")
    return Viewer(
        context=context,
        namespace=namespace,
        parameter_overrides=overrides(port=0, **values),
        use_global_arguments=False,
    )


@pytest.fixture
def bench(context):
    bench = Bench(context)
    bench.publishing = True
    return bench


def test_it_hears_the_device_the_setpoints_and_the_verdicts(context, bench):
    viewer = viewer_in(context)
    with running([bench, IkNode(context=context), viewer], context):
        picture = viewer._picture
        wait_until(
            lambda: picture.live(0.0) or np.allclose(picture.angles, bench.angles), "no state is heard"
        )
        bench.send([0.05, 0.05, 0.0])
        wait_until(lambda: picture.setpoint is not None, "no setpoint is heard")
        np.testing.assert_array_equal(picture.setpoint, [0.05, 0.05, 0.0])
        wait_until(lambda: picture.verdict.headline == "Reached", "no verdict is heard")
        wait_until(lambda: np.isfinite(picture.errors.columns(0.0)[2]).any(), "no reference is heard")
        wait_until(lambda: bench.level("viewer: page") == b"\x00", "it says nothing of itself")
        wait_until(
            lambda: any(node.rate > 90 for node in viewer._board.health(0.0) if node.name == "ik_node"),
            "the IK node's health is not heard",
        )


def test_one_that_only_looks_has_no_publisher_of_setpoints(context, bench):
    viewer = viewer_in(context)
    with running([bench, viewer], context):
        wait_until(lambda: np.allclose(viewer._picture.angles, bench.angles), "no state is heard")
        names = {info.node_name for info in bench.get_publishers_info_by_topic("/setpoint")}
        assert names == {"bench"}


def test_it_publishes_setpoints_only_while_they_are_sent(context, bench):
    viewer = viewer_in(context)

    def publishers():
        return {info.node_name for info in bench.get_publishers_info_by_topic("/setpoint")}

    with running([bench, viewer], context):
        viewer._outbox.send(np.array([0.01, 0.02, 0.03]))  # as a drag does
        wait_until(lambda: bench.setpoints, "the setpoint does not arrive, though nobody was waited for")
        assert (bench.setpoints[0].x, bench.setpoints[0].y, bench.setpoints[0].z) == (0.01, 0.02, 0.03)
        assert publishers() == {"bench", "viewer"}
        wait_until(lambda: publishers() == {"bench"}, "it stays a rival after the drag")
        viewer._outbox.repeat()
        wait_until(lambda: len(bench.setpoints) == 2, "the next does not arrive")


def test_a_setpoint_that_nobody_hears_is_forgotten(context):
    viewer = viewer_in(context)
    with running([viewer], context):
        viewer._outbox.send(np.zeros(3))
        wait_until(lambda: viewer._outbox._waiting is None, "it is kept for whoever may come")
        late = Bench(context)
        with running([late], context):
            wait_until(lambda: late.count_subscribers("/setpoint") == 2, "they do not meet")
            viewer._outbox.attend()
            time.sleep(0.5)
            assert late.setpoints == []


def test_the_suite_does_not_notice_it_leave(context, bench):
    bench.moving = True
    suite = [
        IkNode(context=context),
        PidController(context=context, parameter_overrides=overrides(rate=200.0)),
        TrajectoryPublisher(context=context),
    ]
    with running([bench, *suite], context):
        other = rclpy.Context()
        rclpy.init(context=other)
        viewer = viewer_in(other)
        with running([viewer], other):
            wait_until(lambda: viewer._picture.setpoint is not None, "no setpoint is heard")
        rclpy.try_shutdown(context=other)
        verdicts, commands = len(bench.verdicts), len(bench.commands)
        wait_until(lambda: len(bench.verdicts) > verdicts + 50, "the IK node stopped")
        wait_until(lambda: len(bench.commands) > commands + 100, "the controller stopped")
        assert set(bench.results()[verdicts:]) == {"reached"}


def test_it_looks_at_its_own_namespace(context):
    left, right = (
        rclpy.create_node("driver", namespace=side, context=context, use_global_arguments=False)
        for side in ("left", "right")
    )
    viewer = viewer_in(context, namespace="left")
    angles = {"left": [0.1, 0.5, 0.6], "right": [-0.3, 1.0, 1.2]}
    with running([left, right, viewer], context):
        for node, side in ((right, "right"), (left, "left")):
            publisher = node.create_publisher(type(joint_state(NAMES)), "joint_states", 10)
            node.create_timer(
                0.01, lambda p=publisher, s=side: p.publish(joint_state(NAMES, position=angles[s]))
            )
        wait_until(lambda: np.allclose(viewer._picture.angles, angles["left"]), "its own device is not heard")
        assert [health.name for health in viewer._board.health(0.0)] == [
            "left/trajectory_publisher",
            "left/ik_node",
            "left/pid_controller",
            "left/touch_sim",
        ]


def test_a_malformed_state_is_refused_and_the_next_good_one_drawn(context):
    driver = rclpy.create_node("driver", context=context)
    publisher = driver.create_publisher(type(joint_state(NAMES)), "joint_states", 10)
    viewer = viewer_in(context)
    with running([driver, viewer], context):
        for bad in (
            joint_state(["a", "b"], position=[1, 2]),
            joint_state(NAMES, position=[np.nan, 0, 0]),
            serialize_message(joint_state(NAMES, position=[1, 2, 3]))[:-10],
        ):
            refused = viewer._watch.refused.get("joint_states", 0)

            def is_refused(bad=bad, refused=refused):
                publisher.publish(bad)
                return viewer._watch.refused.get("joint_states", 0) > refused

            wait_until(is_refused, "a bad state is taken")
        np.testing.assert_array_equal(viewer._picture.angles, CHAIN.home)

        def is_drawn():
            publisher.publish(joint_state(reversed(NAMES), position=[0.7, 0.6, 0.5]))
            return np.allclose(viewer._picture.angles, [0.5, 0.6, 0.7])

        wait_until(is_drawn, "a good state is not taken")


# who may act


@pytest.fixture
def page(context):
    viewer = viewer_in(context)
    yield viewer.page
    viewer.destroy_node()


def handshake(page, **options):
    from websockets.sync.client import connect

    address = page.address.replace("http", "ws")
    with connect(address, subprotocols=[f"viser-v{viser.__version__}"], **options):
        return True


def test_the_page_is_served_on_this_machine_only(page):
    assert page.address.startswith("http://127.0.0.1:")
    with urllib.request.urlopen(page.address, timeout=PATIENCE) as response:
        assert response.status == 200
        assert b"<html" in response.read()


@pytest.mark.parametrize("origin", ["https://evil.example", "http://127.0.0.1.evil.example:8080", "null"])
def test_pages_of_other_sites_cannot_reach_the_device(page, origin):
    from websockets.exceptions import InvalidStatus

    with pytest.raises(InvalidStatus) as refused:
        handshake(page, origin=origin)
    assert refused.value.response.status_code == 403


def test_its_own_page_can(page):
    assert handshake(page, origin=page.address)
    assert handshake(page, origin=page.address.replace("127.0.0.1", "localhost"))


# what it asks of the suite


@pytest.fixture
def suite(context, bench):
    trajectory = TrajectoryPublisher(context=context, parameter_overrides=overrides(autostart=False))
    client = SuiteClient(bench, NODES)
    with running([bench, trajectory], context):
        wait_until(client.start.service_is_ready, "no service")
        yield client


def test_a_path_is_set_and_started_and_stopped(suite, bench):
    parameters = suite.parameters_of("trajectory_publisher", ["path"])
    wait_until(lambda: parameters.ready, "no parameters")
    assert suite.start_path(parameters, "lemniscate") == "lemniscate from its beginning"
    wait_until(lambda: len(bench.setpoints) > 20, "no path is followed")
    assert suite.stop_path() == "stopped"
    assert suite.stop_path() == "it was not running"


def test_what_a_node_refuses_is_told_with_its_reason(suite):
    parameters = suite.parameters_of("trajectory_publisher", ["path", "lap_time"])
    wait_until(lambda: parameters.ready, "no parameters")
    with pytest.raises(SuiteError, match=r"trajectory_publisher: .*'path' is 'square'.*circle"):
        suite.start_path(parameters, "square")
    reasons = []
    parameters.set({"lap_time": -1.0}, reasons.append)
    wait_until(lambda: reasons, "the refusal is not told")
    assert "'lap_time' is -1.0" in reasons[0]
    wait_until(lambda: parameters.read() or parameters.values, "no values come")
    assert parameters.values == {"path": "circle", "lap_time": 6.3}


def test_what_is_not_there_is_said_so(suite):
    nobody = suite.parameters_of("nobody", ["a"])
    reasons = []
    nobody.set({"a": 1.0}, reasons.append)
    assert reasons == ["nobody is not there"]
    nobody.read()
    assert nobody.values == {}
    with pytest.raises(SuiteError, match=r"there is no service .*pid_controller/reset"):
        from std_srvs.srv import Trigger

        from gaik_ros.viewer.suite_client import call

        call(suite.reset_controller, Trigger.Request())


# the program


def test_its_parameters_are_on_the_reference_page():
    assert section(TABLE) in (Path(__file__).parents[3] / "docs" / "nodes.md").read_text()


def start(*arguments, code=None):
    command = [sys.executable, *(("-c", code) if code else (str(SCRIPT),)), "--ros-args", *arguments]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def end(process):
    try:
        output, errors = process.communicate(timeout=PATIENCE)
    finally:
        process.kill()
    return process.returncode, output, errors


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=["SIGINT", "SIGTERM"])
def test_a_signal_ends_it_quietly(number):
    process = start("-p", "port:=0")
    said = process.stderr.readline()
    assert re.search(r"the page is at http://127\.0\.0\.1:\d+$", said.strip())
    process.send_signal(number)
    assert end(process) == (0, "", "")


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["-p", "robot:=tuch"], "unknown robot 'tuch'"),
        (["-p", "urdf:=/no/such.urdf"], "/no/such.urdf"),
        (["-p", "port:=99999"], "'port' is 99999"),
        (["-p", "host:=192.0.2.1", "-p", "port:=0"], "'host' is '192.0.2.1'"),
        (["-p", "up:=up"], "'up' is 'up': it may be one of"),
        (
            ["-p", "port:=0", "-p", 'urdf:=<robot name="a"><link name="b"/></robot>'],
            "no joint waist, shoulder, elbow",
        ),
    ],
)
def test_a_bad_parameter_ends_it_with_one_line(arguments, complaint):
    code, output, errors = end(start(*arguments))
    assert (code, output) == (2, "")
    assert errors.count("\n") == 1
    assert complaint in errors


def test_without_viser_it_says_how_to_install_it():
    hidden = (
        "import sys; sys.modules['viser'] = None; from gaik_ros.viewer.node import main; sys.exit(main())"
    )
    code, _, errors = end(start(code=hidden))
    assert code == 2
    assert errors.count("\n") == 1
    assert "the page needs viser; install it with:" in errors
