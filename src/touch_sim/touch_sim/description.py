"""Where the Touch's URDF is."""

from __future__ import annotations

from importlib import resources

ORIGIN_FRAME = "touch_origin"
"""The URDF's link that is the paper's frame: setpoints and tips are given in it."""


def touch_urdf() -> str:
    """Return the text of the Touch's URDF, found wherever the package is installed."""
    return resources.files("touch_sim").joinpath("urdf", "touch.urdf").read_text(encoding="utf-8")
