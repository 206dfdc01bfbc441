"""The soak: memory that rises is noticed, memory that fills once is not held against the suite, and it runs."""

import os
import subprocess
import sys

import numpy as np
import pytest

from touch_sim.soak import FLAT, Sample, slope


def samples(memory):
    return [Sample(0.5 * i, float(mb), 1000.0, 1.0, 2.0) for i, mb in enumerate(memory)]


def test_a_leak_is_noticed_and_measured():
    assert slope(samples(200 + 0.25 * np.arange(40))) == pytest.approx(5.0)  # a quarter each half minute


def test_what_fills_once_is_flat():
    filled = 200 + 30 * (1 - np.exp(-np.arange(40) / 2.0)) + 0.01 * np.sin(np.arange(40))
    assert abs(slope(samples(filled))) < FLAT


def test_it_runs_and_writes_its_samples(tmp_path):
    command = [
        sys.executable,
        "-m",
        "touch_sim.soak",
        "--minutes",
        "0.1",
        "--every",
        "2",
        "--out",
        str(tmp_path),
    ]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert "MB in ten minutes" in done.stdout, done.stderr
    rows = (tmp_path / "soak.csv").read_text().splitlines()
    assert rows[0].startswith("minutes,memory_mb") and len(rows) >= 3


def test_a_wrong_option_is_one_line_and_exit_code_2():
    done = subprocess.run(
        [sys.executable, "-m", "touch_sim.soak", "--minutes", "-1"],
        capture_output=True,
        text=True,
        env=os.environ,
    )
    assert done.returncode == 2 and "--minutes is -1" in done.stderr and "Traceback" not in done.stderr
