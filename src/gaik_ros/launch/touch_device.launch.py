"""The nodes for a real Touch, whose own driver publishes joint_states and takes joint_command.

ros2 launch gaik_ros touch_device.launch.py namespace:=left params_file:=/path/to/params.yaml autostart:=true
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

PARAMETERS = PathJoinSubstitution([FindPackageShare("gaik_ros"), "config", "touch.yaml"])

ARGUMENTS = (
    DeclareLaunchArgument("namespace", default_value="", description="namespace of all nodes"),
    DeclareLaunchArgument("params_file", default_value=PARAMETERS, description="parameters of all nodes"),
    DeclareLaunchArgument(
        "autostart",
        default_value="false",
        description="follow the path at once, instead of at /trajectory_publisher/start",
    ),
)


def _node(name: str, *overrides: dict[str, ParameterValue]) -> Node:
    return Node(
        package="gaik_ros",
        executable=name,
        name=name,
        namespace=LaunchConfiguration("namespace"),
        parameters=[LaunchConfiguration("params_file"), *overrides],
        output="screen",
    )


def generate_launch_description() -> LaunchDescription:
    autostart = {"autostart": ParameterValue(LaunchConfiguration("autostart"), value_type=bool)}
    nodes = [_node("ik_node"), _node("pid_controller"), _node("trajectory_publisher", autostart)]
    return LaunchDescription([*ARGUMENTS, *nodes])
