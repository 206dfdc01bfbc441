"""Reading a JointState by name. Needs no ROS: any object with the message's fields will do."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from sensor_msgs.msg import JointState

Array = NDArray[np.float64]

ABSURD = 1e12  # rad, rad/s or N·m: what is beyond it is no measurement, and would overflow in the law


class JointMessageError(ValueError):
    """A JointState does not hold what is wanted of it; the message says what is wrong."""


def joint_values(message: JointState, names: Sequence[str], field: str = "position") -> Array:
    """The values of `field` (position, velocity or effort) for `names`, in their order: (len(names),).

    Joints that are not asked for are passed over. Raises JointMessageError where a name is missing or stands
    twice, where the field has another length than the names, and where a value is not finite or is absurd.
    """
    held = getattr(message, field)
    if len(held) != len(message.name):
        raise JointMessageError(f"{len(message.name)} joint names but {len(held)} values in {field}")
    values = np.array(held, dtype=np.float64)
    if message.name != list(names):
        values = values[_indices(message.name, names)]
    sound = np.abs(values) <= ABSURD  # false for NaN too
    if not sound.all():
        bad = int(np.flatnonzero(~sound)[0])
        reason = f"{values[bad]:g}, beyond {ABSURD:g}" if np.isfinite(values[bad]) else "not finite"
        raise JointMessageError(f"{field} of {names[bad]} is {reason}")
    return values


def _indices(present: Sequence[str], wanted: Sequence[str]) -> list[int]:
    for name in wanted:
        count = present.count(name)
        if count != 1:
            found = "is missing" if count == 0 else f"stands there {count} times"
            raise JointMessageError(f"joint {name} {found}; the message has: {', '.join(present) or 'none'}")
    return [present.index(name) for name in wanted]
