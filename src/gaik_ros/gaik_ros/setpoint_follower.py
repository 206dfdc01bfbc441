"""From setpoints to a joint reference over time: what ik_node does, without messages and without a clock."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gaik_ros.continuous_ik import Answer, ContinuousIk, Result
from gaik_ros.reference import JointReference
from gaik_ros.setpoint_motion import SetpointMotion

Array = NDArray[np.float64]

LATCH, STREAM = "latch", "stream"
SETPOINT_MODES = (LATCH, STREAM)

LONGEST_WAIT = 2.0  # s: a setpoint that waited longer for the device would move it when nobody expects it


@dataclass(frozen=True)
class FollowerSettings:
    """How setpoints are followed."""

    speed_limit: ArrayLike  # rad/s, one or one for each joint
    mode: str = LATCH  # what the last setpoint means: it is carried out, or a dead stream stops the arm
    setpoint_timeout: float = 0.25  # s, for a stream


class SetpointFollower:
    """Answers setpoints and moves the reference toward the answers. All times are s of one steady clock.

    `solve` may run while another thread calls the other methods, which must not run at the same time.
    """

    def __init__(self, ik: ContinuousIk, settings: FollowerSettings, period: float) -> None:
        """`period` in s: how often the reference is to be published."""
        self._ik, self._settings, self._period = ik, settings, period
        self._motion = SetpointMotion()
        self._angles = ik.chain.home  # the last answer: where the next solve starts
        self._received: float | None = None  # when the last answered setpoint came
        self._advanced = 0.0  # when the reference was advanced last
        self.reference = JointReference(ik.chain.home, settings.speed_limit)
        self.started = False
        self.stream_dead = False

    def configure(self, ik: ContinuousIk, settings: FollowerSettings) -> None:
        """Change solver and settings in motion. ValueError: a speed limit that is none."""
        self.reference.set_speed_limit(settings.speed_limit)
        self._ik, self._settings = ik, settings

    def start(self, position: Array, now: float) -> None:
        """Begin, or begin anew, where the device is: at `position` (dof,) rad, or on the limits it is beyond."""
        position = self._ik.onto_limits(position)
        self._angles, self._advanced, self.started = position, now, True
        self.reference = JointReference(position, self._settings.speed_limit)

    def overdue(self, received: float, now: float) -> bool:
        """Whether a setpoint of the time `received` has waited too long for the start, to be carried out at `now`."""
        return not self.started and now - received > LONGEST_WAIT

    def solve(self, setpoint: Array) -> Answer:
        """The answer for a setpoint (3,) m; nothing moves by it yet."""
        return self._ik.solve(setpoint, self._angles)

    def accept(self, setpoint: Array, received: float, number: int, answer: Answer) -> None:
        """Go to an answer, with the velocity that the setpoints have where the answer reaches its own.

        `number` counts the setpoints received, those among them that were never solved too.
        """
        velocity = self._motion.add(setpoint, received, number)
        rates = None
        if answer.result is Result.REACHED and velocity.any():
            rates = self._ik.chain.inverse_velocity(answer.angles, velocity)
        self._angles, self._received, self.stream_dead = answer.angles, received, False
        self.reference.aim(answer.angles, rates)

    def due(self, now: float) -> bool:
        """Whether the reference is to be published at the tick at `now`; stops what has run out."""
        if self._received is None:
            return False
        if self._motion.standing(now):
            self.reference.rest()
        silent = now - self._received > self._settings.setpoint_timeout
        if self._settings.mode == STREAM and silent and not self.stream_dead:
            self.stream_dead = True
            self.reference.stop()
        # A setpoint that was answered just now has published the reference already.
        return now - self._advanced > 0.95 * self._period

    def advance(self, now: float) -> tuple[Array, Array]:
        """The reference's position (dof,) rad and velocity (dof,) rad/s at `now`."""
        # After a stall the reference goes on from where it was; it does not make up for the time.
        self.reference.advance(min(now - self._advanced, 2.0 * self._period))
        self._advanced = now
        return self.reference.position, self.reference.velocity
