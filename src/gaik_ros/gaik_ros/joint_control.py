"""What the controller does at each tick: follow, hold or let go, by the age of what it has heard.

Plain Python on arrays, ages and dt; pid_controller.py puts the messages around it.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from gaik_ros.lateness import Lateness
from gaik_ros.pid import Gains, Pid
from gaik_ros.reference import JointReference

Array = NDArray[np.float64]


class Mode(StrEnum):
    """What the controller is doing."""

    WAITING = "waiting"  # no state heard yet: zero effort
    HOLDING = "holding"  # at the position where it was when there was no (more) reference
    APPROACHING = "approaching"  # on the way to the reference at a bounded speed, after a start or a pause
    FOLLOWING = "following"  # the reference, as it comes
    RELEASED = "released"  # the reference is too old, and zero effort is what was chosen for that
    STATE_LOST = "state_lost"  # the state is too old: zero effort
    DISABLED = "disabled"  # by ~/enable: zero effort


HOLD, ZERO_EFFORT = "hold", "zero_effort"
ON_REFERENCE_TIMEOUT = (HOLD, ZERO_EFFORT)


@dataclass(frozen=True)
class ControlSettings:
    """The parts of the control that are not the PID's."""

    reference_timeout: float = 0.2  # s
    state_timeout: float = 0.1  # s
    on_reference_timeout: str = HOLD
    approach_speed: float = 1.0  # rad/s, of each joint
    largest_step: float = 0.1  # rad: a reference further than this from the one before is approached
    tolerated_lateness: float = 0.004  # s: up to this the gains are full
    extrapolation: float = 0.0  # s: for how long a reference goes on at its velocity until the next one


class JointControl:
    """Holds where the device is, follows references, and never jumps at one after a start or a pause."""

    def __init__(self, joints: int, gains: Gains, settings: ControlSettings, blend_time: float = 0.1) -> None:
        self._joints = joints
        self._pid = Pid(joints, gains, blend_time)
        self._approach = JointReference(np.zeros(joints), settings.approach_speed)
        self._zero = np.zeros(joints)
        self.lateness = Lateness(settings.tolerated_lateness)
        self.settings = settings
        self.mode = Mode.WAITING
        self.enabled = True

    def configure(self, gains: Gains, settings: ControlSettings) -> None:
        """Change gains and settings without a jump of the effort. ValueError: gains of other joints."""
        self._pid.set_gains(gains)
        self._approach.set_speed_limit(settings.approach_speed)
        self.lateness.tolerated = settings.tolerated_lateness
        self.settings = settings

    def reset(self) -> None:
        """Forget the integral and the derivative; the effort goes on from where it was."""
        self._pid.reset()

    @property
    def held(self) -> Array:
        """The position the law is fed with, (joints,) rad."""
        return self._approach.position

    @property
    def pid(self) -> Pid:
        """The PID inside, to look at."""
        return self._pid

    def step(
        self,
        dt: float,
        state: Array | None,
        state_age: float,
        reference: Array | None,
        reference_velocity: Array | float,
        reference_age: float,
        reference_unchanged: float = 0.0,
        late: float = 0.0,
    ) -> Array:
        """The effort (joints,) N·m.

        `state` and `reference` are (joints,) rad or None if never heard, ages s, `dt` s since the last step.
        `reference_unchanged` is for how long (s) the reference has been the same position, heard again or not; `late`
        by how much (s) this step or its state is later than a period.
        """
        self.lateness.note(late, dt)
        powerless = self._powerless(state, state_age, reference, reference_age)
        if powerless is not None or state is None:
            return self._let_go(powerless or Mode.WAITING)
        if self.mode in _POWERLESS:
            self._seize(state)
        if reference is None or reference_age > self.settings.reference_timeout:
            target, velocity = self._hold()
        else:
            ahead = min(reference_unchanged, self.settings.extrapolation) * reference_velocity
            target, velocity = self._follow(reference + ahead, reference_velocity, dt)
        return self._pid.step(
            target - state, dt, velocity, self.lateness.share, self.lateness.derivative_share
        )

    def _powerless(
        self, state: Array | None, state_age: float, reference: Array | None, reference_age: float
    ) -> Mode | None:
        if not self.enabled:
            return Mode.DISABLED
        if state is None:
            return Mode.WAITING
        if state_age > self.settings.state_timeout:
            return Mode.STATE_LOST
        lost = reference is not None and reference_age > self.settings.reference_timeout
        if lost and self.settings.on_reference_timeout == ZERO_EFFORT:
            return Mode.RELEASED
        return None

    def _let_go(self, mode: Mode) -> Array:
        self.mode = mode
        return self._zero

    def _seize(self, state: Array) -> None:
        """Take hold of a device without a jump: from its own position, and from zero effort."""
        self._pid.reset(self._zero)
        self._approach.position = state.copy()
        self._approach.stop()
        self.mode = Mode.HOLDING

    def _hold(self) -> tuple[Array, Array | float]:
        if self.mode is not Mode.HOLDING:
            self._approach.stop()
            self._pid.resume()
            self.mode = Mode.HOLDING
        return self._approach.position, 0.0

    def _follow(self, reference: Array, velocity: Array | float, dt: float) -> tuple[Array, Array | float]:
        if self.mode is Mode.FOLLOWING and not self._jumps(reference):
            self._approach.position = reference
            return reference, velocity
        if self.mode is not Mode.APPROACHING:
            self._pid.resume()
            self.mode = Mode.APPROACHING
        self._approach.aim(reference)
        position = self._approach.advance(dt)
        if self._approach.arrived:
            self.mode = Mode.FOLLOWING
            self._pid.resume()
        return position, self._approach.velocity

    def _jumps(self, reference: Array) -> bool:
        """Whether a reference is too far from the one before to be followed at once."""
        return bool(np.abs(reference - self._approach.position).max() > self.settings.largest_step)


_POWERLESS = (Mode.WAITING, Mode.RELEASED, Mode.STATE_LOST, Mode.DISABLED)
