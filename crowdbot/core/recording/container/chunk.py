"""The open chunk of an MCAP file.

A run writes hundreds of messages per simulated second, so a message is encoded with a single
``pack``; rarer records use `mcap.records`. Layout: https://mcap.dev/spec.
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

#: The lowest level that uses entropy coding, which people's data needs.
_COMPRESSION, _LEVEL = "zstd", 1
_MESSAGE = Struct("<BQHIQQ")  # opcode and length of a record; channel, sequence, both times
_INDEX = Struct("<BQHI")  # opcode and length of a record; channel, length of the entries
#: Opcode and length of a record; first and last time, uncompressed size and CRC; its compression;
#: length of the rest.
_CHUNK = Struct("<BQQQQII4sQ")
_PREFIX = 1 + 8  # opcode and length, which the length excludes
_OPCODE, _HEAD = Opcode.MESSAGE, _MESSAGE.size - _PREFIX

Piece = bytes | memoryview


class PackedChunk(NamedTuple):
    """A finished chunk with its indices, and the summary's data about both."""

    data: bytes
    entry: ChunkIndex


def serialised(records: Iterable[McapRecord]) -> bytes:
    """Return records one after another."""
    builder = RecordBuilder()
    for record in records:
        record.write(builder)
    data: bytes = builder.end()  # type: ignore[no-untyped-call]
    return data


class OpenChunk:
    """Collects records in order until the chunk is compressed and written.

    Attributes:
        size: bytes so far, uncompressed.
    """

    def __init__(self) -> None:
        self._compressor = zstandard.ZstdCompressor(level=_LEVEL)
        self._clear()

    def _clear(self) -> None:
        self._parts: list[Piece] = []
        # for each channel: time, offset, time, offset, …
        self._entries = defaultdict[int, list[int]](list)
        self.size = 0

    def define(self, record: Schema | Channel) -> None:
        """Add a definition that messages refer to."""
        data = serialised([record])
        self._parts.append(data)
        self.size += len(data)

    def add(self, channel: int, sequence: int, ns: int, *pieces: Piece) -> None:
        """Add a message in one or more pieces, logged and published at ``ns`` ns."""
        length = _HEAD + sum(map(len, pieces))
        self._parts += _MESSAGE.pack(_OPCODE, length, channel, sequence, ns, ns), *pieces
        self._entries[channel] += ns, self.size
        self.size += _PREFIX + length

    def pack(self, at: int) -> PackedChunk:
        """Compress the collected records, and begin a new chunk.

        Args:
            at: position of the chunk in the file.
        """
        plain = b"".join(self._parts)
        packed = self._compressor.compress(plain)
        times = [ns for entries in self._entries.values() for ns in entries[::2]]
        start, end = min(times), max(times)
        head = _CHUNK.pack(
            Opcode.CHUNK, _CHUNK.size - _PREFIX + len(packed), start, end, len(plain),
            crc32(plain), len(_COMPRESSION), _COMPRESSION.encode(), len(packed),
        )  # fmt: skip
        length = len(head) + len(packed)
        behind, offsets, indices = at + length, dict[int, int](), list[bytes]()
        for channel, entries in self._entries.items():
            offsets[channel] = behind
            indices.append(_index(channel, entries))
            behind += len(indices[-1])
        entry = ChunkIndex(
            chunk_start_offset=at,
            chunk_length=length,
            message_start_time=start,
            message_end_time=end,
            message_index_offsets=offsets,
            message_index_length=behind - at - length,
            compression=_COMPRESSION,
            compressed_size=len(packed),
            uncompressed_size=len(plain),
        )
        self._clear()
        return PackedChunk(b"".join([head, packed, *indices]), entry)


def _index(channel: int, entries: list[int]) -> bytes:
    """Return a MessageIndex record."""
    length = 8 * len(entries)
    head = _INDEX.pack(Opcode.MESSAGE_INDEX, _INDEX.size - _PREFIX + length, channel, length)
    return head + pack(f"<{len(entries)}Q", *entries)
