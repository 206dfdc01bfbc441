"""What `gaik reproduce` writes: pictures that show something and cut nothing off, numbers, a page."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from gaik_core.cli.main import main
from gaik_core.experiments import Comparison, Experiment, Findings, load_experiment
from gaik_core.experiments.page import page, shown
from gaik_core.experiments.registry import OWN

image = pytest.importorskip("matplotlib.image")

PICTURES = [name for name in OWN if name != "errata"]


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """The folders of one whole run of our own experiments."""
    folder = tmp_path_factory.mktemp("paper")
    assert main(["reproduce", *OWN, "--out", str(folder)]) == 0
    return folder


@pytest.mark.parametrize("name", PICTURES)
def test_every_picture_is_there_and_not_blank(written, name):
    picture = image.imread(written / f"{name}.png")[..., :3]
    height, width = picture.shape[:2]
    assert height > 400 and width > 800
    inked = (picture < 0.9).any(axis=2)
    assert 0.01 < inked.mean() < 0.9
    colours = (picture * 15).astype(int) @ [1, 16, 256]
    assert len(np.unique(colours)) > 20


@pytest.mark.parametrize("name", PICTURES)
def test_nothing_is_cut_off_at_the_edges(written, name):
    picture = image.imread(written / f"{name}.png")[..., :3]
    for edge in (picture[:2], picture[-2:], picture[:, :2], picture[:, -2:]):
        assert edge.min() > 0.99


@pytest.mark.parametrize("name", ["fig4", "fig6", "fig9"])
def test_the_arms_lie_inside_their_panels_at_one_scale(name):
    figure = load_experiment(name).run().draw()
    panels = [axes for axes in figure.axes if axes.get_xlabel() == "x (m)"]
    assert panels
    for axes in panels:
        assert axes.get_aspect() == 1.0
        for line in axes.lines:
            x, y = line.get_data()
            assert axes.get_xlim()[0] < min(x) <= max(x) < axes.get_xlim()[1]
            assert axes.get_ylim()[0] < min(y) <= max(y) < axes.get_ylim()[1]


def test_the_numbers_hold_every_experiment(written):
    numbers = json.loads((written / "reproduction.json").read_text())
    assert list(numbers) == list(OWN)
    for name, found in numbers.items():
        assert found["comparisons"], name
        assert found["largest_difference_between_algebras_rad"] < 1e-9
    fig18 = {row["quantity"]: row for row in numbers["fig18"]["comparisons"]}["joints at the end"]
    assert np.allclose(fig18["difference"], np.subtract(fig18["quaternion"], fig18["printed"]))


def test_a_single_run_keeps_the_numbers_of_the_others(tmp_path):
    assert main(["reproduce", "fig14", "--out", str(tmp_path)]) == 0
    assert main(["reproduce", "fig18", "--out", str(tmp_path)]) == 0
    assert set(json.loads((tmp_path / "reproduction.json").read_text())) == {"fig14", "fig18"}
    assert {file.name for file in tmp_path.iterdir()} == {"fig14.png", "fig18.png", "reproduction.json"}


def test_the_page_has_a_row_and_a_section_for_each(written):
    results = [
        (experiment := load_experiment(name), experiment.run()) for name in ("fig14", "fig18", "errata")
    ]
    text = page(results, {"fig18": "images/fig18.png"})
    for name in ("fig14", "fig18", "errata"):
        assert f"| [{name}](#{name}) |" in text
        assert f"\n## {name}\n" in text
    assert text.count("![") == 1 and "](images/fig18.png)" in text
    widths = {}
    for line in text.splitlines():
        if line.startswith("| "):
            widths.setdefault(line.replace(r"\|", "").count("|"), []).append(line)
    assert all(len(lines) > 2 for lines in widths.values())


def test_an_erratum_that_fails_says_so():
    from gaik_core.experiments import Erratum

    experiment = Experiment("x", "1", "title", "about", lambda: Findings([]))
    erratum = Erratum("eq. 0", "a", "b", "c | d", confirmed=False)
    text = page([(experiment, Findings([Comparison("q", "m", 1.0, 1.5, 1.5)], errata=[erratum]))], {})
    assert r"**not confirmed**: c \| d" in text
    assert "| 0.5000 |" in text


@pytest.mark.parametrize(
    ("value", "decimals", "expected"),
    [
        (None, 2, "-"),
        (1.23456, 2, "1.23"),
        ([1.0, -2.345], 1, "[1.0, -2.3]"),
        (3, 0, "3"),
        (-1e-9, 2, "0.00"),
        (4.62e-11, 11, "4.6e-11"),
        (2e-8, 6, "2e-08"),
    ],
)
def test_numbers_are_shown_as_a_reader_needs_them(value, decimals, expected):
    assert shown(value, decimals) == expected


def test_the_committed_page_is_of_these_experiments():
    docs = Path(__file__).parents[3] / "docs"
    if not docs.is_dir():
        pytest.skip("the docs are not beside the package")
    text = (docs / "reproduction.md").read_text(encoding="utf-8")
    for name in OWN:
        assert f"\n## {name}\n" in text
    for quantity in ("joints after 30 updates, α = 50", "mean updates, Adam, Fibonacci", "joints at the end"):
        assert quantity in text
    pictures = re.findall(r"^!\[.*\]\(([^)]+)\)$", text, re.M)
    assert len(pictures) >= len(PICTURES)
    assert all((docs / picture).is_file() for picture in pictures)
    assert "not confirmed" not in text
