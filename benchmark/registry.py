"""Who takes part, and who is missing and why."""

from __future__ import annotations

import importlib
from dataclasses import dataclass, field
from importlib import metadata
from typing import Any

OURS = (
    ("peers.ours", "LevenbergMarquardtQuaternion"),
    ("peers.ours", "LevenbergMarquardtConformal"),
    ("peers.ours", "LevenbergMarquardtUnlimited"),
    ("peers.ours", "AdamQuaternion"),
    ("peers.ours", "AdamConformal"),
    ("peers.ours", "AutoStep"),
)
PEERS = (
    ("peers.toolbox", "Toolbox"),
    ("peers.kdl", "Kdl"),
    ("peers.kdl", "KdlOwnTypes"),
    ("peers.pinocchio_clik", "PinocchioClik"),
    ("peers.mujoco_dls", "MujocoDls"),
    ("peers.trac_ik", "TracIk"),
    ("peers.mink_qp", "Mink"),
    ("peers.pink_qp", "Pink"),
    ("peers.ikpy_scipy", "Ikpy"),
)
BATCH_PEERS = (
    ("peers.toolbox", "Toolbox"),
    ("peers.kdl", "Kdl"),
    ("peers.pytorch_batch", "PytorchKinematics"),
)
PACKAGES = (
    ("peers.our_algebra", "OurAlgebra"),
    ("peers.gafro", "Gafro"),
    ("peers.clifford_numba", "Clifford"),
    ("peers.kingdon_codegen", "Kingdon"),
)


@dataclass
class Field:
    """The classes that could be imported, and what each of the others lacks."""

    classes: list[Any] = field(default_factory=list)
    missing: dict[str, str] = field(default_factory=dict)


def is_named(entry: tuple[str, str], word: str) -> bool:
    """Whether the module or the class of an entry contains a word."""
    return word.lower() in " ".join(entry).lower()


def load(entries: tuple[tuple[str, str], ...], only: list[str] | None = None) -> Field:
    """Import (module, class) pairs; `only` keeps those whose module or name contains one of these words."""
    result = Field()
    for module, name in entries:
        if only and not any(is_named((module, name), word) for word in only):
            continue
        try:
            result.classes.append(getattr(importlib.import_module(module), name))
        except Exception as error:  # a broken peer is a missing one
            result.missing[name] = str(error) or type(error).__name__
    return result


def version_of(package: str) -> str:
    """Version of a distribution, or of the module where it was not installed by pip."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        module = importlib.import_module("peers.kdl") if package == "PyKDL" else None
        return getattr(getattr(module, "kdl", None), "__version__", "unknown")
