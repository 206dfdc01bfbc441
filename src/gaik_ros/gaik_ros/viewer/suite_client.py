"""The suite as the page acts on it: the services and the real parameters of its nodes."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from rcl_interfaces.srv import GetParameters, SetParametersAtomically
from rclpy.client import Client
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python
from std_srvs.srv import SetBool, Trigger

ANSWER = 2.0  # s: a service that takes longer has not answered

Value = bool | int | float | str
Refused = Callable[[str], None]


class SuiteError(RuntimeError):
    """The suite did not do what it was asked for; the message is one line for the user."""


@dataclass
class RemoteParameters:
    """Parameters of one node elsewhere: read again and again, set at once.

    Attributes:
        values: what was read last; empty where the node is not there.
        unanswered: changes that were asked for and are not answered yet.
    """

    node: str
    names: tuple[str, ...]
    getter: Client
    setter: Client
    values: dict[str, Any] = field(default_factory=dict)
    unanswered: int = 0
    _reading: Any = None

    @property
    def ready(self) -> bool:
        """Whether the node is there."""
        return bool(self.setter.service_is_ready())

    def read(self) -> None:
        """Ask for the values; they come into `values` later."""
        if not self.getter.service_is_ready():
            self.values, self.unanswered = {}, 0
            return
        if self._reading is not None and not self._reading.done():
            self.getter.remove_pending_request(self._reading)  # asked of a node that has gone since
        self._reading = self.getter.call_async(GetParameters.Request(names=list(self.names)))
        self._reading.add_done_callback(self._on_values)

    def _on_values(self, future: Any) -> None:
        if future.result() is None or self.unanswered:
            return
        self.values = {
            name: parameter_value_to_python(value)
            for name, value in zip(self.names, future.result().values, strict=False)
        }

    def set_now(self, values: Mapping[str, Value]) -> None:
        """Set `values`, all or none, and wait. SuiteError: the node's reason, or that it is not there."""
        result = answer_of(self.setter, _asking_for(values)).result
        if not result.successful:
            raise SuiteError(f"{self.node}: {result.reason}")

    def set(self, values: Mapping[str, Value], refused: Refused) -> None:
        """Ask for `values`, all or none; `refused` gets the node's reason, or that it is not there."""
        if not self.ready:
            refused(f"{self.node} is not there")
            return
        self.unanswered += 1

        def answered(future: Any) -> None:
            self.unanswered = max(0, self.unanswered - 1)
            response = future.result()
            if response is not None and not response.result.successful:
                refused(f"{self.node}: {response.result.reason}")
            elif response is not None:
                self.values.update(values)

        self.setter.call_async(_asking_for(values)).add_done_callback(answered)


def _asking_for(values: Mapping[str, Value]) -> SetParametersAtomically.Request:
    return SetParametersAtomically.Request(
        parameters=[Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]
    )


@dataclass(frozen=True)
class NodeNames:
    """What the suite's nodes are called, relative to the viewer's namespace."""

    trajectory: str
    ik: str
    controller: str
    device: str


class SuiteClient:
    """Calls the services of a suite through `node`; methods that wait are for threads other than the executor's."""

    def __init__(self, node: Node, names: NodeNames) -> None:
        self._node = node
        self.start = node.create_client(Trigger, f"{names.trajectory}/start")
        self.stop = node.create_client(Trigger, f"{names.trajectory}/stop")
        self.solve_from_here = node.create_client(Trigger, f"{names.ik}/solve_from_here")
        self.enable = node.create_client(SetBool, f"{names.controller}/enable")
        self.reset_controller = node.create_client(Trigger, f"{names.controller}/reset")
        self.reset_device = node.create_client(Trigger, f"{names.device}/reset")

    def parameters_of(self, node: str, names: Sequence[str]) -> RemoteParameters:
        """The parameters `names` of `node`."""
        return RemoteParameters(
            node,
            tuple(names),
            self._node.create_client(GetParameters, f"{node}/get_parameters"),
            self._node.create_client(SetParametersAtomically, f"{node}/set_parameters_atomically"),
        )

    def start_path(self, trajectory: RemoteParameters, path: str) -> str:
        """Begin a path from its beginning, over and over; returns what the node answers. Waits."""
        trajectory.set_now({"path": path, "loop": True})
        return str(call(self.start, Trigger.Request()).message)

    def stop_path(self) -> str:
        """Stop the path; returns what the node answers. Waits."""
        return str(call(self.stop, Trigger.Request()).message)

    def ask_to_stop(self, then: Callable[[], None] = lambda: None) -> None:
        """Stop the path if there is one, without waiting; call `then` once it has stopped."""
        if self.stop.service_is_ready():
            self.stop.call_async(Trigger.Request()).add_done_callback(lambda _: then())

    def reset(self, hold: Callable[[], None]) -> str:
        """Stop, bring the twin home if there is one, forget the past, and hold. Returns what was done. Waits.

        `hold` makes the place where the device then is the setpoint. While the twin jumps home the controller is
        off, so that it does not pull it back to the old reference.
        """
        self.ask_to_stop()
        twin = bool(self.reset_device.service_is_ready())
        pulls = twin and self.enable.service_is_ready()
        if pulls:
            call(self.enable, SetBool.Request(data=False))
        try:
            if twin:
                call(self.reset_device, Trigger.Request())
            hold()
            for client in (self.solve_from_here, self.reset_controller):
                if client.service_is_ready():
                    call(client, Trigger.Request())
        finally:
            if pulls:
                call(self.enable, SetBool.Request(data=True))
        return "the twin is home" if twin else "holding where the device is"


def call(client: Client, request: Any) -> Any:
    """Call a service and wait for the response. SuiteError: there is none, or no response, or it says no."""
    response = answer_of(client, request)
    if not response.success:
        raise SuiteError(f"{client.srv_name}: {response.message}")
    return response


def answer_of(client: Client, request: Any) -> Any:
    """The response of a service, whatever it says. SuiteError: there is no service, or no response."""
    if not client.service_is_ready():
        raise SuiteError(f"there is no service {client.srv_name}")
    done = threading.Event()
    future = client.call_async(request)
    future.add_done_callback(lambda _: done.set())
    if not done.wait(ANSWER):
        client.remove_pending_request(future)
        raise SuiteError(f"{client.srv_name} did not answer within {ANSWER:g} s")
    return future.result()
