"""Namespaces in a recording of several robots: topics below ``/NAME``, and frames too.

Shared topics have no namespace: time, transforms, people, walls, map.
"""

from __future__ import annotations

from typing import Any

from crowdbot.core.recording.container.chunk import Piece
from crowdbot.core.recording.container.mcap_file import McapFile
from crowdbot.core.recording.topics import Topic

#: Topics that all robots share.
_SHARED = frozenset({Topic.TF, Topic.TF_STATIC})


class NamespacedFile(McapFile):
    """A view of a file in which one robot writes its own topics; the owner closes the file."""

    def __init__(self, file: McapFile, namespace: str) -> None:
        self._file, self._root = file, f"/{namespace}"

    def put(self, topic: str, ns: int, message: Any, *, latched: bool = False) -> None:
        """Append a message in the robot's namespace, see `McapFile.put`."""
        self._file.put(self._named(topic), ns, message, latched=latched)

    def put_bytes(
        self, topic: str, ns: int, msgtype: str, *pieces: Piece, latched: bool = False
    ) -> None:
        """Append a serialised message in the robot's namespace, see `McapFile.put_bytes`."""
        self._file.put_bytes(self._named(topic), ns, msgtype, *pieces, latched=latched)

    def flush(self) -> None:
        """Do nothing; the owner flushes the file."""

    def close(self) -> None:
        """Do nothing; the owner closes the file."""

    def _named(self, topic: str) -> str:
        return topic if topic in _SHARED else f"{self._root}{topic}"


def in_namespace(namespace: str, frame: str) -> str:
    """Return a robot's frame for others: ``NAME/frame``, or unchanged without a namespace."""
    return f"{namespace}/{frame}" if namespace else frame
