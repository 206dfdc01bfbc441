"""Quality of service, one profile per topic, with the reason for each.

Every command and state topic keeps the newest message only: for control an old value is worse than none.
"""

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy


def _profile(depth: int, reliability: ReliabilityPolicy) -> QoSProfile:
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=depth,
        reliability=reliability,
        durability=DurabilityPolicy.VOLATILE,
    )


RELIABLE, BEST_EFFORT = ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT

# A setpoint is sent once by hand and must arrive, and `ros2 topic pub` offers reliable. Depth 1: newest wins.
# Volatile: a setpoint from before the node's start must not move the arm at its start.
SETPOINT = _profile(1, RELIABLE)

# Published at 100 Hz again and again, so a lost one would cost 10 ms; reliable is cheap at this rate, and any
# subscriber may connect to it.
JOINT_REFERENCE = _profile(1, RELIABLE)

# The real drivers and robot_state_publisher offer or ask for reliable; a best-effort subscription connects to
# both. So publishers offer reliable, and our subscription asks for best effort: no resend of an old state.
JOINT_STATES = _profile(1, RELIABLE)
JOINT_STATES_SUBSCRIPTION = _profile(1, BEST_EFFORT)

# At 1000 Hz the next command comes before a resend would.
# Offered reliable, so that a driver that asks for it hears it; asked for as best effort.
JOINT_COMMAND = _profile(1, RELIABLE)
JOINT_COMMAND_SUBSCRIPTION = _profile(1, BEST_EFFORT)

# For plots and logs, which like to have every sample: a little depth.
TIP = _profile(10, RELIABLE)

# One verdict per solved setpoint, none of which should be lost: reliable, and depth for a burst.
STATUS = _profile(100, RELIABLE)

# As diagnostic_updater has it.
DIAGNOSTICS = _profile(10, RELIABLE)
