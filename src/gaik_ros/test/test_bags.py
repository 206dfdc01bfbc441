"""Bags and what is read from them, without ROS: the messages are made by rosbags."""

import subprocess
import sys

import numpy as np
import pytest

from gaik_core import KinematicChain
from gaik_core.cli.main import main
from gaik_core.errors import UnknownNameError
from gaik_ros.bag_reader import read_bag
from gaik_ros.bag_writer import BagError, BagWriter, typestore
from gaik_ros.recorded_runs import due_times, runs_of
from gaik_ros.tracking import tracking_error

STORE = typestore()
CHAIN = KinematicChain.load("touch_device")
START = 1_700_000_000.0  # s
CENTRE = np.array([0.0, 0.02, 0.0])


def message(kind, /, **fields):
    return STORE.types[kind](**fields)


def stamp(time):
    seconds = int(np.floor(time))
    return message("builtin_interfaces/msg/Time", sec=seconds, nanosec=round(1e9 * (time - seconds)))


def header(time):
    return message("std_msgs/msg/Header", stamp=stamp(time), frame_id="")


def point(position):
    x, y, z = (float(value) for value in position)
    return message("geometry_msgs/msg/Point", x=x, y=y, z=z)


def joints(time, angles, names=CHAIN.joint_names):
    empty = np.empty(0)
    return message(
        "sensor_msgs/msg/JointState",
        header=header(time),
        name=list(names),
        position=np.array(angles, dtype=np.float64),
        velocity=empty,
        effort=empty,
    )


def put(writer, topic, time, content):
    name = content.__msgtype__
    writer.write(topic, name, round(1e9 * time), bytes(STORE.serialize_cdr(content, name)))


def path(time):
    """A circle of 20 mm in 2 s."""
    turn = np.pi * np.asarray(time)
    return CENTRE + 0.02 * np.stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)], axis=-1)


def arms(points):
    """Joint angles that bring the tip there."""
    from gaik_core import LevenbergMarquardt, solve_path

    return solve_path(CHAIN, points, rule=LevenbergMarquardt(), tolerance=1e-9).angles


def device_bag(folder, namespace="", lag=0.02, seconds=2.0, jitter=0.0, clock=0.0, with_tip=False, begin=0.0):
    """A bag as of a real device: six joints, `lag` s late, stamps `clock` s ahead of the recorder's clock."""
    random = np.random.default_rng(0)
    names = ("roll", *CHAIN.joint_names[::-1], "pitch")
    with BagWriter(folder) as writer:
        for time in begin + np.arange(0.0, seconds, 0.01):
            late = jitter * random.exponential()
            put(writer, f"{namespace}/setpoint", START + time + late, point(path(time)))
        times = begin + np.arange(0.0, seconds, 0.002)
        for time, angles in zip(times, arms(path(times - lag)), strict=True):
            states = joints(START + time + clock, [0.1, *angles[::-1], 0.2], names)
            put(writer, f"{namespace}/joint_states", START + time, states)
            if with_tip:
                tip = message(
                    "geometry_msgs/msg/PointStamped",
                    header=header(START + time + clock),
                    point=point(CHAIN.forward(angles)),
                )
                put(writer, f"{namespace}/tip", START + time, tip)
    return folder


# The tip is `lag` s late on a circle of 20 mm, π rad/s: the chord between the two points.
CHORD = 2 * 0.02 * np.sin(np.pi * 0.02 / 2)


@pytest.mark.parametrize("with_tip", [True, False], ids=["with tip", "from the joints"])
def test_the_error_is_that_of_a_tip_that_is_late(tmp_path, with_tip):
    bag = device_bag(tmp_path / "run", with_tip=with_tip)
    (run,) = runs_of(read_bag(bag), CHAIN)
    error = tracking_error(run)
    assert error.rms_m == pytest.approx(CHORD, rel=1e-3)
    assert error.max_m == pytest.approx(CHORD, rel=1e-2)
    assert run.joint_names == CHAIN.joint_names
    assert run.setpoint.time.size == 200


def test_setpoints_that_arrive_late_do_not_count_as_error(tmp_path):
    (run,) = runs_of(read_bag(device_bag(tmp_path / "run", jitter=0.003)), CHAIN)
    assert tracking_error(run).rms_m == pytest.approx(CHORD, rel=0.02)


def test_stamps_of_another_clock_give_way_to_the_time_of_receipt(tmp_path):
    (run,) = runs_of(read_bag(device_bag(tmp_path / "run", clock=3600.0)), CHAIN)
    assert tracking_error(run).rms_m == pytest.approx(CHORD, rel=1e-3)


def test_the_folder_its_file_and_a_file_alone_are_the_same_bag(tmp_path):
    folder = device_bag(tmp_path / "run")
    alone = tmp_path / "other.mcap"
    alone.write_bytes((folder / "run.mcap").read_bytes())
    errors = {tracking_error(runs_of(read_bag(p), CHAIN)[0]) for p in (folder, folder / "run.mcap", alone)}
    assert len(errors) == 1


def test_reading_needs_no_ros(tmp_path):
    device_bag(tmp_path / "run")
    code = (
        "import sys; sys.modules['rclpy'] = sys.modules['sensor_msgs'] = None\n"
        "from gaik_core.cli.main import main; sys.exit(main(sys.argv[1:]))"
    )
    command = [sys.executable, "-c", code, "plot", str(tmp_path / "run"), "--out", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "fig21_path.png").stat().st_size > 10_000
    assert (tmp_path / "fig22_joints.png").stat().st_size > 10_000


def test_several_suites_are_told_apart_by_their_namespace(tmp_path):
    folder = tmp_path / "run"
    with BagWriter(folder) as writer:
        for namespace, offset in (("/left", 0.0), ("/right/arm", 0.005)):
            for k in range(3):
                put(writer, f"{namespace}/setpoint", START + 0.1 * k, point(path(0.1 * k)))
            times = np.arange(0.0, 0.2, 0.01)
            for time, angles in zip(times, arms(path(times) + np.array([offset, 0.0, 0.0])), strict=True):
                put(writer, f"{namespace}/joint_states", START + time, joints(START + time, angles))
    with pytest.raises(BagError, match=r"several suites.*--namespace: /left, /right/arm"):
        read_bag(folder)
    with pytest.raises(UnknownNameError, match=r"'lft'.*/left"):
        read_bag(folder, "lft")
    error = tracking_error(runs_of(read_bag(folder, "right/arm"), CHAIN)[0])
    assert error.max_m > 0.004
    assert tracking_error(runs_of(read_bag(folder, "/left"), CHAIN)[0]).max_m < 0.003


def test_runs_are_cut_where_setpoints_pause_and_the_way_to_the_first_does_not_count(tmp_path):
    folder = tmp_path / "run"
    with BagWriter(folder) as writer:
        for begin in (1.0, 5.0):
            for time in np.arange(0.0, 2.0, 0.01):
                put(writer, "/setpoint", START + begin + time, point(path(time)))
        put(writer, "/setpoint", START + 3.9, point([0.0, 0.0, 0.0]))  # one alone, on the way
        put(writer, "/setpoint", START + 4.0, point([np.nan, 0.0, 0.0]))
        times = np.arange(0.0, 7.0, 0.005)
        # The device rests elsewhere until 0.5 s after the first run has begun.
        aims = np.where(
            (times < 1.5)[:, None], [0.0, 0.0, 0.05], path(np.where(times < 4.5, times - 1, times - 5))
        )
        for time, angles in zip(times, arms(aims), strict=True):
            put(writer, "/joint_states", START + time, joints(START + time, angles))
    first, second = runs_of(read_bag(folder), CHAIN)
    assert first.course.start == pytest.approx(START + 1.5, abs=0.02)
    assert second.course.start == pytest.approx(START + 5.0, abs=0.02)
    for run in (first, second):
        assert tracking_error(run).max_m < 1e-4
    assert len(runs_of(read_bag(folder), CHAIN, gap=10.0)) == 1


def test_a_single_setpoint_is_held_to_the_end(tmp_path):
    folder = tmp_path / "run"
    with BagWriter(folder) as writer:
        put(writer, "/setpoint", START, point(path(0.0)))
        times = np.arange(0.0, 1.0, 0.01)
        aims = path(0.0) + np.outer(np.clip(0.5 - times, 0.0, None), [0.0, 0.0, 0.1])
        for time, angles in zip(times, arms(aims), strict=True):
            put(writer, "/joint_states", START + time, joints(START + time, angles))
    (run,) = runs_of(read_bag(folder), CHAIN)
    assert run.course.end == pytest.approx(START + 0.99)
    assert tracking_error(run).max_m < 5e-3  # it counts from where the tip has arrived


def test_a_tip_that_only_crosses_the_path_has_not_arrived(tmp_path):
    folder = tmp_path / "run"
    with BagWriter(folder) as writer:
        for time in np.arange(0.0, 2.0, 0.01):
            put(writer, "/setpoint", START + time, point(path(time)))
        times = np.arange(0.0, 2.0, 0.005)
        # It is there for 50 ms at 0.3 s, and for good from 1 s on.
        away = np.where((np.abs(times - 0.3) < 0.025) | (times > 1.0), 0.0, 0.03)
        aims = path(times) + np.outer(away, [0.0, 0.0, 1.0])
        for time, angles in zip(times, arms(aims), strict=True):
            put(writer, "/joint_states", START + time, joints(START + time, angles))
    (run,) = runs_of(read_bag(folder), CHAIN)
    assert run.course.start == pytest.approx(START + 1.0, abs=0.01)
    assert tracking_error(run).max_m < 1e-4


def test_due_times_take_lateness_away_and_find_what_was_lost():
    random = np.random.default_rng(1)
    due = START + 0.01 * np.arange(600)
    received = np.maximum.accumulate(due + 0.002 * random.exponential(size=600))
    np.testing.assert_allclose(due_times(received), due, atol=2e-4)
    kept = np.r_[0:200, 230:600]  # a stall of 0.3 s in which nothing was sent
    np.testing.assert_allclose(due_times(received[kept]), due[kept], atol=2e-4)
    stalled = received.copy()
    stalled[300:310] = received[310]  # ten that come at once, late
    np.testing.assert_allclose(due_times(np.maximum.accumulate(stalled)), due, atol=2e-4)


def test_setpoints_at_no_rate_keep_their_times():
    random = np.random.default_rng(2)
    times = START + np.cumsum(random.exponential(0.05, size=300))
    assert (due_times(times) == times).all()
    few = START + np.array([0.0, 1.0, 5.0])
    assert (due_times(few) == few).all()


def test_bags_are_not_overwritten_unless_told_and_then_at_the_end_only(tmp_path):
    folder = device_bag(tmp_path / "run", seconds=0.1)
    before = (folder / "run.mcap").read_bytes()
    with pytest.raises(BagError, match="exists already"):
        BagWriter(folder)
    writer = BagWriter(folder, replace=True)
    put(writer, "/setpoint", START, point([0.0, 0.0, 0.0]))
    assert (folder / "run.mcap").read_bytes() == before
    writer.close()
    assert (folder / "run.mcap").read_bytes() != before
    assert sorted(p.name for p in tmp_path.iterdir()) == ["run"]
    other = tmp_path / "notes"
    other.mkdir()
    (other / "mine.txt").write_text("keep")
    with pytest.raises(BagError, match="exists already"):
        BagWriter(other, replace=True)


def test_a_bag_stays_where_its_successor_is_interrupted(tmp_path):
    folder = device_bag(tmp_path / "run", seconds=0.1)
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    with pytest.raises(KeyboardInterrupt), BagWriter(folder, replace=True) as writer:
        put(writer, "/setpoint", START, point([0.0, 0.0, 0.0]))
        raise KeyboardInterrupt
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before
    assert sorted(p.name for p in tmp_path.iterdir()) == ["run"]
    with pytest.raises(KeyboardInterrupt), BagWriter(tmp_path / "new") as writer:
        put(writer, "/setpoint", START, point([0.0, 0.0, 0.0]))
        put(writer, "/joint_states", START, joints(START, [0.1, 0.7, 0.8]))
        raise KeyboardInterrupt
    assert len(read_bag(tmp_path / "new").messages("setpoint")) == 1


def test_a_type_that_is_not_known_is_named(tmp_path):
    with BagWriter(tmp_path / "run") as writer:
        assert not writer.knows("omni_msgs/msg/OmniFeedback")
        with pytest.raises(BagError, match=r"/force has the type omni_msgs/msg/OmniFeedback"):
            writer.write("/force", "omni_msgs/msg/OmniFeedback", 0, b"")


# --- the command -----------------------------------------------------------------------------------------------------


def fails(capsys, arguments, *words):
    assert main([str(argument) for argument in arguments]) == 2
    out, err = capsys.readouterr()
    assert not out
    assert err.count("\n") == 1 and err.startswith("gaik: ")
    for word in words:
        assert word in err


def test_bad_bags_and_options_are_answered_in_one_line(capsys, tmp_path):
    fails(capsys, ["plot", tmp_path / "none.mcap"], "none.mcap: there is no such bag")
    (tmp_path / "empty.mcap").write_bytes(b"")
    fails(capsys, ["plot", tmp_path / "empty.mcap"], "empty.mcap", "mcap recover")
    (tmp_path / "text.txt").write_text("hello")
    fails(capsys, ["plot", tmp_path / "text.txt"], "text.txt", ".txt")
    fails(capsys, ["plot", tmp_path], "metadata")
    with BagWriter(tmp_path / "other") as writer:
        put(writer, "/chatter", START, message("std_msgs/msg/String", data="hello"))
    fails(capsys, ["plot", tmp_path / "other"], "no suite's setpoint and joint_states", "/chatter")
    good = device_bag(tmp_path / "good", seconds=0.2)
    fails(capsys, ["plot", good, "--run", "2"], "--run is 2; the bag has the runs 1 to 1")
    fails(capsys, ["plot", good, "--gap", "0"], "--gap is 0")
    fails(capsys, ["plot", good, "--robot", "planar3"], "joint")
    fails(capsys, ["replay", good, "-p", "pid_controller"], "NODE:NAME:=VALUE")
    fails(capsys, ["replay", good, "--live", "1st"], "namespace")
    half = tmp_path / "half.mcap"
    half.write_bytes((good / "good.mcap").read_bytes()[:5000])
    fails(capsys, ["plot", half], "half.mcap", "mcap recover")
    (good / "metadata.yaml").unlink()  # as of a recorder that was killed
    fails(capsys, ["plot", good], "good: is no bag, as it has no metadata.yaml", "mcap recover")
