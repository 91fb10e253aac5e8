"""The end of an MCAP file: end of data, index, footer. Layout: https://mcap.dev/spec."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from struct import pack

import mcap.records as mcap_records
from isal.isal_zlib import crc32
from mcap.opcode import Opcode
from mcap.writer import MCAP0_MAGIC

from crowdbot.core.recording.container.chunk import serialised

_END_OF_DATA = serialised([mcap_records.DataEnd(data_section_crc=0)])
#: Bytes between the data and the summary.
END_OF_DATA_SIZE = len(_END_OF_DATA)


@dataclass(frozen=True, kw_only=True)
class FileIndex:
    """The facts about a file in its summary."""

    schemas: Sequence[mcap_records.Schema]
    channels: Sequence[mcap_records.Channel]
    statistics: mcap_records.Statistics
    chunks: Sequence[mcap_records.ChunkIndex]
    attachments: Sequence[mcap_records.AttachmentIndex] = field(default=())


def ending(index: FileIndex, at: int) -> bytes:
    """Return all bytes from the end of the data, at ``at``, to the closing magic."""
    begin = at + END_OF_DATA_SIZE
    groups: dict[Opcode, Iterable[mcap_records.McapRecord]] = {
        Opcode.SCHEMA: index.schemas,
        Opcode.CHANNEL: index.channels,
        Opcode.STATISTICS: [index.statistics],
        Opcode.CHUNK_INDEX: index.chunks,
    }
    if index.attachments:
        groups[Opcode.ATTACHMENT_INDEX] = index.attachments
    data, offsets = b"", []
    for opcode, records in groups.items():
        group = serialised(records)
        offsets.append(mcap_records.SummaryOffset(opcode, begin + len(data), len(group)))
        data += group
    footer = mcap_records.Footer(
        summary_start=begin, summary_offset_start=begin + len(data), summary_crc=0
    )
    data += serialised(offsets)
    # The checksum covers the summary and the footer up to the checksum.
    begun = serialised([footer])[:-4]
    return _END_OF_DATA + data + begun + pack("<I", crc32(data + begun)) + MCAP0_MAGIC
