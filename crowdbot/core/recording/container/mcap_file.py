"""An MCAP file of ROS 2 messages, written deterministically.

The file contains no wall clock time or library version: log time is simulated time, so that equal
runs give equal bytes. Layout: https://mcap.dev/spec.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from mcap.records import Channel, ChunkIndex, Header, Schema, Statistics
from mcap.writer import MCAP0_MAGIC

from crowdbot.core.recording.container.chunk import OpenChunk, Piece, serialised
from crowdbot.core.recording.container.ending import FileIndex, ending
from crowdbot.core.recording.container.own_file import OwnFile, Written
from crowdbot.core.recording.messages import definition, to_cdr

CHUNK_SIZE = 256 * 1024


def _qos(*, latched: bool) -> str:
    """Return the quality of service in the format of rosbag2 metadata version 8.

    Version 9 uses words instead of numbers, which ROS 2 Humble refuses.
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


class _Topic:
    __slots__ = ("channel", "id", "messages")

    def __init__(self, channel: Channel) -> None:
        self.channel, self.id, self.messages = channel, channel.id, 0


class McapFile:
    """An MCAP file; topics are created by their first message.

    Attributes:
        written: what was written, once the file is closed.
    """

    def __init__(self, path: Path) -> None:
        """Start the file.

        Raises:
            InputError: the path cannot be written.
        """
        self._stream = OwnFile(path)
        self.written: Written | None = None
        self._schemas: dict[str, Schema] = {}
        self._topics: dict[str, _Topic] = {}
        self._chunk, self._chunks = OpenChunk(), list[ChunkIndex]()
        self._stream.write(MCAP0_MAGIC + serialised([Header(profile="ros2", library="crowdbot")]))

    def put(self, topic: str, ns: int, message: Any, *, latched: bool = False) -> None:
        """Append one message, logged at ``ns`` nanoseconds of simulated time."""
        self.put_bytes(topic, ns, message.__msgtype__, to_cdr(message), latched=latched)

    def put_bytes(
        self, topic: str, ns: int, msgtype: str, *pieces: Piece, latched: bool = False
    ) -> None:
        """Append one serialised message, in one or more pieces."""
        opened = self._topics.get(topic) or self._open(topic, msgtype, latched)
        chunk = self._chunk
        chunk.add(opened.id, opened.messages, ns, *pieces)
        opened.messages += 1
        if chunk.size >= CHUNK_SIZE:
            self._finish_chunk()

    def copy(self, channel: Channel, schema: Schema | None, ns: int, data: Piece) -> None:
        """Append a message of another file, with its topic's description."""
        opened = self._topics.get(channel.topic)
        if opened is None:
            opened = self._adopt(channel, schema)
        self._chunk.add(opened.id, opened.messages, ns, data)
        opened.messages += 1
        if self._chunk.size >= CHUNK_SIZE:
            self._finish_chunk()

    def _adopt(self, channel: Channel, schema: Schema | None) -> _Topic:
        mine = None if schema is None else self._schemas.get(schema.name)
        if schema is not None and mine is None:
            mine = replace(schema, id=len(self._schemas) + 1)
            self._schemas[schema.name] = mine
            self._chunk.define(mine)
        number = 0 if mine is None else mine.id
        record = replace(channel, id=len(self._topics) + 1, schema_id=number)
        self._chunk.define(record)
        opened = self._topics[channel.topic] = _Topic(record)
        return opened

    def flush(self) -> None:
        """Finish the open chunk; the operating system has all bytes then."""
        self._finish_chunk()

    def close(self) -> None:
        """Write index and footer; flush everything to disk."""
        self._finish_chunk()
        self._stream.mark()  # attachments come here
        self._stream.write(ending(self._index(), self._stream.tell()))
        self.written = self._stream.close()

    def _open(self, topic: str, msgtype: str, latched: bool) -> _Topic:
        schema = self._schemas.get(msgtype)
        if schema is None:
            schema = Schema(
                id=len(self._schemas) + 1,
                name=msgtype,
                encoding="ros2msg",
                data=definition(msgtype),
            )
            self._schemas[msgtype] = schema
            self._chunk.define(schema)
        channel = Channel(
            id=len(self._topics) + 1,
            topic=topic,
            message_encoding="cdr",
            metadata={"offered_qos_profiles": _qos(latched=latched)},
            schema_id=schema.id,
        )
        self._chunk.define(channel)
        opened = self._topics[topic] = _Topic(channel)
        return opened

    def _finish_chunk(self) -> None:
        if self._chunk.size:
            packed = self._chunk.pack(self._stream.tell())
            self._stream.write(packed.data)
            self._chunks.append(packed.entry)

    def _index(self) -> FileIndex:
        return FileIndex(
            schemas=list(self._schemas.values()),
            channels=[t.channel for t in self._topics.values()],
            statistics=self._statistics(),
            chunks=self._chunks,
        )

    def _statistics(self) -> Statistics:
        counts = {t.channel.id: t.messages for t in self._topics.values()}
        return Statistics(
            message_count=sum(counts.values()),
            schema_count=len(self._schemas),
            channel_count=len(self._topics),
            attachment_count=0,
            metadata_count=0,
            chunk_count=len(self._chunks),
            message_start_time=min((c.message_start_time for c in self._chunks), default=0),
            message_end_time=max((c.message_end_time for c in self._chunks), default=0),
            channel_message_counts=counts,
        )
