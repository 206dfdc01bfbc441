"""Another node's parameters and services, asked over the wire with patience."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from rcl_interfaces.srv import GetParameters, SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python

from gaik_ros.faults.fault import StageError

PATIENCE = 60.0  # s for what takes a moment on an idle machine


def wait_until(condition: Callable[[], bool], patience: float = PATIENCE) -> bool:
    """Whether `condition` came about within `patience` s. Another thread spins the nodes meanwhile."""
    end = time.monotonic() + patience
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.005)
    return True


class Remote:
    """Calls services through one node, which another thread spins."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._service_clients: dict[str, Any] = {}

    def call(self, service_type: Any, service: str, request: Any, patience: float = PATIENCE) -> Any:
        """The response. StageError: there is no such service, or it does not answer."""
        if service not in self._service_clients:
            self._service_clients[service] = self._node.create_client(service_type, service)
        client = self._service_clients[service]
        if not wait_until(client.service_is_ready, patience):
            raise StageError(f"there is no service {self._node.resolve_service_name(service)}")
        future = client.call_async(request)
        if not wait_until(future.done, patience):
            raise StageError(f"{self._node.resolve_service_name(service)} does not answer")
        return future.result()

    def parameters(self, node: str, names: Iterable[str], patience: float = PATIENCE) -> dict[str, Any]:
        """The values of a node's parameters, None for those not set."""
        asked = list(names)
        request = GetParameters.Request(names=asked)
        values = self.call(GetParameters, f"{node}/get_parameters", request, patience).values
        if len(values) != len(asked):
            raise StageError(f"{node} has not the parameters of ours: is it another version?")
        return dict(zip(asked, map(parameter_value_to_python, values), strict=True))

    def change(self, node: str, values: Mapping[str, Any]) -> tuple[bool, str]:
        """Change a node's parameters, all or none; whether it took them, and if not, why."""
        request = SetParametersAtomically.Request()
        request.parameters = [
            Parameter(name, value=value).to_parameter_msg() for name, value in values.items()
        ]
        result = self.call(SetParametersAtomically, f"{node}/set_parameters_atomically", request).result
        return result.successful, result.reason
