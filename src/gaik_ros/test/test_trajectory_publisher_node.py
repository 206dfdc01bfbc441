"""trajectory_publisher over real rclpy: what it sends, when it starts and stops."""

import time

import numpy as np
import pytest
from ros_bench import Bench, overrides, wait_until
from std_srvs.srv import Trigger

from gaik_core.paths import Circle, Lemniscate
from gaik_ros.run import running
from gaik_ros.trajectory_publisher import TrajectoryPublisher


@pytest.fixture
def start(context):
    blocks = []

    def build(**values):
        bench = Bench(context)
        node = TrajectoryPublisher(context=context, parameter_overrides=overrides(autostart=False, **values))
        block = running([bench, node], context)
        block.__enter__()
        blocks.append(block)
        wait_until(
            lambda: bench.count_publishers("setpoint") >= 2 and node._publisher.get_subscription_count()
        )
        return bench, node

    yield build
    for block in blocks:
        block.__exit__(None, None, None)


def heard(bench):
    return np.array([(m.x, m.y, m.z) for m in bench.setpoints])


def trigger(bench, name):
    answer = bench.call(f"trajectory_publisher/{name}", Trigger.Request())
    assert answer.success
    return answer.message


@pytest.mark.parametrize(("name", "path"), [("circle", Circle()), ("lemniscate", Lemniscate())])
def test_one_lap_is_sent_point_by_point_and_ends_where_it_began(start, name, path):
    bench, node = start(path=name, lap_time=1.0, loop=False)
    assert not bench.setpoints
    skipped_before = node.loop.schedule.skipped
    trigger(bench, "start")
    wait_until(lambda: not node._running)
    wait_until(lambda: len(bench.setpoints) == node._sent)
    points = heard(bench)
    # Some of these were perhaps left out just before the path, or after it.
    skipped = node.loop.schedule.skipped - skipped_before
    assert 101 - skipped <= len(points) <= 101
    np.testing.assert_allclose(points[0], path.position(0.0), atol=1e-12)
    np.testing.assert_allclose(points[-1], path.position(0.0), atol=1e-12)
    exact = path.position(2 * np.pi * np.arange(101) / 100)
    assert all(np.linalg.norm(exact - point, axis=1).min() < 1e-9 for point in points)


def test_stop_stops_and_start_begins_anew(start):
    bench, _ = start()
    trigger(bench, "start")
    wait_until(lambda: len(bench.setpoints) > 20)
    assert trigger(bench, "stop") == "stopped"
    time.sleep(0.1)
    count = len(bench.setpoints)
    time.sleep(0.3)
    assert len(bench.setpoints) == count
    assert trigger(bench, "stop") == "it was not running"
    trigger(bench, "start")
    wait_until(lambda: len(bench.setpoints) > count)
    np.testing.assert_allclose(heard(bench)[count], Circle().position(0.0), atol=1e-12)


def test_points_come_from_a_file_as_they_stand(start, tmp_path):
    file = tmp_path / "points.csv"
    points = np.random.default_rng(0).uniform(-0.05, 0.05, (20, 3))
    file.write_text("x,y,z\n" + "\n".join(",".join(map(repr, row)) for row in points.tolist()))
    bench, node = start(path="points", file=str(file), loop=False, rate=50)
    trigger(bench, "start")
    wait_until(lambda: not node._running and len(bench.setpoints) == node._sent)
    if node.loop.schedule.skipped == 0:
        np.testing.assert_array_equal(heard(bench), points)
    np.testing.assert_array_equal(heard(bench)[[0, -1]], points[[0, -1]])


def test_a_change_of_path_is_refused_whole_where_the_file_is_bad(start, tmp_path):
    bench, node = start()
    refused = bench.change(
        "trajectory_publisher", path="points", file=str(tmp_path / "none.csv"), radius=0.01
    )
    assert not refused.successful
    assert "none.csv" in refused.reason
    assert (node.values.path, node.values.radius) == ("circle", 0.05)
    assert not bench.change("trajectory_publisher", centre=[0.0, 1.0]).successful
    assert bench.change("trajectory_publisher", path="lemniscate", half_width=0.05).successful
    trigger(bench, "start")
    wait_until(lambda: bench.setpoints)
    np.testing.assert_allclose(heard(bench)[0], [0.05, 0.0, 0.0], atol=1e-12)


def largest_step(bench):
    return np.linalg.norm(np.diff(heard(bench), axis=0), axis=1).max()


def test_another_lap_time_goes_on_from_where_the_setpoint_is(start):
    bench, node = start(lap_time=6.3)
    skipped_before = node.loop.schedule.skipped
    trigger(bench, "start")
    wait_until(lambda: len(bench.setpoints) > 100)
    assert bench.change("trajectory_publisher", lap_time=3.0).successful
    count = len(bench.setpoints)
    wait_until(lambda: len(bench.setpoints) > count + 50)
    left_out = node.loop.schedule.skipped - skipped_before
    assert largest_step(bench) < (1 + left_out) * 1.1 * 2 * np.pi * 0.05 / 3.0 / 100


def test_a_path_that_shall_not_loop_any_more_goes_on_to_the_end_of_its_lap(start):
    bench, node = start(lap_time=1.0)
    skipped_before = node.loop.schedule.skipped
    trigger(bench, "start")
    wait_until(lambda: len(bench.setpoints) > 130)
    assert bench.change("trajectory_publisher", loop=False).successful
    wait_until(lambda: not node._running and len(bench.setpoints) == node._sent)
    left_out = node.loop.schedule.skipped - skipped_before
    assert largest_step(bench) < (1 + left_out) * 1.1 * 2 * np.pi * 0.05 / 100
    np.testing.assert_allclose(heard(bench)[-1], Circle().position(0.0), atol=1e-12)


def test_a_file_of_points_is_read_when_it_is_chosen_and_not_again(start, tmp_path):
    file = tmp_path / "points.csv"
    file.write_text("x,y,z\n0.01,0.02,0.03\n")
    bench, node = start(path="points", file=str(file))
    file.unlink()
    assert bench.change("trajectory_publisher", loop=False, diagnostics__rate_warn=0.9).successful
    refused = bench.change("trajectory_publisher", file=str(tmp_path / "another.csv"))
    assert not refused.successful
    assert "another.csv" in refused.reason
    trigger(bench, "start")
    wait_until(lambda: not node._running and len(bench.setpoints) == node._sent)
    np.testing.assert_array_equal(heard(bench), [[0.01, 0.02, 0.03]])
    assert bench.change("trajectory_publisher", path="circle").successful
    assert not bench.change("trajectory_publisher", path="points").successful


@pytest.mark.slow
@pytest.mark.parametrize("rate", [0.5, 2.0])
def test_a_slow_path_is_not_called_stalled(start, rate):
    bench, node = start(rate=rate)
    name = "trajectory_publisher: loop"
    wait_until(lambda: node.loop.periods.ticks > 2)

    def newest():
        return [status for m in bench.diagnostics for status in m.status if status.name == name][-4:]

    wait_until(lambda: len(newest()) == 4 and all(status.level != b"\x02" for status in newest()))
