"""All faults, in the order in which they are played: those that need the cable side by side."""

from __future__ import annotations

from gaik_ros.faults import control_faults, graph_faults, process_faults, setpoint_faults, state_faults
from gaik_ros.faults.fault import Fault

FAULTS: tuple[Fault, ...] = (
    *setpoint_faults.FAULTS,
    *control_faults.FAULTS,
    *graph_faults.FAULTS,
    *process_faults.FAULTS,
    *state_faults.FAULTS,
)


def fault_by_name(name: str) -> Fault:
    """The fault of that name. ValueError: there is none."""
    for fault in FAULTS:
        if fault.name == name:
            return fault
    raise ValueError(f"there is no fault '{name}'; --list names them")
