"""The paper's arms in the sizes of its experiments."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from gaik_core.chain import KinematicChain
from gaik_core.errors import GaikError


def scaled_to_reach(chain: KinematicChain, reach: float) -> KinematicChain:
    """The same arm with every length multiplied so that its links together measure `reach` m.

    For positions: the tip's frame at zero angles is the base's.

    Raises:
        GaikError: the arm has a prismatic joint, whose travel is a length too, or `reach` is no length.
    """
    if any(joint.kind != "revolute" for joint in chain.joints):
        raise GaikError(f"robot {chain.name!r} has a prismatic joint; only revolute arms can be scaled")
    if not 0.0 < reach < np.inf:
        raise GaikError(f"reach is {reach}; expected a length in m above 0")
    factor = reach / chain.reach
    joints = [
        replace(joint, link=(factor * joint.link[0], factor * joint.link[1], factor * joint.link[2]))
        for joint in chain.joints
    ]
    origin = factor * chain.frames(chain.home)[0]
    return KinematicChain(joints, name=chain.name, description=chain.description, origin=origin)
