"""MCAP bags that `ros2 bag`, Foxglove and PlotJuggler open, written by rosbags. Needs no ROS."""

from __future__ import annotations

import shutil
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Final

from gaik_core.errors import GaikError

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

VERSION: Final = 9  # of the bag's format: rosbag2's of Jazzy


class BagError(GaikError):
    """A bag that cannot be written or read; the message is one line for the user."""


def need_rosbags() -> None:
    """Raise BagError where the package that bags are written and read by is missing."""
    try:
        import rosbags  # noqa: F401
    except ImportError:
        raise BagError("bags need rosbags, which is not installed: pip install rosbags") from None


def typestore() -> Typestore:
    """The definitions of Jazzy's messages."""
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS2_JAZZY)


class BagWriter:
    """A bag in a new folder `run`: the file run/run.mcap and its metadata.

    A context manager: a block that ends with an exception leaves a bag that was to be replaced as it was.
    """

    def __init__(self, folder: Path, replace: bool = False) -> None:
        """Begin the bag; with `replace`, one of that name that is there stays until this one is complete.

        Raises:
            BagError: rosbags is missing, the folder is there and may not be replaced or is no bag, or cannot be made.
        """
        need_rosbags()
        if folder.exists() and not (replace and (folder / "metadata.yaml").is_file()):
            raise BagError(f"{folder} exists already; bags are not overwritten")
        from rosbags.rosbag2 import StoragePlugin, Writer

        self._folder = folder
        # rosbags names the file after the folder, so the place until it is complete is another folder's.
        self._place = folder.parent / f".{folder.name}.part" / folder.name if folder.exists() else folder
        if self._place != folder:
            shutil.rmtree(self._place.parent, ignore_errors=True)
        self._writer = Writer(self._place, version=VERSION, storage_plugin=StoragePlugin.MCAP)
        try:
            self._writer.open()
        except OSError as reason:
            raise BagError(f"the bag {folder} cannot be made: {reason.strerror or reason}") from None
        self.types = typestore()
        self._connections: dict[str, Any] = {}
        self.counts: dict[str, int] = {}

    def knows(self, type_name: str) -> bool:
        """Whether messages of this type can be written."""
        return type_name in self.types.types

    def write(self, topic: str, type_name: str, nanoseconds: int, data: bytes) -> None:
        """Add a message as it is on the wire, `nanoseconds` after 1970. BagError: its type is not known."""
        connection = self._connections.get(topic)
        if connection is None:
            if not self.knows(type_name):
                raise BagError(f"{topic} has the type {type_name}, whose definition is not known here")
            connection = self._writer.add_connection(topic, type_name, typestore=self.types)
            self._connections[topic], self.counts[topic] = connection, 0
        self._writer.write(connection, nanoseconds, data)
        self.counts[topic] += 1

    def write_made(self, topic: str, nanoseconds: int, message: Any) -> None:
        """Add a message made of rosbags' types, as `types` has them."""
        name = message.__msgtype__
        self.write(topic, name, nanoseconds, bytes(self.types.serialize_cdr(message, name)))

    @property
    def file(self) -> Path:
        """The bag's file, once it is complete."""
        return self._folder / f"{self._folder.name}.mcap"

    def close(self) -> None:
        """Complete the bag: without it no tool opens the file."""
        self._writer.close()
        if self._place != self._folder:
            shutil.rmtree(self._folder)
            self._place.rename(self._folder)
            self._place.parent.rmdir()

    def _give_up(self) -> None:
        """Keep the bag of before; one that replaces none is kept as far as it was written."""
        self._writer.close()
        if self._place != self._folder:
            shutil.rmtree(self._place.parent)

    def __enter__(self) -> BagWriter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None:
            self.close()
        else:
            self._give_up()
