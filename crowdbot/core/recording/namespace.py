"""One recording of several robots: each has its topics below ``/NAME`` and its frames, too.

What all share stays where it is: time, transforms, people, walls, map.
"""

from __future__ import annotations

from typing import Any

from crowdbot.core.recording.container.chunk import Piece
from crowdbot.core.recording.container.mcap_file import McapFile
from crowdbot.core.recording.topics import Topic

#: Topics that robots write to together.
_SHARED = frozenset({Topic.TF, Topic.TF_STATIC})


class NamespacedFile(McapFile):
    """A file in which one robot writes to its own topics; who owns the file closes it."""

    def __init__(self, file: McapFile, namespace: str) -> None:
        self._file, self._root = file, f"/{namespace}"

    def put(self, topic: str, ns: int, message: Any, *, latched: bool = False) -> None:
        """As `McapFile.put`."""
        self._file.put(self._named(topic), ns, message, latched=latched)

    def put_bytes(
        self, topic: str, ns: int, msgtype: str, *pieces: Piece, latched: bool = False
    ) -> None:
        """As `McapFile.put_bytes`."""
        self._file.put_bytes(self._named(topic), ns, msgtype, *pieces, latched=latched)

    def flush(self) -> None:
        """Nothing: who owns the file does it."""

    def close(self) -> None:
        """Nothing: who owns the file does it."""

    def _named(self, topic: str) -> str:
        return topic if topic in _SHARED else f"{self._root}{topic}"


def in_namespace(namespace: str, frame: str) -> str:
    """A robot's frame as others know it: ``NAME/frame``, or itself where there is no namespace."""
    return f"{namespace}/{frame}" if namespace else frame
