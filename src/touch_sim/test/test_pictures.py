"""The README's pictures, drawn from runs without ROS."""

from itertools import pairwise

import matplotlib.image
import numpy as np
import pytest
from PIL import Image

from touch_sim import pictures
from touch_sim.experiments import follow_without_ros

LAP = 2.0  # s


@pytest.fixture(scope="module")
def drawn(tmp_path_factory):
    """The folder that the command has written into."""
    folder = tmp_path_factory.mktemp("pictures") / "new"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pictures, "follow", lambda: follow_without_ros(period=LAP))
        assert pictures.main(["--out", str(folder)]) == 0
    return folder


def red(pixels):
    """How many are of the path followed."""
    return int(((pixels[..., 0] > 230) & (pixels[..., 1:3] < 40).all(axis=-1)).sum())


def test_the_path_is_drawn_at_the_readmes_width(drawn):
    pixels = matplotlib.image.imread(drawn / "demo_path.png")[..., :3]
    assert 1150 <= pixels.shape[1] <= 1250
    assert red(255 * pixels) > 500
    assert min(pixels[:2].min(), pixels[-2:].min(), pixels[:, :2].min(), pixels[:, -2:].min()) > 0.99


def test_the_arm_moves_and_its_trace_grows(drawn):
    file = drawn / "demo.gif"
    assert file.stat().st_size < 1_500_000 * LAP / 6.3
    with Image.open(file) as moving:
        frames = []
        for number in range(moving.n_frames):
            moving.seek(number)
            frames.append(np.asarray(moving.convert("RGB"), dtype=int))
            assert moving.info["duration"] == 100
        assert moving.info["loop"] == 0
    assert len(frames) == 2 * 10 * LAP
    assert max(frames[0].shape) < 500
    for lap in (frames[: len(frames) // 2], frames[len(frames) // 2 :]):
        legend = red(lap[0])
        assert red(lap[-1]) > red(lap[len(lap) // 2]) > red(lap[2]) > legend
        assert red(lap[-1]) > 5 * legend
        assert all((before != after).any() for before, after in pairwise(lap))
    for frame in frames:
        assert min(frame[:2].min(), frame[-2:].min(), frame[:, :2].min(), frame[:, -2:].min()) > 250


def test_a_folder_that_cannot_be_is_said_before_anything_runs(capsys, monkeypatch):
    monkeypatch.setattr(pictures, "follow", lambda: pytest.fail("it ran"))
    assert pictures.main(["--out", "/proc/nowhere"]) == 1
    assert "/proc/nowhere" in capsys.readouterr().err
