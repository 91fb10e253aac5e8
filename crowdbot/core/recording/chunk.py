"""The chunk of an MCAP file that is being filled.

A run hands over some hundreds of messages per simulated second, so a message becomes bytes by one
``pack``; everything rarer is left to `mcap.records`. Layout: https://mcap.dev/spec.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from struct import Struct, pack
from typing import NamedTuple

import zstandard
from isal.isal_zlib import crc32
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import Channel, ChunkIndex, McapRecord, Schema

_COMPRESSION, _LEVEL = "zstd", -1
_MESSAGE = Struct("<BQHIQQ")  # opcode and length of a record; channel, sequence, both times
_INDEX = Struct("<BQHI")  # opcode and length of a record; channel, length of the entries
#: Opcode and length of a record; first and last time, size and CRC without compression; its name;
#: length of what follows.
_CHUNK = Struct("<BQQQQII4sQ")
_PREFIX = 1 + 8  # opcode and length, which the length leaves out
_OPCODE, _HEAD = Opcode.MESSAGE, _MESSAGE.size - _PREFIX

Piece = bytes | memoryview


class PackedChunk(NamedTuple):
    """A finished chunk.

    Attributes:
        data: its record.
        indices: of its channels; they follow it.
        start, end: of its messages, ns; 0 without any.
        plain_size: bytes before they were compressed.
    """

    data: bytes
    indices: dict[int, bytes]
    start: int
    end: int
    plain_size: int

    @property
    def size(self) -> int:
        """Bytes in the file."""
        return len(self.data) + sum(map(len, self.indices.values()))

    def entry(self, at: int) -> ChunkIndex:
        """What the summary says of a chunk that is ``at`` in the file."""
        offsets, end = dict[int, int](), at + len(self.data)
        for channel, index in self.indices.items():
            offsets[channel] = end
            end += len(index)
        return ChunkIndex(
            chunk_start_offset=at,
            chunk_length=len(self.data),
            message_start_time=self.start,
            message_end_time=self.end,
            message_index_offsets=offsets,
            message_index_length=end - at - len(self.data),
            compression=_COMPRESSION,
            compressed_size=len(self.data) - _CHUNK.size,
            uncompressed_size=self.plain_size,
        )


def serialised(records: Iterable[McapRecord]) -> bytes:
    """Records one after another."""
    builder = RecordBuilder()
    for record in records:
        record.write(builder)
    data: bytes = builder.end()  # type: ignore[no-untyped-call]
    return data


class OpenChunk:
    """Collects records in the order in which they come.

    Attributes:
        size: bytes so far, uncompressed.
    """

    def __init__(self) -> None:
        self._compressor = zstandard.ZstdCompressor(level=_LEVEL)
        self._clear()

    def _clear(self) -> None:
        self._parts: list[Piece] = []
        # Of a channel: time, offset, time, offset, …
        self._entries = defaultdict[int, list[int]](list)
        self.size = 0

    def define(self, record: Schema | Channel) -> None:
        """Add what messages refer to."""
        data = serialised([record])
        self._parts.append(data)
        self.size += len(data)

    def add(self, channel: int, sequence: int, ns: int, *pieces: Piece) -> None:
        """Add a message that lies in one or more pieces, logged and published at ``ns`` ns."""
        length = _HEAD + sum(map(len, pieces))
        self._parts += _MESSAGE.pack(_OPCODE, length, channel, sequence, ns, ns), *pieces
        self._entries[channel] += ns, self.size
        self.size += _PREFIX + length

    def pack(self) -> PackedChunk:
        """Compress what was collected, and begin anew."""
        plain = b"".join(self._parts)
        packed = self._compressor.compress(plain)
        times = [ns for entries in self._entries.values() for ns in entries[::2]]
        start, end = min(times, default=0), max(times, default=0)
        head = _CHUNK.pack(
            Opcode.CHUNK, _CHUNK.size - _PREFIX + len(packed), start, end, len(plain),
            crc32(plain), len(_COMPRESSION), _COMPRESSION.encode(), len(packed),
        )  # fmt: skip
        indices = {channel: _index(channel, e) for channel, e in self._entries.items()}
        self._clear()
        return PackedChunk(head + packed, indices, start, end, len(plain))


def _index(channel: int, entries: list[int]) -> bytes:
    """A MessageIndex record."""
    length = 8 * len(entries)
    head = _INDEX.pack(Opcode.MESSAGE_INDEX, _INDEX.size - _PREFIX + length, channel, length)
    return head + pack(f"<{len(entries)}Q", *entries)
