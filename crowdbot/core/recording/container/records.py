"""Read messages from an MCAP file that may be cut off, damaged or hostile.

A run that was killed leaves a file without index and footer; it is read sequentially up to its last
whole chunk. Nothing may follow a broken chunk: damage in the middle is an error.
"""

from __future__ import annotations

import mmap
import os
import struct
from collections.abc import Callable, Generator, Iterator, Mapping
from functools import partial
from io import BytesIO
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

import lz4.frame  # type: ignore[import-untyped]
import zstandard
from isal.isal_zlib import crc32
from mcap.data_stream import ReadDataStream
from mcap.exceptions import EndOfFile, InvalidMagic, McapError
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    Channel,
    Chunk,
    DataEnd,
    Footer,
    McapRecord,
    Message,
    Schema,
    Statistics,
)
from mcap.stream_reader import MAGIC_SIZE, read_magic

import crowdbot.core.recording.messages as ros
from crowdbot.dsl.text.bounded_files import open_file, reason_of
from crowdbot.errors import InputError

#: Our chunks have 256 KiB plus one message. Larger ones are refused before decompression.
MAX_CHUNK = 64 * 2**20
MAX_RECORD = 2 * MAX_CHUNK
MAX_TOTAL = 4 * 2**30
#: Largest number of records: this many, plus two per byte of the file. Our messages take some
#: hundred bytes, and well compressed clocks four.
MAX_RECORDS = 1_000_000
_PREFIX = struct.Struct("<BQ")  # opcode and length of a record
_MESSAGE = struct.Struct("<HIQQ")  # channel, sequence, both times
_BROKEN = (
    McapError,
    zstandard.ZstdError,
    struct.error,
    ValueError,
    KeyError,
    RuntimeError,  # from lz4
)


class Opened(NamedTuple):
    """A topic as described in a file: its channel, and its schema if it has one."""

    record: Channel
    schema: Schema | None


class Record(NamedTuple):
    """A serialised message as read from the file."""

    topic: str
    msgtype: str
    encoding: str
    ns: int
    data: bytes


class Records:
    """Iterates once over the messages of a file; afterwards it knows the file's other contents.

    Attributes:
        finished: True if it had its footer.
        attachments: name -> bytes of the files that are attached.
    """

    def __init__(self, path: Path) -> None:
        self.finished = False
        self.attachments: dict[str, int] = {}
        self._path = path
        self._schemas: dict[int, Schema] = {}
        self._channels: dict[int, Channel] = {}
        self._topics: dict[int, tuple[str, str, str]] = {}  # per channel
        self._total = 0
        self._left = MAX_RECORDS
        self._seen = self._attached = 0
        self._zstd = zstandard.ZstdDecompressor()

    def __iter__(self) -> Generator[Record, None, None]:
        """Yield messages in the order they were written.

        Raises:
            InputError: not an MCAP file, damaged before its end, or unreasonably large when
                decompressed.
        """
        try:
            with open_file(self._path) as file, _mapped(file.fileno()) as data:
                self._left = MAX_RECORDS + 2 * len(data)
                yield from self._records(data)
        except OSError as error:
            inside = "; a run's is run.mcap in it" if isinstance(error, IsADirectoryError) else ""
            raise InputError(f"{self._path}: cannot be read: {reason_of(error)}{inside}") from error

    def channel(self, topic: str) -> Opened:
        """Return the file's description of a topic with messages; the latest of its channels."""
        channel = next(c for c in reversed(self._channels.values()) if c.topic == topic)
        return Opened(channel, self._schemas.get(channel.schema_id))

    def _records(self, data: mmap.mmap) -> Iterator[Record]:
        broken = False
        for record in self._top_level(data):
            if isinstance(record, Chunk | DataEnd | Footer) and broken:
                raise InputError(f"{self._path}: damaged: a chunk in the middle does not unpack")
            if isinstance(record, Chunk):
                inner = self._unpack(record)
                broken = inner is None
                yield from self._messages(inner or [])
            elif isinstance(record, Statistics):
                self._compare(record)
            elif isinstance(record, Attachment):
                self._count(1)
                self._attached += 1
                self.attachments[record.name] = len(record.data)
            elif isinstance(record, Schema | Channel | Message):
                self._count(1)
                yield from self._messages([record])

    def _compare(self, summary: Statistics) -> None:
        """Refuse a file that lacks something that was written.

        Raises:
            InputError: messages or attached files are missing.
        """
        if summary.message_count != self._seen:
            raise InputError(f"{self._path}: damaged: messages are missing")
        if summary.attachment_count != self._attached:
            raise InputError(f"{self._path}: damaged: attached files are missing")

    def _top_level(self, data: mmap.mmap) -> Iterator[McapRecord]:
        try:
            yield from _framed(data)
            self.finished = True
            rest = len(data) - data.tell()
        except InvalidMagic as error:
            if data.tell() <= 8:
                raise InputError(f"{self._path}: not an MCAP file") from error
        except (*_BROKEN, EndOfFile, OverflowError):
            if data.tell() < 8:
                raise InputError(f"{self._path}: not an MCAP file") from None
        else:
            if rest:
                raise InputError(f"{self._path}: damaged: {rest} bytes follow its end")

    def _unpack(self, chunk: Chunk) -> list[McapRecord] | None:
        """Return the records of a chunk, or None if it is broken."""
        self._total += chunk.uncompressed_size
        if chunk.uncompressed_size > MAX_CHUNK or self._total > MAX_TOTAL:
            raise InputError(f"{self._path}: refused: unpacks to more than a recording may")
        if chunk.compression not in ("", "zstd", "lz4"):
            raise InputError(f"{self._path}: compression '{chunk.compression}' is not supported")
        try:
            plain = self._decompress(chunk)
            if chunk.uncompressed_crc not in (0, crc32(plain)):
                return None
            found = list(islice(_split(plain), self._left + 1))
        except _BROKEN:
            return None
        self._count(len(found))
        return found

    def _decompress(self, chunk: Chunk) -> bytes:
        """Decompress at most the declared size: the frame's own size may be a bomb."""
        if chunk.compression == "":
            return chunk.data
        most = chunk.uncompressed_size + 1
        data: bytes
        if chunk.compression == "lz4":
            data = lz4.frame.LZ4FrameDecompressor().decompress(chunk.data, max_length=most)
        else:
            with self._zstd.stream_reader(chunk.data) as reader:
                data = reader.read(most)
        if len(data) != chunk.uncompressed_size:
            raise ValueError("size differs from the one announced")
        return data

    def _count(self, records: int) -> None:
        """Refuse a file with too many messages, which compression lets a small file hold."""
        self._left -= records
        if self._left < 0:
            raise InputError(f"{self._path}: refused: holds more messages than a recording may")

    def _messages(self, records: list[McapRecord]) -> Iterator[Record]:
        for record in records:
            if isinstance(record, Message):
                self._seen += 1
                topic = self._topics.get(record.channel_id) or self._topic(record.channel_id)
                yield Record(*topic, record.log_time, record.data)
            elif isinstance(record, Schema):
                self._schemas[record.id] = record
                self._topics.clear()
            elif isinstance(record, Channel):
                self._channels[record.id] = record
                self._topics.clear()

    def _topic(self, number: int) -> tuple[str, str, str]:
        """Return topic, type and encoding of a channel's messages."""
        channel = self._channels.get(number)
        if channel is None or (channel.schema_id and channel.schema_id not in self._schemas):
            raise InputError(f"{self._path}: damaged: a message belongs to no topic")
        msgtype = self._schemas[channel.schema_id].name if channel.schema_id else ""
        self._topics[number] = channel.topic, msgtype, channel.message_encoding
        return self._topics[number]


def _mapped(fileno: int) -> mmap.mmap:
    """Return the file as memory, so that a false length cannot cause an allocation."""
    try:
        return mmap.mmap(fileno, 0, access=mmap.ACCESS_READ)
    except ValueError:  # empty
        return mmap.mmap(-1, 1)


def _framed(data: mmap.mmap) -> Iterator[McapRecord]:
    """Return the records of a file that are used, from magic to magic; indices are skipped.

    Raises:
        ValueError, McapError, struct.error: it ends early or is damaged.
    """
    read_magic(_stream(data.read(MAGIC_SIZE)))
    opcode = -1
    while opcode != Opcode.FOOTER:
        opcode, length = _PREFIX.unpack(data.read(_PREFIX.size))
        if length > MAX_RECORD:
            raise ValueError("a record is longer than any may be")
        begin = data.tell()
        data.seek(length, os.SEEK_CUR)
        if opcode in _READERS:
            yield _READERS[opcode](data[begin : begin + length])
    read_magic(_stream(data.read(MAGIC_SIZE)))


def _split(plain: bytes) -> Iterator[McapRecord]:
    """Yield the records of a chunk; messages, the most frequent, are read without a stream.

    Raises:
        ValueError: a record is longer than the chunk.
    """
    at, end = 0, len(plain)
    while at < end:
        opcode, length = _PREFIX.unpack_from(plain, at)
        at += _PREFIX.size
        if at + length > end:
            raise ValueError("a record is longer than its chunk")
        if opcode == Opcode.MESSAGE:
            yield _message(plain, at, at + length)
        elif opcode in (Opcode.SCHEMA, Opcode.CHANNEL):
            yield _READERS[opcode](plain[at : at + length])
        at += length


def _message(data: bytes, begin: int = 0, end: int | None = None) -> Message:
    channel, sequence, logged, published = _MESSAGE.unpack_from(data, begin)
    return Message(channel, logged, data[begin + _MESSAGE.size : end], published, sequence)


def _stream(data: bytes) -> ReadDataStream:
    return ReadDataStream(BytesIO(data))


def _read(kind: Any, data: bytes) -> McapRecord:
    record: McapRecord = kind.read(_stream(data))
    return record


#: Readers of the records that are used.
_READERS: Mapping[int, Callable[[bytes], McapRecord]] = {
    Opcode.MESSAGE: _message,
    **{
        opcode: partial(_read, kind)
        for opcode, kind in (
            (Opcode.ATTACHMENT, Attachment),
            (Opcode.CHANNEL, Channel),
            (Opcode.CHUNK, Chunk),
            (Opcode.DATA_END, DataEnd),
            (Opcode.FOOTER, Footer),
            (Opcode.SCHEMA, Schema),
            (Opcode.STATISTICS, Statistics),
        )
    },
}


def decode(path: Path, record: Record) -> Any:
    """Decode the message of a record.

    Raises:
        InputError: it cannot be decoded; ``path`` is used in the message.
    """
    try:
        return ros.from_cdr(record.data, record.msgtype)
    except Exception as error:  # the decoder is generated code and may raise anything
        raise InputError(
            f"{path}: {record.topic}: a {record.msgtype} that cannot be decoded"
        ) from error
