"""A suite's recording from a bag: of `record`, of the demo, or of `ros2 bag record` beside a real device.

Needs no ROS. Topics are found by the ends of their names, so that a namespace does not matter.
"""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path
from typing import Any

from gaik_core.errors import UnknownNameError
from gaik_ros.bag_writer import BagError, need_rosbags, typestore
from gaik_ros.recording import TOPICS, Raw, Recording


def read_bag(path: Path, namespace: str | None = None) -> Recording:
    """Return what a bag, a folder or an .mcap or .db3 file, holds of a suite.

    Raises:
        BagError: it cannot be read, or has no setpoints or no joint states, or those of several suites.
        UnknownNameError: a `namespace` that it does not have; the message lists those it has.
    """
    need_rosbags()
    from rosbags.rosbag2 import Reader, ReaderError

    if not path.exists():
        raise BagError(f"{path}: there is no such bag")
    if path.is_dir() and not (path / "metadata.yaml").is_file():
        unclosed = (
            " (it was not closed: `mcap recover` mends the .mcap file in it)"
            if any(path.glob("*.mcap"))
            else ""
        )
        raise BagError(f"{path}: is no bag, as it has no metadata.yaml{unclosed}")
    try:
        with Reader(path) as reader:
            topics = _topics(path, reader.connections, namespace)
            wanted = [connection for connection in reader.connections if connection.topic in topics]
            raw: dict[str, list[Raw]] = defaultdict(list)
            for connection, nanoseconds, data in reader.messages(wanted):
                raw[topics[connection.topic]].append((nanoseconds, bytes(data)))
    except (ReaderError, OSError, AssertionError) as reason:
        words = " ".join(str(reason).split()) or "it is no bag"
        hint = " (`mcap recover` mends a file that was not closed)" if path.suffix == ".mcap" else ""
        raise BagError(f"{path}: {words}{hint}") from None
    store = typestore()
    return Recording(raw, TOPICS, lambda data, type_name: store.deserialize_cdr(data, type_name))


def _topics(path: Path, connections: list[Any], namespace: str | None) -> dict[str, str]:
    """The topics of the suite that is meant, by their full names."""
    found: dict[str, dict[str, str]] = defaultdict(dict)
    for connection in connections:
        for topic, type_name in TOPICS.items():
            if (
                connection.topic.endswith(f"/{topic}")
                and connection.msgtype == type_name
                and connection.msgcount
            ):
                found[connection.topic.removesuffix(f"/{topic}")][connection.topic] = topic
    suites = {space: topics for space, topics in found.items() if _is_suite(topics)}
    if namespace is not None:
        space = f"/{namespace.strip('/')}".rstrip("/")
        if space not in suites:
            raise UnknownNameError("namespace", namespace, sorted(name or "/" for name in suites))
        return suites[space]
    if len(suites) == 1:
        return next(iter(suites.values()))
    if suites:
        names = ", ".join(sorted(name or "/" for name in suites))
        raise BagError(f"{path} has several suites; name one with --namespace: {names}")
    has = ", ".join(sorted({connection.topic for connection in connections})) or "nothing"
    raise BagError(f"{path} has no suite's setpoint and joint_states; it has {has}")


def _is_suite(topics: dict[str, str]) -> bool:
    return {"setpoint", "joint_states"} <= set(topics.values())
