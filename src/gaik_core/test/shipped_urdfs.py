"""URDFs of real robots, from the packages on PyPI that ship them."""

from importlib import metadata

import pytest


def urdf_of(package, file):
    """Path of a robot's URDF in the package that ships it; skips the test where that is not installed."""
    try:
        files = metadata.files(package) or []
    except metadata.PackageNotFoundError:
        pytest.skip(f"{package} is not installed (pip install {package})")
    return next(str(entry.locate()) for entry in files if entry.name == file)
