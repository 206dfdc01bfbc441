"""The whole suite with the twin in one process: the four nodes, made with one set of options."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter

from gaik_core import KinematicChain
from gaik_ros.ik_node import IkNode
from gaik_ros.pid_controller import PidController
from gaik_ros.trajectory_publisher import TrajectoryPublisher
from touch_sim.simulation import FEED_FORWARD, PERIOD
from touch_sim.touch_sim_node import TouchSim

Value = bool | int | float | str | list[str]

NODES: Mapping[str, Callable[..., Node]] = {
    "touch_sim": TouchSim,
    "pid_controller": PidController,
    "ik_node": IkNode,
    "trajectory_publisher": TrajectoryPublisher,
}
"""What a suite is made of, by the nodes' names."""


@dataclass(frozen=True)
class SuiteOptions:
    """What is set of the nodes, rates in Hz, times in s; all else stays at each node's default.

    With an empty `rule` the IK node's own default stands, learning rate included.
    """

    robot: str = "touch_device"
    rate: float = 1000.0
    setpoint_rate: float = 100.0
    period: float = PERIOD
    feed_forward: bool = False
    algebra: str = "quaternion"
    rule: str = ""
    namespace: str = ""

    def parameters(self, joint_names: tuple[str, ...]) -> dict[str, dict[str, Value]]:
        """Return the parameters of each node by its name."""
        ik: dict[str, Value] = {"robot": self.robot, "algebra": self.algebra}
        if self.rule:
            ik |= {"rule": self.rule, "learning_rate": 0.0}  # 0: the rule's own
        pid: dict[str, Value] = {"dof_names": list(joint_names), "rate": self.rate}
        if self.feed_forward:
            pid |= {"gains.feedforward_gain": FEED_FORWARD}
        return {
            "touch_sim": {"robot": self.robot, "rate": self.rate},
            "pid_controller": pid,
            "ik_node": ik,
            "trajectory_publisher": {
                "rate": self.setpoint_rate,
                "lap_time": self.period,
                "autostart": False,
            },
        }


class Suite:
    """The four nodes, not yet running; `nodes` is what to run. Raises ValueError for an option a node refuses."""

    def __init__(
        self,
        options: SuiteOptions,
        context: Context | None = None,
        parameters: Mapping[str, Mapping[str, Value]] | None = None,
    ) -> None:
        """`parameters` by the node's name go before the options."""
        self.options = options
        self.joint_names = tuple(KinematicChain.load(options.robot).joint_names)
        values = options.parameters(self.joint_names)
        further = parameters or {}
        made: list[Node] = []
        try:
            for name, factory in NODES.items():
                made.append(
                    factory(
                        context=context,
                        namespace=options.namespace,
                        parameter_overrides=_overrides({**values[name], **further.get(name, {})}),
                    )
                )
        except BaseException:
            for node in made:
                node.destroy_node()
            raise
        self.nodes: tuple[Node, ...] = tuple(made)
        self.twin, self.controller, self.ik, self.trajectory = made


def twin_nodes(
    robot: str, namespace: str, context: Context, parameters: Mapping[str, Mapping[str, Value]]
) -> tuple[Node, ...]:
    """Return a suite's nodes without the trajectory publisher: what the entry point group `gaik.suites` asks for."""
    suite = Suite(SuiteOptions(robot=robot, namespace=namespace), context, parameters)
    suite.trajectory.destroy_node()
    return tuple(node for node in suite.nodes if node is not suite.trajectory)


def _overrides(values: Mapping[str, Value]) -> list[Parameter]:
    return [Parameter(name, value=value) for name, value in values.items()]
