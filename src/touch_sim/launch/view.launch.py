"""The suite to be looked at: with the twin or a real device, in RViz, and kept as a bag.

ros2 launch touch_sim view.launch.py
ros2 launch touch_sim view.launch.py use_sim:=false driver:=geomagic_touch_ros2 record:=true
ros2 launch touch_sim view.launch.py namespace:=left rviz:=false params_file:=/path/to/params.yaml

With a namespace everything is inside it, the transforms too, so that two devices can run side by side.
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import (
    AndSubstitution,
    LaunchConfiguration,
    NotEqualsSubstitution,
    NotSubstitution,
    PathJoinSubstitution,
)
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

from touch_sim.description import touch_urdf

PARAMETERS = PathJoinSubstitution([FindPackageShare("gaik_ros"), "config", "touch.yaml"])
RVIZ = PathJoinSubstitution([FindPackageShare("touch_sim"), "rviz", "touch.rviz"])

USE_SIM = LaunchConfiguration("use_sim")
DRIVER = LaunchConfiguration("driver")

ARGUMENTS = (
    DeclareLaunchArgument(
        "use_sim", default_value="true", description="start the twin; false: a real driver takes its place"
    ),
    DeclareLaunchArgument(
        "driver",
        default_value="",
        description="with use_sim:=false, the driver that touch_adapter converts for; none: it speaks as we do",
    ),
    DeclareLaunchArgument(
        "autostart",
        default_value=USE_SIM,
        description="follow the path at once, instead of at trajectory_publisher/start",
    ),
    DeclareLaunchArgument("rviz", default_value="true", description="start RViz"),
    DeclareLaunchArgument("record", default_value="false", description="write all topics as an MCAP bag"),
    DeclareLaunchArgument("bag", default_value="", description="its folder; empty: run_ and the time"),
    DeclareLaunchArgument("namespace", default_value="", description="namespace of all nodes"),
    DeclareLaunchArgument("params_file", default_value=PARAMETERS, description="parameters of all nodes"),
)

# Transforms live in the namespace, as other tools for several robots have it.
TRANSFORMS = [("/tf", "tf"), ("/tf_static", "tf_static")]
SHOWN = [(f"/{topic}", topic) for topic in ("robot_description", "path_markers/markers", "tip")]


def _node(package: str, name: str, parameters: tuple = (), **options: object) -> Node:
    return Node(
        package=package,
        executable=name,
        name=name,
        namespace=LaunchConfiguration("namespace"),
        parameters=[LaunchConfiguration("params_file"), *parameters],
        output="screen",
        **options,
    )


def _value(argument: str, kind: type) -> ParameterValue:
    return ParameterValue(LaunchConfiguration(argument), value_type=kind)


def generate_launch_description() -> LaunchDescription:
    suite = [
        _node("touch_sim", "touch_sim", condition=IfCondition(USE_SIM)),
        _node(
            "gaik_ros",
            "touch_adapter",
            ({"driver": _value("driver", str)},),
            condition=IfCondition(
                AndSubstitution(NotSubstitution(USE_SIM), NotEqualsSubstitution(DRIVER, ""))
            ),
        ),
        _node("gaik_ros", "pid_controller"),
        _node("gaik_ros", "ik_node"),
        _node("gaik_ros", "trajectory_publisher", ({"autostart": _value("autostart", bool)},)),
    ]
    shown = [
        _node("gaik_ros", "path_markers"),
        _node(
            "robot_state_publisher",
            "robot_state_publisher",
            (
                {
                    "robot_description": ParameterValue(touch_urdf(), value_type=str),
                    "publish_frequency": 50.0,
                },
            ),
            remappings=TRANSFORMS,
        ),
        _node(
            "rviz2",
            "rviz2",
            arguments=["-d", RVIZ],
            remappings=[*TRANSFORMS, *SHOWN],
            condition=IfCondition(LaunchConfiguration("rviz")),
        ),
    ]
    kept = [
        _node(
            "gaik_ros",
            "record",
            ({"bag": _value("bag", str)},),
            condition=IfCondition(LaunchConfiguration("record")),
        )
    ]
    return LaunchDescription([*ARGUMENTS, *suite, *shown, *kept])
