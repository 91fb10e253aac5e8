"""The file that we write, record by record beside the one that mcap's own writer makes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from mcap.records import Channel, Chunk, ChunkIndex, Footer, Message, MessageIndex, SummaryOffset
from mcap.stream_reader import StreamReader, breakup_chunk
from mcap.writer import Writer

from crowdbot.core.recording.container.mcap_file import CHUNK_SIZE, McapFile
from crowdbot.core.recording.messages import clock, definition, to_cdr

CLOCK = "rosgraph_msgs/msg/Clock"


def messages() -> list[tuple[str, int, bytes]]:
    """Topic, time and bytes: small ones, now and then one larger than a chunk."""
    rng = np.random.default_rng(5)
    found = []
    for n in range(300):
        size = CHUNK_SIZE + 7 if n % 100 == 50 else int(rng.integers(0, 5000))
        data = to_cdr(clock(n)) + rng.integers(0, 9, size, dtype=np.uint8).tobytes()
        # Messages need not be in the order of their times.
        found.append((f"/t{rng.integers(4)}", 1000 * n - int(rng.integers(0, 5000)) + 10**9, data))
    return found


def ours(path: Path) -> Path:
    file = McapFile(path)
    for n, (topic, ns, data) in enumerate(messages()):
        file.put_bytes(topic, ns, CLOCK, data, latched=topic == "/t0")
        if n % 90 == 0:
            file.flush()
    file.flush()
    file.flush()  # an empty chunk does not count
    file.close()
    return path


def theirs(path: Path, channels: dict[str, Channel]) -> Path:
    with path.open("wb") as stream:
        writer, ids = Writer(stream, chunk_size=CHUNK_SIZE), dict[str, int]()
        writer.start(profile="ros2", library="crowdbot")
        schema = 0
        counts = dict.fromkeys(channels, 0)
        for n, (topic, ns, data) in enumerate(messages()):
            if topic not in ids:
                schema = schema or writer.register_schema(CLOCK, "ros2msg", definition(CLOCK))
                ids[topic] = writer.register_channel(topic, "cdr", schema, channels[topic].metadata)
            writer.add_message(ids[topic], ns, data, ns, counts[topic])
            counts[topic] += 1
            if n % 90 == 0:
                writer.flush()  # type: ignore[no-untyped-call]
        writer.finish()  # type: ignore[no-untyped-call]
    return path


def records(path: Path) -> list[Any]:
    """All records; chunks as what is in them, lengths and places that compression moves as None."""
    found: list[Any] = []
    with path.open("rb") as stream:
        for record in StreamReader(stream, validate_crcs=True, emit_chunks=True).records:
            if isinstance(record, Chunk):
                found.append((record.message_start_time, record.message_end_time))
                found.append((record.uncompressed_crc, record.uncompressed_size))
                found += breakup_chunk(record, validate_crc=True)
            elif isinstance(record, ChunkIndex):
                times = record.message_start_time, record.message_end_time
                found.append((times, record.message_index_length, record.uncompressed_size))
                found.append(list(record.message_index_offsets))
            elif isinstance(record, SummaryOffset):  # theirs has some of empty groups, too
                found += [(record.group_opcode, record.group_length)][: record.group_length]
            elif not isinstance(record, Footer):
                found.append(record)
    return found


def test_the_records_are_those_of_the_reference_writer(tmp_path: Path) -> None:
    mine = records(ours(tmp_path / "ours.mcap"))
    channels = {c.topic: c for c in mine if isinstance(c, Channel)}
    assert mine == records(theirs(tmp_path / "theirs.mcap", channels))
    assert sum(isinstance(r, Message) for r in mine) == 300
    assert sum(isinstance(r, MessageIndex) for r in mine) > 8


def test_indices_point_at_what_they_name(tmp_path: Path) -> None:
    data = ours(tmp_path / "ours.mcap").read_bytes()
    with (tmp_path / "ours.mcap").open("rb") as stream:
        indices = [
            r
            for r in StreamReader(stream, emit_chunks=True).records
            if isinstance(r, ChunkIndex | Footer)
        ]
    for index in indices:
        if isinstance(index, Footer):
            assert data[index.summary_start] == 0x03  # a schema
            assert data[index.summary_offset_start] == 0x0E
        else:
            assert data[index.chunk_start_offset] == 0x06
            behind = index.chunk_start_offset + index.chunk_length
            assert min(index.message_index_offsets.values()) == behind
            assert {data[at] for at in index.message_index_offsets.values()} == {0x07}
