"""Following, holding and letting go, with a plain viscous axis as the device and no ROS."""

import numpy as np
import pytest

from gaik_ros.joint_control import HOLD, ZERO_EFFORT, ControlSettings, JointControl, Mode
from gaik_ros.pid import Gains

DT, TAU = 1e-3, 0.05


class Loop:
    """A controller of one joint, the joint, and the ages of what the controller hears."""

    def __init__(self, angle=0.5, gains=None, **settings):
        self.control = JointControl(1, gains or Gains(), ControlSettings(**settings))
        self.angle = np.array([angle])
        self.reference, self.velocity, self.reference_age, self.state_age = None, 0.0, 0.0, 0.0
        self.unchanged = self.late = 0.0
        self.efforts, self.angles = [], []

    def run(self, seconds):
        for _ in range(round(seconds / DT)):
            effort = self.control.step(
                DT,
                self.angle,
                self.state_age,
                self.reference,
                self.velocity,
                self.reference_age,
                self.unchanged,
                self.late,
            )
            self.efforts.append(effort[0])
            self.angles.append(self.angle[0])
            self.angle = self.angle + DT / TAU * effort
        return self

    def refer(self, angle, velocity=0.0):
        self.reference, self.velocity, self.reference_age = np.array([angle]), velocity, 0.0
        return self

    def jumps(self, since=0):
        return np.abs(np.diff(self.efforts[since:])).max()


def test_it_starts_holding_where_the_device_is():
    loop = Loop(angle=1.2).run(0.5)
    assert loop.control.mode is Mode.HOLDING
    assert np.abs(loop.efforts).max() == 0.0


def test_it_holds_against_a_push():
    loop = Loop(angle=1.2).run(0.1)
    loop.angle = loop.angle + 0.05
    loop.run(1.0)
    assert loop.angle[0] == pytest.approx(1.2, abs=2e-3)


def test_before_the_first_state_there_is_no_effort():
    control = JointControl(2, Gains(), ControlSettings())
    assert control.step(DT, None, 0.0, np.ones(2), 0.0, 0.0).tolist() == [0.0, 0.0]
    assert control.mode is Mode.WAITING


def test_a_far_first_reference_is_approached_under_the_speed_limit():
    loop = Loop(angle=0.0, approach_speed=0.5).run(0.05).refer(1.0).run(3.0)
    speed = np.abs(np.diff(loop.angles)) / DT
    assert speed.max() < 0.5 * 1.1  # the joint swings a little about the reference it lags behind
    assert loop.jumps() < 0.05
    assert loop.control.mode is Mode.FOLLOWING
    assert loop.angle[0] == pytest.approx(1.0, abs=5e-3)


def test_once_there_it_follows_steps_at_once_and_approaches_after_a_jump():
    loop = Loop(angle=0.0, approach_speed=0.5, largest_step=0.1).refer(0.0).run(0.1)
    loop.refer(0.09).run(0.002)
    assert loop.control.mode is Mode.FOLLOWING
    np.testing.assert_array_equal(loop.control.held, [0.09])
    loop.run(0.3).refer(0.49).run(0.002)
    assert loop.control.mode is Mode.APPROACHING
    np.testing.assert_allclose(loop.control.held, [0.09 + 0.002 * 0.5])
    loop.run(2.0)
    assert loop.control.mode is Mode.FOLLOWING
    assert np.abs(np.diff(loop.angles[-2000:])).max() / DT < 0.5 * 1.1


def test_rivals_far_apart_do_not_move_the_device_faster_than_its_approach():
    loop = Loop(angle=0.0, approach_speed=0.5).refer(0.0).run(0.1)
    for k in range(200):
        loop.refer(0.5 * (k % 2)).run(0.005)
    assert np.abs(np.diff(loop.angles)).max() / DT < 0.5 * 1.5


def test_a_timely_loop_is_as_if_there_were_no_lateness():
    plain = Loop(angle=0.0).refer(0.05).run(0.3)
    timely = Loop(angle=0.0)
    timely.late = 0.0039
    timely.refer(0.05).run(0.3)
    np.testing.assert_array_equal(plain.efforts, timely.efforts)


def test_a_late_loop_pulls_less():
    timely, late = Loop(angle=0.0).refer(0.0).run(0.1), Loop(angle=0.0).refer(0.0).run(0.1)
    late.late = 0.05
    for loop in (timely, late):
        loop.refer(0.09).run(0.005)
    assert 0.0 < max(late.efforts) < 0.2 * max(timely.efforts)


def test_between_references_it_may_go_on_at_their_velocity_for_a_while():
    speed, period, lag, ripple = 0.5, 10, [], []
    for extrapolation in (0.0, 0.015):
        loop = Loop(angle=0.0, extrapolation=extrapolation, gains=Gains(feed_forward=TAU))
        for k in range(1000):
            if k % period == 0:
                loop.refer(speed * k * DT, speed)
            loop.unchanged = (k % period) * DT
            loop.run(DT)
        lag.append(speed * np.arange(500, 1000) * DT - loop.angles[500:])
        ripple.append(np.ptp(loop.efforts[500:]))
    assert lag[0].mean() == pytest.approx(speed * 0.0045, rel=0.1)  # half a period, which a staircase costs
    assert np.abs(lag[1]).max() < 1e-4
    assert ripple[1] < 0.05 * ripple[0]
    loop.unchanged = 0.1
    loop.run(0.01)
    assert loop.control.held[0] == pytest.approx(speed * (990 * DT + 0.015))


def test_a_silent_reference_is_held_without_a_jump_and_then_approached_again():
    loop = Loop(angle=0.0, reference_timeout=0.2, gains=Gains(feed_forward=TAU))
    for k in range(500):
        loop.refer(0.5 * k * DT, 0.5).run(DT)
    before = len(loop.efforts) - 1
    for age in np.arange(0.0, 1.0, DT):
        loop.reference_age = age
        loop.run(DT)
    assert loop.control.mode is Mode.HOLDING
    assert loop.angle[0] == pytest.approx(0.5 * 499 * DT, abs=2e-3)
    loop.refer(0.9).run(0.02)
    assert loop.control.mode is Mode.APPROACHING
    loop.run(2.0)
    assert loop.angle[0] == pytest.approx(0.9, abs=5e-3)
    assert loop.jumps(before) < 0.05


def test_a_silent_reference_may_also_mean_to_let_go():
    loop = Loop(on_reference_timeout=ZERO_EFFORT).refer(0.6).run(0.1)
    loop.reference_age = 1.0
    loop.run(0.1)
    assert loop.control.mode is Mode.RELEASED
    assert loop.efforts[-1] == 0.0


def test_a_lost_state_is_zero_effort_at_once_and_its_return_no_jump():
    loop = Loop(angle=0.0).refer(0.5).run(0.2)
    assert loop.efforts[-1] > 0.03
    loop.state_age = 0.5
    loop.run(0.1)
    assert loop.control.mode is Mode.STATE_LOST
    assert loop.efforts[-1] == 0.0
    loop.state_age, loop.angle = 0.0, np.array([-0.4])  # it was moved meanwhile
    back = len(loop.efforts)
    loop.run(2.0)
    assert loop.jumps(back - 1) < 0.05
    assert loop.angle[0] == pytest.approx(0.5, abs=5e-3)


def test_enable_takes_hold_without_a_jump_where_the_device_has_been_moved_to():
    loop = Loop(angle=0.0).refer(0.0).run(0.3)
    loop.control.enabled = False
    loop.run(0.1)
    assert loop.control.mode is Mode.DISABLED
    assert loop.efforts[-1] == 0.0
    loop.angle = np.array([0.8])
    loop.control.enabled = True
    enabled = len(loop.efforts)
    loop.run(2.0)
    assert loop.jumps(enabled - 1) < 0.05
    assert loop.angle[0] == pytest.approx(0.0, abs=5e-3)


def test_gains_and_settings_change_in_motion_without_a_jump():
    loop = Loop(angle=0.0, gains=Gains(p=2.0, i=0.5)).refer(0.4).run(0.15)
    before = len(loop.efforts) - 1
    loop.control.configure(Gains(p=6.0, i=0.0, d=0.1), ControlSettings(on_reference_timeout=HOLD))
    loop.run(1.0)
    assert loop.jumps(before) < 0.05


def test_gains_of_other_joints_are_refused_and_the_old_ones_stay():
    control = JointControl(2, Gains(p=2.0), ControlSettings())
    with pytest.raises(ValueError, match="shape"):
        control.configure(Gains(p=[1.0, 2.0, 3.0]), ControlSettings())
    assert control.pid.gains.p == 2.0
