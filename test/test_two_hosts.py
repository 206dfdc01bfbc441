"""Two hosts made of network namespaces: controller and IK on one, the device on the other, and a cable between.

The cable is pulled for two seconds and put back: the arm holds, then follows again, and nothing is restarted. Needs
root and iproute2.
"""

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from gaik_ros.faults.suite_processes import command_of

PULLED = 2.0  # s
BRAKES = 1.0  # s after the cable is pulled: ten times the timeouts of device and controller
PATIENCE = 120.0  # s
STILL = 4e-3  # rad
ON_COURSE = 0.1  # rad
HERE = Path(__file__).parent


def ip(*arguments, check=True):
    return subprocess.run(["ip", *arguments], check=check, capture_output=True, timeout=PATIENCE).returncode


def lacks():
    """What is missing for two hosts; empty if nothing is."""
    if os.geteuid() != 0:
        return "two hosts need root"
    if shutil.which("ip") is None:
        return "two hosts need `ip`: sudo apt install iproute2"
    trial = f"gaik{os.getpid()}t"
    if subprocess.run(
        ["ip", "netns", "add", trial], capture_output=True, timeout=PATIENCE, check=False
    ).returncode:
        return "network namespaces are not allowed here"
    ip("netns", "del", trial)
    return ""


class Host:
    """One network namespace with a loopback and one end of the cable."""

    def __init__(self, name, number, cable):
        self.name, self.cable, self.processes = name, cable, []
        ip("netns", "add", name)
        ip("link", "set", cable, "netns", name)
        ip("-n", name, "address", "add", f"10.77.0.{number}/24", "dev", cable)
        ip("-n", name, "link", "set", "lo", "up")
        self.plug()

    def plug(self):
        ip("-n", self.name, "link", "set", self.cable, "up")
        # Discovery is by multicast, whose route is lost with the link.
        ip("-n", self.name, "route", "replace", "224.0.0.0/4", "dev", self.cable)

    def pull(self):
        ip("-n", self.name, "link", "set", self.cable, "down")

    def start(self, command, **options):
        # Shared memory would be a second cable between two hosts that are one machine.
        ours = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET", "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4"}
        process = subprocess.Popen(
            ["ip", "netns", "exec", self.name, *command], env=os.environ | ours, text=True, **options
        )
        self.processes.append(process)
        return process

    def watch(self, out, topic, *options):
        """Start a watcher; it has heard the topic when a line comes."""
        command = [sys.executable, str(HERE / "host_watcher.py"), str(out), topic, *options]
        return self.start(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def end(self):
        for process in self.processes:
            if process.poll() is None:
                process.send_signal(signal.SIGTERM)
        for process in self.processes:
            try:
                process.wait(20.0)
            except subprocess.TimeoutExpired:
                process.kill()


@contextlib.contextmanager
def two_hosts():
    """Two hosts with a cable between them; gone afterwards, whatever happens."""
    names, ends = [f"gaik{os.getpid()}{side}" for side in "ab"], [f"gk{os.getpid()}{side}" for side in "ab"]
    with contextlib.ExitStack() as stack:
        ip("link", "add", ends[0], "type", "veth", "peer", "name", ends[1])
        stack.callback(
            ip, "link", "del", ends[0], check=False
        )  # gone with its namespace already, if all went well
        for name in names:
            stack.callback(ip, "netns", "del", name, check=False)
        hosts = []
        for number, (name, end) in enumerate(zip(names, ends, strict=True), start=1):
            hosts.append(Host(name, number, end))
            stack.callback(hosts[-1].end)
        yield hosts


def finish(watcher, out):
    watcher.communicate("stop\n", timeout=PATIENCE)
    return np.load(out)


def distances(states, leader):
    """How far the device is from the newest reference, (n,) rad, at the times (n,) s of its states."""
    held = np.searchsorted(leader["joint_reference_time"], states["joint_states_time"], side="right") - 1
    away = np.abs(states["joint_states"] - leader["joint_reference"][np.maximum(held, 0)]).max(axis=1)
    return states["joint_states_time"], np.where(held >= 0, away, np.inf)


@pytest.mark.skipif(bool(reason := lacks()), reason=reason)
def test_a_cable_is_pulled_for_two_seconds_and_put_back(tmp_path):
    with two_hosts() as (desk, device):
        nodes = [desk.start(command_of("ik_node")), desk.start(command_of("pid_controller"))]
        nodes.append(device.start(command_of("touch_sim")))
        at_device = device.watch(tmp_path / "device.npz", "joint_states")
        at_desk = desk.watch(tmp_path / "desk.npz", "joint_states", "--lead")
        for watcher in (at_device, at_desk):
            assert watcher.stdout.readline() == "heard\n"
        time.sleep(5.0)
        pulled = time.monotonic()
        device.pull()
        time.sleep(PULLED)
        back = time.monotonic()
        device.plug()
        time.sleep(8.0)
        states, desk_heard = (
            finish(at_device, tmp_path / "device.npz"),
            finish(at_desk, tmp_path / "desk.npz"),
        )
        assert [node.poll() for node in nodes] == [None, None, None]

    now, away = distances(states, desk_heard)
    before = (now > pulled - 2.0) & (now < pulled)
    assert before.sum() > 100
    assert np.percentile(away[before], 90) < ON_COURSE

    held = (now > pulled + BRAKES) & (now < back)
    assert held.sum() > 100
    assert np.ptp(states["joint_states"][held], axis=0).max() < STILL
    desk_time, efforts = desk_heard["joint_command_time"], desk_heard["joint_command"]
    powerless = (desk_time > pulled + BRAKES) & (desk_time < back)
    assert powerless.sum() > 100
    assert np.abs(efforts[powerless]).max() == 0.0
    assert ((desk_heard["errors"] > pulled) & (desk_heard["errors"] < back + 1.0)).any()

    after = now > back + 6.0
    assert after.sum() > 100
    assert np.percentile(away[after], 90) < ON_COURSE
    assert np.ptp(states["joint_states"][after], axis=0).max() > 10.0 * STILL  # the device itself moves again
    for side in (states, desk_heard):
        assert np.isfinite(side["joint_command"]).all()
        assert np.abs(side["joint_command"]).max() <= 1.0
