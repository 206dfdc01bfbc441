"""The page about the drivers says what the code does, and the page of parameters has the nodes beside a suite."""

from pathlib import Path

import pytest

from gaik_ros.drivers import DRIVERS
from gaik_ros.reference_page import BESIDE, section, table
from gaik_ros.touch_adapter import table_for

DOCS = Path(__file__).parents[3] / "docs"


def row_of(driver):
    known = DRIVERS[driver]
    cells = (
        f"`{driver}`",
        ", ".join(known.repositories),
        f"`{known.state_topic}`",
        f"`{known.command_topic}`",
        f"`{known.command_type}`",
        ", ".join(f"{sign:g}" for sign in known.joint_signs),
        str(known.relative).lower(),
        str(known.use_velocity).lower(),
        f"`{known.force_axes}`",
    )
    return "| " + " | ".join(cells).replace("|  |", "| |") + " |"


@pytest.mark.parametrize("driver", DRIVERS)
def test_the_table_has_every_driver_as_the_code_has_it(driver):
    assert row_of(driver) in (DOCS / "drivers.md").read_text(encoding="utf-8").splitlines()


@pytest.mark.parametrize("driver", DRIVERS)
def test_a_driver_s_values_are_the_defaults_of_the_parameters(driver):
    defaults = {row.name: row.default for row in table_for(driver).parameters}
    for name, value in vars(DRIVERS[driver]).items():
        if name != "repositories":
            assert defaults[name] == value
    assert defaults["driver"] == driver


@pytest.mark.parametrize("module", BESIDE)
def test_the_page_of_parameters_is_up_to_date(module):
    assert section(table(module)) in (DOCS / "nodes.md").read_text(encoding="utf-8")
