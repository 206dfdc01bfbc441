"""The whole suite with the twin of a Touch: it follows the path of the parameter file at once.

ros2 launch touch_sim touch.launch.py namespace:=left params_file:=/path/to/params.yaml
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

# package, executable, which is the node's name too
NODES = (
    ("touch_sim", "touch_sim"),
    ("gaik_ros", "pid_controller"),
    ("gaik_ros", "ik_node"),
    ("gaik_ros", "trajectory_publisher"),
)

PARAMETERS = PathJoinSubstitution([FindPackageShare("gaik_ros"), "config", "touch.yaml"])

ARGUMENTS = (
    DeclareLaunchArgument("namespace", default_value="", description="namespace of all nodes"),
    DeclareLaunchArgument("params_file", default_value=PARAMETERS, description="parameters of all nodes"),
)


def generate_launch_description() -> LaunchDescription:
    nodes = [
        Node(
            package=package,
            executable=executable,
            name=executable,
            namespace=LaunchConfiguration("namespace"),
            parameters=[LaunchConfiguration("params_file")],
            output="screen",
        )
        for package, executable in NODES
    ]
    return LaunchDescription([*ARGUMENTS, *nodes])
