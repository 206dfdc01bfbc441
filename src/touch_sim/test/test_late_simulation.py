"""A machine that is late must not swing the device: the loop with injected stalls and delays."""

import math

import numpy as np
import pytest

from gaik_core import KinematicChain
from gaik_ros.joint_control import ControlSettings, JointControl
from gaik_ros.pid import Gains
from touch_sim.dynamics import JointDynamics, JointModel
from touch_sim.joint_limits import JointLimits
from touch_sim.late_simulation import NEVER, Stalls, simulate_late

CHAIN = KinematicChain.load("touch_device")
SECONDS = 3.0
NO_CARE = 10.0  # s of tolerated lateness: none is cared about


def reference(now):
    return CHAIN.home + 0.2 * math.sin(2.0 * now) * np.ones(3)


def run(device=NEVER, controller=NEVER, transit=5e-4, tolerated=0.004):
    control = JointControl(3, Gains(), ControlSettings(approach_speed=2.0, tolerated_lateness=tolerated))
    dynamics = JointDynamics(JointModel(), JointLimits.of_chain(CHAIN), CHAIN.home)
    late = simulate_late(
        control,
        dynamics,
        reference,
        SECONDS,
        device_stalls=device,
        controller_stalls=controller,
        transit=transit,
    )
    settled = late.time > 0.3
    return np.abs(late.angles - late.references)[settled].max(axis=1), np.abs(late.efforts)[settled]


def stalls(seed, between, shortest, longest):
    return Stalls.random(seed, between, shortest, longest, SECONDS)


LATE = {
    "both processes, now and then": (stalls(1, 0.1, 0.005, 0.06), stalls(2, 0.1, 0.005, 0.06)),
    "both processes, most of the time": (stalls(1, 0.03, 0.005, 0.06), stalls(2, 0.03, 0.005, 0.06)),
    "both processes, short and often": (stalls(1, 0.01, 0.003, 0.015), stalls(2, 0.01, 0.003, 0.015)),
    "one process for both": (stalls(3, 0.03, 0.005, 0.06),) * 2,
    "the device alone": (stalls(1, 0.1, 0.005, 0.06), NEVER),
    "the controller alone": (NEVER, stalls(2, 0.1, 0.005, 0.06)),
}


@pytest.mark.parametrize("transit", [5e-4, 3e-3], ids=["quick messages", "slow messages"])
@pytest.mark.parametrize("case", LATE)
def test_lateness_does_not_swing_the_device(case, transit):
    error, efforts = run(*LATE[case], transit=transit)
    # On time the error is 6 mrad and the effort 0.02 N·m; a loop that swings is at its limit of 1 N·m.
    assert error.max() < 0.06
    assert efforts.max() < 0.3


def test_without_the_care_it_would_swing():
    device, controller = LATE["both processes, most of the time"]
    error, efforts = run(device, controller, transit=3e-3, tolerated=NO_CARE)
    assert error.max() > 0.3
    assert efforts.max() == 1.0


def test_on_time_nothing_is_changed_by_the_care():
    for transit in (5e-4, 3e-3):
        careful, careless = run(transit=transit), run(transit=transit, tolerated=NO_CARE)
        np.testing.assert_array_equal(careful[0], careless[0])
        np.testing.assert_array_equal(careful[1], careless[1])


def test_one_long_stall_of_the_controller_is_got_over():
    error, _ = run(controller=Stalls(np.array([[1.0, 1.2]])), tolerated=0.004)
    assert error[-1000:].max() < 0.01


def test_stalls_are_where_they_are_said_to_be():
    given = Stalls(np.array([[0.1, 0.2], [0.5, 0.6]]))
    assert [given.at(now) for now in (0.0, 0.1, 0.15, 0.2, 0.55, 0.6)] == [
        False,
        True,
        True,
        False,
        True,
        False,
    ]
