"""Quality of service: one profile for each topic, and the reason for it. All are volatile and keep the last few."""

from __future__ import annotations

from dataclasses import dataclass

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy


def _profile(depth: int, reliability: ReliabilityPolicy) -> QoSProfile:
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=depth,
        reliability=reliability,
        durability=DurabilityPolicy.VOLATILE,
    )


_RELIABLE, _BEST_EFFORT = ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT

SETPOINT = _profile(100, _RELIABLE)
JOINT_REFERENCE = _profile(1, _RELIABLE)
JOINT_STATES = _profile(1, _RELIABLE)
JOINT_STATES_SUBSCRIPTION = _profile(1, _BEST_EFFORT)
JOINT_COMMAND = _profile(1, _RELIABLE)
JOINT_COMMAND_SUBSCRIPTION = _profile(1, _BEST_EFFORT)
TIP = _profile(10, _RELIABLE)
STATUS = _profile(100, _RELIABLE)
DIAGNOSTICS = _profile(10, _RELIABLE)


@dataclass(frozen=True)
class Topic:
    """One topic: its type, what is offered and asked for there, and why."""

    name: str
    message: str
    offered: QoSProfile
    asked: QoSProfile
    reason: str


TOPICS = (
    Topic(
        "setpoint",
        "geometry_msgs/msg/Point",
        SETPOINT,
        SETPOINT,
        "One sent once by hand must arrive, and `ros2 topic pub` offers reliable. The newest wins, in the node and "
        "not in the middleware, so that the superseded ones are counted: depth for a burst. "
        "Volatile: a setpoint from before a node's start must not move the arm at its start. Nor must one that waited "
        "for the first joint_states: after 2 s it is refused.",
    ),
    Topic(
        "joint_reference",
        "sensor_msgs/msg/JointState",
        JOINT_REFERENCE,
        JOINT_REFERENCE,
        "At 100 Hz a lost one would cost 10 ms, and a resend is cheap. Depth 1: an old reference is of no use.",
    ),
    Topic(
        "joint_states",
        "sensor_msgs/msg/JointState",
        JOINT_STATES,
        JOINT_STATES_SUBSCRIPTION,
        "Offered reliable, since robot_state_publisher and plots may ask for that; asked for best effort, so that "
        "any driver fits, and because the next state comes before a resend would.",
    ),
    Topic(
        "joint_command",
        "sensor_msgs/msg/JointState",
        JOINT_COMMAND,
        JOINT_COMMAND_SUBSCRIPTION,
        "As joint_states: a driver may ask for either, and the next command comes before a resend would.",
    ),
    Topic(
        "tip",
        "geometry_msgs/msg/PointStamped",
        TIP,
        TIP,
        "For plots and recordings, which want every sample: a little depth.",
    ),
    Topic(
        "~/status",
        "diagnostic_msgs/msg/DiagnosticStatus",
        STATUS,
        STATUS,
        "One verdict for each setpoint, none of which should be lost: depth for a burst.",
    ),
    Topic(
        "/diagnostics",
        "diagnostic_msgs/msg/DiagnosticArray",
        DIAGNOSTICS,
        DIAGNOSTICS,
        "As diagnostic_updater has it.",
    ),
)
