"""Saturation, changes of parameters in motion, and letting go and taking hold."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from std_srvs.srv import Trigger

from gaik_ros.conversions import joint_values
from gaik_ros.faults.borrowed import changed, disabled
from gaik_ros.faults.fault import Check, Fault, Need
from gaik_ros.faults.invariants import ROUNDING
from gaik_ros.faults.measures import follows, largest_step
from gaik_ros.faults.stage import ARRIVED, Array, Stage

WOUND_UP = 0.03  # rad; an integral that was wound up holds the arm 0.1 off, and more, for seconds
SMALL_STEP = 0.5  # N·m between two commands; an effort that jumps does so by its limit of 1
# A busy machine shall not be what is measured: no loss of state or reference, and full gains, however late it is.
PATIENT = {"state_timeout": 10.0, "reference_timeout": 10.0}  # s
EVEN_IF_LATE = {"tolerated_lateness": 100.0}  # s
FIRST = 5  # commands after taking hold of the device: on a machine in time, the first 5 ms
HELD = 1e-6  # rad/(N·m): the gain of a device that a hand holds fast


def _saturation(seconds: float, integral_gain: float | None) -> Any:
    """A hand holds the device for `seconds` while it is sent far away, then lets go."""

    def play(stage: Stage) -> list[Check]:
        gains = PATIENT | ({} if integral_gain is None else {"gains.i": integral_gain})
        limit = stage.facts.effort_max
        target = stage.point(stage.facts.far)
        with changed(stage.remote, "pid_controller", gains):
            with (
                changed(stage.remote, "pid_controller", EVEN_IF_LATE),
                changed(stage.remote, "touch_sim", {"gain": HELD}),
            ):
                _lead(stage, target)
                _wait_for_push(stage)
                mark = stage.mark()
                stage.sleep(seconds)
                efforts = stage.since(mark).joints("joint_command", stage.names, "effort").values
            mark = stage.mark()
            stage.sleep(2.0)
            recording = stage.since(mark)
        stage.remote.call(Trigger, "pid_controller/reset", Trigger.Request())
        full = _at_limit(efforts, limit)
        share = full.sum(axis=0) / max(len(full), 1)
        # The other joints wind up rightly: they push against the hand within their limits.
        held_fast = share > 0.9
        pushed = "" if held_fast.any() else f", {share.max():.0%} of {len(full)} commands at most"
        states = recording.joints("joint_states", stage.names)
        goal = recording.joints("joint_reference", stage.names).values[-1]
        beyond = (states.values - goal) * np.sign(goal - states.values[0])
        overshoot = float(beyond[:, held_fast].max(initial=0.0))
        last = states.received > states.received[-1] - 1.0
        off = float(np.median(np.abs(states.values - goal)[last][:, held_fast], axis=0).max(initial=0.0))
        return [
            Check("saturated", f"{held_fast.sum()} joints for {seconds:g} s{pushed}", bool(held_fast.any())),
            Check(
                "no windup",
                f"{1e3 * off:.0f} mrad off a second after the release, overshoot {1e3 * overshoot:.0f} mrad",
                off < WOUND_UP,
            ),
        ]

    return play


def _at_limit(efforts: Array, limit: Array) -> NDArray[np.bool_]:
    """Which of `efforts` (…, dof) N·m stand at their limit."""
    return np.abs(efforts) >= limit - ROUNDING


def _wait_for_push(stage: Stage) -> None:
    """Wait until a joint's effort stands at its limit: where the controller follows late, after the reference does."""

    def pushes() -> bool:
        command = stage.probe.newest("joint_command")
        if command is None:
            return False
        return bool(_at_limit(joint_values(command, stage.names, "effort"), stage.facts.effort_max).any())

    stage.wait(pushes, "the effort reaches its limit")


def _lead(stage: Stage, target: Array) -> None:
    """Send the tip to `target`, and wait until the reference stands there, though a hand holds the device."""

    def there() -> bool:
        reference = stage.probe.newest("joint_reference")
        if reference is None or np.any(reference.velocity):
            return False
        return bool(np.linalg.norm(stage.point(joint_values(reference, stage.names)) - target) < ARRIVED)

    stage.send(target)
    stage.wait(there, "the reference arrives")


GOOD: tuple[tuple[str, dict[str, Any]], ...] = (
    ("pid_controller", {"gains.p": 4}),  # an integer
    ("pid_controller", {"gains.d": 0.15, "derivative_filter_time": 0.08}),
    ("pid_controller", {"gains.waist.p": 2.5}),
    ("ik_node", {"algebra": "conformal"}),
    ("ik_node", {"max_joint_speed": 1}),
    ("ik_node", {"rule": "damped_least_squares"}),
)

BAD: tuple[tuple[str, dict[str, Any]], ...] = (
    ("pid_controller", {"gains.p": math.nan}),
    ("pid_controller", {"gains.p": math.inf}),
    ("pid_controller", {"gains.p": 5.0, "gains.d": -0.3}),  # the good one must not come into force either
    ("pid_controller", {"gains.i": "much"}),
    ("pid_controller", {"gains.p": [1.0, 2.0]}),
    ("pid_controller", {"u_clamp_max": 1.0, "gains.u_clamp_max": -1.0}),
    ("pid_controller", {"rate": 10.0}),
    ("ik_node", {"max_joint_speed": 0.0}),
    ("ik_node", {"max_joint_speed": math.nan}),
    ("ik_node", {"rule": "newton"}),
    ("ik_node", {"algebra": "octonion"}),
    ("ik_node", {"setpoint_timeout": -1.0}),
)


def _good_parameters(stage: Stage) -> list[Check]:
    taken = []
    with stage.moving():
        mark = stage.mark()
        for node, values in _present(stage, GOOD):
            with changed(stage.remote, node, values) as (successful, _):
                taken.append(successful)
                stage.sleep(0.3)
        on_course = follows(stage, mark)
        recording = stage.since(mark)
    step = largest_step(recording, stage.names)
    return [
        Check("each is taken", f"{sum(taken)} of {len(taken)}", all(taken)),
        on_course,
        Check("the effort does not jump", f"by {step:.2f} N·m at most", step < SMALL_STEP),
    ]


def _bad_parameters(stage: Stage) -> list[Check]:
    refused, kept, reasons = 0, 0, set()
    with stage.moving():
        mark = stage.mark()
        for node, values in BAD:
            names = [name for name in values if name != "u_clamp_max"]
            before = stage.remote.parameters(node, names)
            successful, reason = stage.remote.change(node, values)
            refused += not successful
            kept += stage.remote.parameters(node, names) == before
            reasons.add(reason)
        on_course = follows(stage, mark)
    one_line = all(reason and "\n" not in reason for reason in reasons)
    return [
        Check("each is refused", f"{refused} of {len(BAD)}", refused == len(BAD)),
        Check("whole", f"{kept} of {len(BAD)} left all as it was", kept == len(BAD)),
        Check("with one line that says why", "one line each" if one_line else "not each", one_line),
        on_course,
    ]


def _present(
    stage: Stage, changes: tuple[tuple[str, dict[str, Any]], ...]
) -> list[tuple[str, dict[str, Any]]]:
    """The changes that name no joint which this robot has not."""
    return [
        (node, values)
        for node, values in changes
        if not any(name.startswith("gains.waist.") and "waist" not in stage.names for name in values)
    ]


def _enable(stage: Stage) -> list[Check]:
    with stage.moving():
        mark = stage.mark()
        with disabled(stage.remote):
            stage.sleep(0.7)
            off = stage.since(mark).joints("joint_command", stage.names, "effort").values[-20:]
            mark = stage.mark()
        back = follows(stage)
        on = stage.since(mark).joints("joint_command", stage.names, "effort").values
    largest = float(np.abs(off).max(initial=0.0))
    begun = on[(np.abs(on) > 0.0).any(axis=1)][:FIRST]
    step = float(np.abs(begun).max(initial=0.0))
    return [
        Check("disabled is zero effort", f"{largest:g} N·m", len(off) > 0 and largest == 0.0),
        Check(
            "enabled without a jump", f"{step:.2f} N·m in the first {FIRST} commands", 0.0 < step < SMALL_STEP
        ),
        back,
    ]


def _under_load(stage: Stage) -> list[Check]:
    """Gains change and the controller is reset while a hand holds the device off its reference."""
    with (
        changed(stage.remote, "touch_sim", {"gain": HELD}),
        changed(stage.remote, "pid_controller", PATIENT | EVEN_IF_LATE),
    ):
        _lead(stage, stage.between(0.5))
        stage.sleep(1.0)
        mark = stage.mark()
        with changed(stage.remote, "pid_controller", {"gains.p": 1.0, "gains.d": 0.1}):
            stage.sleep(0.7)
            stage.remote.call(Trigger, "pid_controller/reset", Trigger.Request())
            stage.sleep(0.3)
        stage.sleep(0.7)
        efforts = stage.since(mark).joints("joint_command", stage.names, "effort").values
    change = float(np.ptp(efforts, axis=0).max())
    step = float(np.abs(np.diff(efforts, axis=0)).max())
    # Without the blending the whole change would be one step. Two commands 100 ms apart see 0.6 of it.
    return [
        Check("the effort changes", f"by {change:.2f} N·m", change > 0.1),
        Check("but does not jump", f"by {step:.3f} N·m at most", step < 0.7 * change),
    ]


FAULTS = (
    Fault(
        "saturation",
        "A hand holds the device for 3 s while it is sent far away, then lets go; integral gain 1.",
        "The effort stands at its limit; the integral does not wind up and hold the arm off its goal afterwards.",
        _saturation(3.0, 1.0),
        frozenset({Need.TWIN}),
    ),
    Fault(
        "long_saturation",
        "The same for 60 s, with the integral gain as it is.",
        "The effort stands at its limit; the integral does not wind up and hold the arm off its goal afterwards.",
        _saturation(60.0, None),
        frozenset({Need.TWIN}),
        long=True,
    ),
    Fault(
        "good_parameters",
        "Gains (an integer among them), algebra, rule and speed limit are changed in motion.",
        "Each is taken, without a jump of the effort; the arm follows.",
        _good_parameters,
    ),
    Fault(
        "bad_parameters",
        "NaN, infinite, negative and wrong parameters are set in motion, some beside good ones.",
        "Each change is refused whole, with one line that says why; the old set stays in force.",
        _bad_parameters,
    ),
    Fault(
        "gains_under_load",
        "Gains change, and the controller is reset, while a hand holds the device off its reference.",
        "The effort changes to what the new gains give, without a jump.",
        _under_load,
        frozenset({Need.TWIN}),
    ),
    Fault(
        "enable_in_motion",
        "The controller is disabled and enabled while the setpoints go on.",
        "Disabled is zero effort; enabled it takes hold where the device is, and follows again without a jump.",
        _enable,
    ),
)
