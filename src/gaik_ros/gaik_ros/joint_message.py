"""Reading a JointState by name. Needs no ROS: any object with the message's fields will do."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from sensor_msgs.msg import JointState

Array = NDArray[np.float64]


class JointMessageError(ValueError):
    """A JointState does not hold what is wanted of it; the message says what is wrong."""


def joint_values(message: JointState, names: Sequence[str], field: str = "position") -> Array:
    """The values of `field` (position, velocity or effort) for `names`, in their order: (len(names),).

    Joints that are not asked for are passed over. Raises JointMessageError where a name is missing or stands
    twice, where the field has another length than the names, and where a value is not finite.
    """
    held = getattr(message, field)
    if len(held) != len(message.name):
        raise JointMessageError(f"{len(message.name)} joint names but {len(held)} values in {field}")
    values = np.array(held, dtype=np.float64)
    if message.name != list(names):
        values = values[_indices(message.name, names)]
    if not np.isfinite(values).all():
        bad = names[int(np.flatnonzero(~np.isfinite(values))[0])]
        raise JointMessageError(f"{field} of {bad} is not finite")
    return values


def _indices(present: Sequence[str], wanted: Sequence[str]) -> list[int]:
    for name in wanted:
        count = present.count(name)
        if count != 1:
            found = "is missing" if count == 0 else f"stands there {count} times"
            raise JointMessageError(f"joint {name} {found}; the message has: {', '.join(present) or 'none'}")
    return [present.index(name) for name in wanted]
