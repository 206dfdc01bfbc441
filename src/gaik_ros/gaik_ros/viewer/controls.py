"""The nodes' parameters as sliders and drop-down lists: they show what is in force and ask for what is chosen."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import viser

from gaik_core import ALGEBRAS, RULES
from gaik_ros.viewer.suite_client import NodeNames, RemoteParameters, SuiteClient, Value

TOUCHED = 1.0  # s: how long after a user's change what is read does not move the slider under the hand

Notify = Callable[[str, str], None]  # title, text


@dataclass(frozen=True)
class Slider:
    """A number of a node."""

    parameter: str
    label: str  # with the unit
    lower: float
    upper: float  # grows with the value that is found
    step: float
    hint: str
    resets: Mapping[str, Value] = field(default_factory=dict)


@dataclass(frozen=True)
class Choice:
    """One of a few words of a node; `resets` are parameters that go with a change."""

    parameter: str
    label: str
    options: tuple[str, ...]
    hint: str
    resets: Mapping[str, Value] = field(default_factory=dict)


LAP = (Slider("lap_time", "Lap (s)", 2.0, 20.0, 0.1, "time of one lap of the circle or lemniscate"),)
SOLVER = (
    Choice("algebra", "Algebra", tuple(ALGEBRAS), "the algebra that ik_node computes in"),
    Choice(
        "rule",
        "Update rule",
        tuple(RULES),
        "the update rule of the solver, with its own learning rate",
        resets={"learning_rate": 0.0},  # another rule's rate would not fit
    ),
)
GAINS = (
    Slider("gains.p", "P (N·m/rad)", 0.0, 8.0, 0.05, "proportional gain of all joints"),
    Slider("gains.i", "I (N·m/rad/s)", 0.0, 2.0, 0.01, "integral gain of all joints"),
    Slider("gains.d", "D (N·m·s/rad)", 0.0, 1.0, 0.01, "derivative gain of all joints"),
    Slider(
        "gains.feedforward_gain", "Feed-forward", 0.0, 0.1, 0.001, "on the reference's velocity, N·m·s/rad"
    ),
)


class Controls:
    """The widgets of one node's parameters."""

    def __init__(
        self,
        server: viser.ViserServer,
        parameters: RemoteParameters,
        rows: Sequence[Slider | Choice],
        notify: Notify,
    ) -> None:
        """Add the widgets to the page, where the current container of `server.gui` is."""
        self._parameters, self._notify = parameters, notify
        self._widgets = [(row, self._add(server, row)) for row in rows]
        self._touched = {row.parameter: -TOUCHED for row in rows}

    def _add(self, server: viser.ViserServer, row: Slider | Choice) -> Any:
        widget: Any
        if isinstance(row, Slider):
            widget = server.gui.add_slider(
                row.label, row.lower, row.upper, row.step, row.lower, hint=row.hint, disabled=True
            )
        else:
            widget = server.gui.add_dropdown(row.label, row.options, hint=row.hint, disabled=True)

        @widget.on_update
        async def _(event: viser.GuiEvent[Any]) -> None:
            if event.client is not None:  # a user; None is our own `show`
                self._change(row, widget.value)

        return widget

    def _change(self, row: Slider | Choice, value: Value) -> None:
        self._touched[row.parameter] = time.monotonic()

        def refused(reason: str) -> None:
            self._touched[row.parameter] = -TOUCHED
            self._notify(f"{row.label} stays as it was", reason)

        self._parameters.set({row.parameter: value, **row.resets}, refused)

    def show(self) -> None:
        """Show what was read, and ask for it anew."""
        self._parameters.read()
        now = time.monotonic()
        for row, widget in self._widgets:
            value = self._parameters.values.get(row.parameter)
            widget.disabled = value is None
            if value is None or self._parameters.unanswered or now - self._touched[row.parameter] < TOUCHED:
                continue
            if isinstance(row, Choice):
                if value in row.options:
                    widget.value = value
            elif (number := common_value(value)) is not None:
                widget.max = max(widget.max, number)
                widget.value = number


def common_value(value: Any) -> float | None:
    """The number of a parameter that may be a list, one for each joint: their mean. None for what is no number."""
    numbers = [value] if isinstance(value, int | float) else list(value) if hasattr(value, "__len__") else []
    if not numbers or not all(isinstance(number, int | float) for number in numbers):
        return None
    return float(sum(numbers) / len(numbers))


class SuiteParameters:
    """The parameters of the three nodes that the page steers."""

    def __init__(self, suite: SuiteClient, names: NodeNames) -> None:
        def of(node: str, rows: Sequence[Slider | Choice]) -> RemoteParameters:
            return suite.parameters_of(node, [row.parameter for row in rows])

        self.trajectory, self.ik, self.controller = (
            of(names.trajectory, LAP),
            of(names.ik, SOLVER),
            of(names.controller, GAINS),
        )
