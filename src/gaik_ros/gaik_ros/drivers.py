"""What the known drivers of the Touch say and hear, as read in their sources. docs/drivers.md tells more of each."""

from __future__ import annotations

from dataclasses import dataclass

JOINT_STATE = "sensor_msgs/msg/JointState"
WRENCH = "geometry_msgs/msg/Wrench"
WRENCH_STAMPED = "geometry_msgs/msg/WrenchStamped"
OMNI_FEEDBACK = "omni_msgs/msg/OmniFeedback"

TOUCH = ("waist", "shoulder", "elbow")
SAME = (1.0, 1.0, 1.0)
WAIST_FLIPPED = (-1.0, 1.0, 1.0)
XYZ = "x y z"
Z_UP = "x -z y"
"""Axes x to the right, y away from the user, z up."""


@dataclass(frozen=True)
class Driver:
    """The conventions of one driver, which are the defaults of touch_adapter's parameters.

    Attributes:
        repositories: where they were read.
        state_topic: of its joint states.
        command_topic, command_type: what moves it: a message with a force, or a JointState with efforts.
        joint_names: its names of our joints, in our order.
        joint_signs: -1 where its angle grows the other way.
        relative: whether it measures each angle from the link before it.
        use_velocity: whether its joint states have true velocities.
        force_axes: what of our axes each axis of its force is.
    """

    repositories: tuple[str, ...]
    state_topic: str
    command_topic: str
    command_type: str
    joint_names: tuple[str, ...] = TOUCH
    joint_signs: tuple[float, ...] = SAME
    relative: bool = False
    use_velocity: bool = False
    force_axes: str = XYZ


DRIVERS = {
    "geomagic_touch_ros2": Driver(
        ("stevens-armlab/Geomagic_Touch_ROS2", "goldengeko/Geomagic_Touch_ROS2"),
        "phantom/joint_states",
        "phantom/force_feedback",
        OMNI_FEEDBACK,
        joint_signs=WAIST_FLIPPED,
        relative=True,
        force_axes=Z_UP,
    ),
    "geomagic_touch_ros2_drivers": Driver(
        ("AleBarte/Geomagic_Touch_ROS2_Drivers",),
        "touch/joint_states",
        "touch/force_feedback",
        WRENCH_STAMPED,
        joint_signs=WAIST_FLIPPED,
        relative=True,
        force_axes=Z_UP,
    ),
    "geomagic_touch_x_ros2": Driver(
        ("RViMLab/geomagic_touch_x_ros2",),
        "geomagic_touch_x/joint_states",
        "geomagic_touch_x/command/wrench",
        WRENCH,
        joint_names=("joint_angle_1", "joint_angle_2", "joint_angle_3"),
    ),
    "saw_sensable_phantom": Driver(
        ("jhu-saw/sawSensablePhantom", "jhu-saw/sawSensablePhantomROS2"),
        "arm/measured_js",
        "arm/servo_cf",
        WRENCH_STAMPED,
        joint_signs=WAIST_FLIPPED,
        relative=True,
    ),
    "phantom_omni": Driver(
        ("bharatm11/Geomagic_Touch_ROS_Drivers", "fsuarez6/phantom_omni"),
        "phantom/joint_states",
        "phantom/force_feedback",
        OMNI_FEEDBACK,
        joint_signs=WAIST_FLIPPED,
        relative=True,
        force_axes=Z_UP,
    ),
    "openhaptics": Driver((), "driver/joint_states", "driver/force", WRENCH, use_velocity=True),
    "own": Driver((), "driver/joint_states", "driver/joint_command", JOINT_STATE, use_velocity=True),
}
"""By name. `openhaptics` is HDAPI's own conventions, for a driver that passes them on; `own` is ours."""

DEFAULT = "geomagic_touch_ros2"
