"""Files attached to a recording: the scenario, and the results."""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Mapping
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import IO

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.reader import SeekingReader
from mcap.records import Attachment, AttachmentIndex

from crowdbot.core.recording.container.chunk import serialised
from crowdbot.core.recording.container.ending import END_OF_DATA_SIZE, FileIndex, ending
from crowdbot.dsl.text.bounded_files import open_file
from crowdbot.errors import InputError

#: Header of a record: its type and length.
_HEAD = 9
_TYPES = {".json": "application/json", ".yaml": "application/yaml", ".csv": "text/csv"}


def attach(path: Path, files: Mapping[str, bytes]) -> bytes:
    """Attach files to a complete recording, replacing earlier ones.

    Args:
        path: the recording; if the process is killed meanwhile, it can be recovered.
        files: name -> content.

    Returns:
        The bytes that now follow the recorded data.

    Raises:
        InputError: it cannot be written, or has no index, because it is incomplete.
    """
    index, end = _index(path)
    data, found = b"", []
    for name, content in files.items():
        kind = _TYPES.get(Path(name).suffix, "application/octet-stream")
        record = serialised([Attachment(0, 0, name, kind, content)])
        found.append(AttachmentIndex(end + len(data), len(record), 0, 0, len(content), name, kind))
        data += record
    statistics = replace(index.statistics, attachment_count=len(found))
    index = replace(index, statistics=statistics, attachments=found)
    data += ending(index, end + len(data))
    try:
        with path.open("r+b") as file:
            file.seek(end)
            file.truncate()
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from error
    return data


def attached(path: Path) -> list[tuple[str, bytes]]:
    """Return the files in a complete recording, names and contents, in order.

    Raises:
        InputError: they cannot be read, or their checksums are wrong.
    """
    try:
        with open_file(path) as file:
            summary = SeekingReader(file).get_summary()
            if summary is None or summary.statistics is None:
                raise ValueError("it has no index")
            return [_content(file, place) for place in summary.attachment_indexes]
    except (McapError, OSError, ValueError, EOFError, struct.error) as error:
        why = str(error) or "it ends within a record"  # the only meaning in the reader
        raise InputError(f"{path}: its attachments cannot be read: {why}") from error


def _content(file: IO[bytes], place: AttachmentIndex) -> tuple[str, bytes]:
    file.seek(place.offset)
    record = file.read(place.length)[_HEAD:]
    crc = int.from_bytes(record[-4:], "little")
    if crc and crc != zlib.crc32(record[:-4]):
        raise ValueError(f"the checksum of '{place.name[:100]}' is another one")
    attachment = Attachment.read(ReadDataStream(BytesIO(record)))
    return attachment.name, attachment.data


def _index(path: Path) -> tuple[FileIndex, int]:
    """Return the file's index, and where attachments, or else the end of data, start."""
    problem = InputError(f"{path}: not a complete recording: it has no index")
    try:
        with open_file(path) as file:
            summary = SeekingReader(file).get_summary()
            file.seek(-37, os.SEEK_END)
            begin = int.from_bytes(file.read(37)[9:17], "little")
    except (McapError, OSError, ValueError) as error:
        raise problem from error
    if summary is None or summary.statistics is None:
        raise problem
    known = FileIndex(
        schemas=list(summary.schemas.values()),
        channels=list(summary.channels.values()),
        statistics=summary.statistics,
        chunks=summary.chunk_indexes,
    )
    first = [a.offset for a in summary.attachment_indexes]
    return known, min([*first, begin - END_OF_DATA_SIZE])
