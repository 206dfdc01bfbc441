"""From the name of a message type to its class."""

from __future__ import annotations

import importlib
from functools import cache


@cache
def message_class(name: str) -> type:
    """The class of a type such as "sensor_msgs/msg/JointState". ValueError: it is not to be had here."""
    package, _, kind = name.partition("/msg/")
    try:
        found: type = getattr(importlib.import_module(f"{package}.msg"), kind)
    except (ImportError, AttributeError):
        raise ValueError(f"message type {name!r} is not to be had here: is {package} installed?") from None
    return found
