"""An MCAP file of ROS 2 messages, written in a deterministic way.

No wall clock and no library version enters the file: log time is simulated time, so that equal
runs give equal bytes.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mcap.writer import CompressionType, Writer

from crowdbot.core.recording.messages import definition, to_cdr
from crowdbot.errors import InputError

CHUNK_SIZE = 256 * 1024


def _qos(*, latched: bool) -> str:
    """Offered quality of service as rosbag2 metadata version 8 spells it.

    Version 9 uses words instead of numbers and is refused by ROS 2 Humble.
    """
    forever = "\n    sec: 2147483647\n    nsec: 4294967295"
    return (
        f"- history: {1 if latched else 3}\n"
        f"  depth: {1 if latched else 0}\n"
        "  reliability: 1\n"
        f"  durability: {1 if latched else 2}\n"
        f"  deadline:{forever}\n"
        f"  lifespan:{forever}\n"
        "  liveliness: 1\n"
        f"  liveliness_lease_duration:{forever}\n"
        "  avoid_ros_namespace_conventions: false\n"
    )


@dataclass(slots=True)
class _Channel:
    id: int
    messages: int = 0


class McapFile:
    """Topics are opened by their first message."""

    def __init__(self, path: Path) -> None:
        """Start the file.

        Raises:
            InputError: the path cannot be written.
        """
        try:
            self._stream = path.open("wb")
        except OSError as error:
            raise InputError(f"{path}: cannot be written: {error.strerror}") from error
        self._writer = Writer(self._stream, chunk_size=CHUNK_SIZE, compression=CompressionType.ZSTD)
        self._writer.start(profile="ros2", library="crowdbot")
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, _Channel] = {}

    def put(self, topic: str, ns: int, message: Any, *, latched: bool = False) -> None:
        """Append one message, logged at ``ns`` nanoseconds of simulated time."""
        self.put_bytes(topic, ns, message.__msgtype__, to_cdr(message), latched=latched)

    def put_bytes(
        self, topic: str, ns: int, msgtype: str, data: bytes, *, latched: bool = False
    ) -> None:
        """Append one message that is already serialised."""
        channel = self._channels.get(topic)
        if channel is None:
            channel = self._channels[topic] = _Channel(self._open(topic, msgtype, latched))
        self._writer.add_message(channel.id, ns, data, ns, channel.messages)
        channel.messages += 1

    def flush(self) -> None:
        """Finish the open chunk and hand all bytes to the operating system."""
        self._writer.flush()  # type: ignore[no-untyped-call]

    def close(self) -> None:
        """Write index and footer; when this returns the disk has it all."""
        self._writer.finish()  # type: ignore[no-untyped-call]
        self._stream.flush()
        os.fsync(self._stream.fileno())
        self._stream.close()

    def _open(self, topic: str, msgtype: str, latched: bool) -> int:
        schema = self._schemas.get(msgtype)
        if schema is None:
            schema = self._writer.register_schema(msgtype, "ros2msg", definition(msgtype))
            self._schemas[msgtype] = schema
        metadata = {"offered_qos_profiles": _qos(latched=latched)}
        return self._writer.register_channel(topic, "cdr", schema, metadata)
