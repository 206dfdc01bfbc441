"""The soak: what it calls flat, and a short run of it."""

import subprocess
import sys

import numpy as np
import pytest

from touch_sim.soak import FLAT, growth


def test_memory_that_stands_still_or_wavers_is_flat():
    wavering = 200.0 + np.random.default_rng(1).normal(0.0, 0.3, 40)
    assert abs(growth(wavering)) < FLAT
    assert growth([200.0] * 40) == 0.0


def test_what_grows_at_the_start_only_is_flat():
    assert growth([150.0] * 8 + [200.0] * 32) == 0.0


@pytest.mark.parametrize("leak", [0.1, 1.0])
def test_a_leak_is_seen(leak):
    assert growth(200.0 + leak * np.arange(40)) > FLAT


@pytest.mark.slow
def test_a_short_soak_reports_memory_and_periods():
    command = [sys.executable, "-m", "touch_sim.soak", "--minutes", "0.1"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode in (0, 1), done.stderr  # so short a run may still be warming up
    lines = done.stdout.splitlines()
    assert lines[-1].startswith("memory ")
    assert len(lines) >= 5
    assert all("MiB" in line and "p99" in line for line in lines[:-1])


def test_a_wrong_time_is_one_line():
    done = subprocess.run(
        [sys.executable, "-m", "touch_sim.soak", "--minutes", "-1"],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
