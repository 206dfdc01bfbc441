"""A suite's recordings as one bag, with the robot to be looked at: its URDF and its moving frames. Needs no ROS.

The frames are what robot_state_publisher would have said of the joint states: Foxglove moves the arm by them.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from gaik_ros.bag_writer import BagWriter
from gaik_ros.recording import Raw, Recording
from gaik_ros.viewer.urdf_shapes import UrdfShapes

FRAMES = 20_000_000  # ns between two sets of frames


def write_recordings(
    folder: Path,
    recordings: Sequence[Recording],
    namespace: str,
    description: str,
    replace: bool = False,
) -> Path:
    """Write a suite's recordings, one after the other, with the robot's URDF, as a bag; return its file.

    Raises BagError where a bag cannot be written there.
    """
    space = f"/{namespace.strip('/')}".rstrip("/")
    robot = UrdfShapes(description)
    with BagWriter(folder, replace) as writer:
        types = writer.types.types
        first = min(
            time_of(raw) for recording in recordings for kept in recording.raw.values() for raw in kept
        )
        writer.write_made(f"{space}/robot_description", first, types["std_msgs/msg/String"](data=description))
        for recording in recordings:
            for topic, kept in recording.raw.items():
                for raw in kept:
                    writer.write(f"{space}/{topic}", recording.types[topic], time_of(raw), raw[1])
            for nanoseconds, frames in _frames(types, robot, recording):
                writer.write_made(f"{space}/tf", nanoseconds, frames)
    return writer.file


def _frames(types: Any, robot: UrdfShapes, recording: Recording) -> Iterator[tuple[int, Any]]:
    """The frames of all links, every so often, at the time of a joint state."""
    due = 0
    for raw in recording.raw.get("joint_states", ()):
        if (nanoseconds := time_of(raw)) < due:
            continue
        due = nanoseconds + FRAMES
        state = recording.deserialize(raw[1], recording.types["joint_states"])
        values = dict(zip(state.name, state.position, strict=True))
        transforms = [_transform(types, nanoseconds, link, values) for link in robot.links if link.parent]
        yield nanoseconds, types["tf2_msgs/msg/TFMessage"](transforms=transforms)


def _transform(types: Any, nanoseconds: int, link: Any, values: dict[str, float]) -> Any:
    (x, y, z), (w, i, j, k) = (part.tolist() for part in link.pose(values))
    stamp = types["builtin_interfaces/msg/Time"](
        sec=nanoseconds // 1_000_000_000, nanosec=nanoseconds % 1_000_000_000
    )
    return types["geometry_msgs/msg/TransformStamped"](
        header=types["std_msgs/msg/Header"](stamp=stamp, frame_id=link.parent),
        child_frame_id=link.name,
        transform=types["geometry_msgs/msg/Transform"](
            translation=types["geometry_msgs/msg/Vector3"](x=x, y=y, z=z),
            rotation=types["geometry_msgs/msg/Quaternion"](x=i, y=j, z=k, w=w),
        ),
    )


def time_of(raw: Raw) -> int:
    """When a message was received, in ns; its stamp where that was not noted, as for those that have one."""
    nanoseconds, data = raw
    if nanoseconds:
        return nanoseconds
    little_endian = data[1] == 1  # of the four bytes before the message
    seconds, rest = struct.unpack_from("<iI" if little_endian else ">iI", data, 4)
    return int(seconds * 1_000_000_000 + rest)
