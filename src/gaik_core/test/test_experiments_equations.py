"""docs/equations.md leads from every equation to code that exists."""

import importlib
import inspect
import re
from pathlib import Path

import numpy as np
import pytest

from gaik_core import KinematicChain

ROOT = Path(__file__).parents[3]
PAGE = ROOT / "docs" / "equations.md"

if not PAGE.is_file():
    pytest.skip("the docs are not beside the package", allow_module_level=True)

ROWS = [
    [cell.strip() for cell in line.strip("|\n").split("|")]
    for line in PAGE.read_text(encoding="utf-8").splitlines()
    if re.match(r"\| \d", line)
]
LINKS = [link for row in ROWS for link in re.findall(r"(robot )?\[`([\w.]+)`\]\(([^)]+)\)", row[2])]
FUNCTIONS = sorted({(name, file) for robot, name, file in LINKS if not robot})
ROBOTS = sorted({(name, file) for robot, name, file in LINKS if robot})


def numbers(cell):
    """The equations of "1", "8, 9" or "60-62"."""
    for part in cell.split(", "):
        first, _, last = part.partition("-")
        yield from range(int(first), int(last or first) + 1)


def resolve(name):
    """The innermost module of a dotted name, and the object."""
    parts = name.split(".")
    for length in range(len(parts) - 1, 0, -1):
        try:
            module = importlib.import_module(".".join(parts[:length]))
        except ModuleNotFoundError:
            continue
        found = module
        for part in parts[length:]:
            found = getattr(found, part)
        return module, found
    raise AssertionError(f"{name} cannot be imported")


def test_every_equation_stands_there_once():
    assert sorted(number for row in ROWS for number in numbers(row[0])) == list(range(1, 79))


def test_every_row_names_code_or_says_why_not():
    for equation, _, computed, remark in ROWS:
        assert re.findall(r"`[\w.]+`", computed) or (computed == "not needed" and remark), equation


@pytest.mark.parametrize(("name", "file"), FUNCTIONS)
def test_every_name_stands_in_the_file_it_is_linked_to(name, file):
    module, found = resolve(name)
    linked = (PAGE.parent / file).resolve()
    assert Path(module.__file__).resolve() == linked
    source = inspect.unwrap(getattr(found, "py_func", found))
    if inspect.isfunction(source) or inspect.isclass(source):
        assert Path(inspect.getsourcefile(source)).resolve() == linked


@pytest.mark.parametrize(("name", "file"), ROBOTS)
def test_every_robot_can_be_loaded(name, file):
    assert KinematicChain.load(name).name == name
    assert (PAGE.parent / file).resolve().is_file()


@pytest.mark.parametrize("algebra", ["quaternion", "conformal"])
def test_the_planar_arm_is_that_of_equations_24_and_40(algebra):
    arm, (l1, l2) = KinematicChain.load("planar2"), (0.1, 0.1)
    for a, b in np.random.default_rng(0).uniform(-np.pi, np.pi, (50, 2)):
        position = [l1 * np.cos(a) + l2 * np.cos(a + b), l1 * np.sin(a) + l2 * np.sin(a + b), 0.0]
        jacobian = [
            [-l1 * np.sin(a) - l2 * np.sin(a + b), -l2 * np.sin(a + b)],
            [l1 * np.cos(a) + l2 * np.cos(a + b), l2 * np.cos(a + b)],
            [0.0, 0.0],
        ]
        assert np.allclose(arm.forward([a, b], algebra), position, atol=1e-15)
        assert np.allclose(arm.jacobian([a, b], algebra), jacobian, atol=1e-15)
