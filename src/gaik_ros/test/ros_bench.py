"""What the tests of the nodes talk through: a node beside them, and patience."""

import time

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Point
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool, Trigger

from gaik_ros.conversions import array_to_point, joint_state, stamp_now
from gaik_ros.deadline_loop import DeadlineLoop

NAMES = ("waist", "shoulder", "elbow")
PATIENCE = 20.0  # s; far beyond what anything here takes, for a busy machine


def overrides(**values):
    """Parameters for a node's constructor; a double underscore stands for the dot."""
    return [Parameter(name.replace("__", "."), value=value) for name, value in values.items()]


def wait_until(condition, what="it did not come about"):
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end, what
        time.sleep(0.005)


class Bench(Node):
    """Hears everything, says what it is told, and plays a viscous device where `moving` is set."""

    def __init__(self, context, rate=200.0):
        super().__init__("bench", context=context)
        self.setpoints, self.references, self.commands, self.verdicts, self.diagnostics = (
            [] for _ in range(5)
        )
        for message, topic, heard in (
            (Point, "setpoint", self.setpoints),
            (JointState, "joint_reference", self.references),
            (JointState, "joint_command", self.commands),
            (DiagnosticStatus, "ik_node/status", self.verdicts),
            (DiagnosticArray, "/diagnostics", self.diagnostics),
        ):
            self.create_subscription(message, topic, heard.append, 1000)
        self.setpoint = self.create_publisher(Point, "setpoint", 1000)
        self.states = self.create_publisher(JointState, "joint_states", 10)
        self.reference = self.create_publisher(JointState, "joint_reference", 10)
        self.loop = DeadlineLoop(rate, self._tick)
        self.angles = np.array([0.1, 0.8, 0.9])
        self.publishing = self.moving = False
        self.stamp = None  # of all states; None: the time
        self.referring = None  # angles to publish as a reference at every tick
        self._service_clients = {}

    def _tick(self, dt):
        if self.moving and self.commands:
            self.angles = self.angles + dt / 0.05 * np.array(self.commands[-1].effort)
        if self.publishing:
            message = joint_state(NAMES, position=self.angles)
            if self.stamp is None:
                stamp_now(message.header.stamp, self.get_clock())
            else:
                message.header.stamp = self.stamp
            self.states.publish(message)
        if self.referring is not None:
            self.reference.publish(joint_state(NAMES, position=self.referring))

    def send(self, position):
        self.setpoint.publish(array_to_point(position))

    def verdict(self, index=-1):
        return {pair.key: pair.value for pair in self.verdicts[index].values}

    def results(self):
        return [self.verdict(k)["result"] for k in range(len(self.verdicts))]

    def reported(self, name):
        """The newest status of that name on /diagnostics, or None."""
        for message in reversed(self.diagnostics):
            for status in message.status:
                if status.name == name:
                    return status
        return None

    def level(self, name):
        """The newest level of that name on /diagnostics, or None."""
        status = self.reported(name)
        return status and status.level

    def call(self, service, request):
        kind = type(request).__qualname__.split("_")[0]
        types = {"Trigger": Trigger, "SetBool": SetBool, "SetParametersAtomically": SetParametersAtomically}
        if service not in self._service_clients:
            self._service_clients[service] = self.create_client(types[kind], service)
        client = self._service_clients[service]
        wait_until(client.service_is_ready, f"no service {service}")
        future = client.call_async(request)
        wait_until(future.done, f"no answer from {service}")
        return future.result()

    def change(self, node, **values):
        request = SetParametersAtomically.Request()
        request.parameters = [parameter.to_parameter_msg() for parameter in overrides(**values)]
        return self.call(f"{node}/set_parameters_atomically", request).result
