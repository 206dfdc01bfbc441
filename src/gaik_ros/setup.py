from pathlib import Path

from setuptools import find_packages, setup

package_name = "gaik_ros"


def files(folder: str, pattern: str) -> list[str]:
    return [str(path) for path in sorted(Path(folder).glob(pattern))]


setup(
    name=package_name,
    version="0.1.0",
    packages=find_packages(exclude=["test"]),
    package_data={package_name: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{package_name}"]),
        (f"share/{package_name}", ["package.xml"]),
        (f"share/{package_name}/launch", files("launch", "*.launch.py")),
        (f"share/{package_name}/config", files("config", "*.yaml") + files("config", "*.xml")),
        # pip puts console scripts into bin/ only; `ros2 run` looks here.
        (f"lib/{package_name}", files("scripts", "*")),
    ],
    install_requires=["gaik_core", "numpy>=1.26"],
    # On a ROS 2 machine rclpy comes with ROS; elsewhere these wheels bring it.
    extras_require={
        "rclpy": ["ros-jazzy-rclpy[fastrtps]", "ros-jazzy-common-interfaces"],
        "bags": ["rosbags>=0.11"],
        "viewer": ["viser>=1.1,<2"],
        "test": ["pytest"],
    },
    python_requires=">=3.11",
    zip_safe=True,
    maintainer="The gaik developers",
    maintainer_email="developers@gaik.dev",
    description="ROS 2 nodes for inverse kinematics and joint control of a haptic device.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "ik_node = gaik_ros.executables:ik_node",
            "pid_controller = gaik_ros.executables:pid_controller",
            "trajectory_publisher = gaik_ros.executables:trajectory_publisher",
            "viewer = gaik_ros.executables:viewer",
            "record = gaik_ros.executables:record",
            "path_markers = gaik_ros.executables:path_markers",
            "touch_adapter = gaik_ros.executables:touch_adapter",
            "inject = gaik_ros.executables:inject",
        ],
        "gaik.commands": [
            "plot = gaik_ros.cli.plot:COMMAND",
            "replay = gaik_ros.cli.replay:COMMAND",
        ],
    },
)
