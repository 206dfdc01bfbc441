#!/usr/bin/env python3
"""On one host: hear what arrives there of a suite, lead the arm to and fro if asked, and save it at the end.

    python test/host_watcher.py OUT.npz joint_states [--lead]

Prints a line once the topic is heard, and saves when a line comes on stdin. test_two_hosts.py runs one on each host.
"""

from __future__ import annotations

import argparse
import contextlib
import sys

import numpy as np
from spin_all_nodes import ros_context, wait_until

from gaik_core import KinematicChain
from gaik_ros.faults.facts import read_facts
from gaik_ros.faults.probe import Probe, Recording
from gaik_ros.faults.remote import Remote
from gaik_ros.faults.stage import Stage
from gaik_ros.run import running

NAMES = list(KinematicChain.load("touch_device").joint_names)
FIELDS = {"joint_states": "position", "joint_reference": "position", "joint_command": "effort"}


def columns(recording: Recording) -> dict[str, np.ndarray]:
    """The time of receipt (s of the machine's monotonic clock) and the values of each topic."""
    saved = {}
    for topic, field in FIELDS.items():
        joints = recording.joints(topic, NAMES, field)
        saved[f"{topic}_time"], saved[topic] = joints.received, joints.values
    errors = [
        report.received for report in recording.health("pid_controller: control") if report.level >= b"\x02"
    ]
    return saved | {"errors": np.array(errors)}


def main() -> None:
    """Watch until a line comes."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out")
    parser.add_argument("topic", choices=FIELDS)
    parser.add_argument("--lead", action="store_true")
    given = parser.parse_args()
    with ros_context() as context, contextlib.ExitStack() as stack:
        probe = Probe("", context)
        stack.enter_context(running([probe], context))
        mark = probe.mark()
        if given.lead:
            remote = Remote(probe)
            stack.enter_context(Stage(probe, remote, read_facts(remote, patience=60.0)).moving())
        wait_until(lambda: probe.since(mark).count(given.topic) > 100, f"{given.topic} is not heard")
        print("heard", flush=True)
        sys.stdin.readline()
        np.savez(given.out, **columns(probe.since(mark)))


if __name__ == "__main__":
    main()
