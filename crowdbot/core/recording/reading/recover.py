"""Make a complete file of a truncated recording."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import crowdbot.core.recording.messages as ros
from crowdbot.core.recording.container.mcap_file import McapFile
from crowdbot.core.recording.container.records import Record, Records
from crowdbot.core.recording.reading.contents import RECOVERED
from crowdbot.core.recording.topics import Topic
from crowdbot.core.support.atomic_write import atomic_path
from crowdbot.errors import InputError


@dataclass(frozen=True, slots=True)
class Recovered:
    """The result: number of recovered messages, and time of the last one, s."""

    messages: int
    end: float


def recover(path: Path, out: Path) -> Recovered:
    """Copy all whole chunks of a file to a complete file.

    A run without an end gets the status ``recovered``, marked as incomplete.

    Args:
        path: an interrupted recording.
        out: the file to write, atomically.

    Raises:
        InputError: the recording is complete, empty, or damaged in the middle.
    """
    records = Records(path)
    count, last, ended, is_run = 0, 0, False, False
    with atomic_path(out) as part:
        file = McapFile(part)
        try:
            for record in _all(path, records):
                channel = records.channel(record.topic)
                file.copy(channel.record, channel.schema, record.ns, record.data)
                count, last = count + 1, max(last, record.ns)
                is_run = is_run or record.topic == Topic.HEADER
                ended = ended or record.topic == Topic.END
            if is_run and not ended:
                file.put(Topic.END, last, _end(), latched=True)
        finally:
            file.close()
    return Recovered(count, last / 1e9)


def _all(path: Path, records: Records) -> Iterator[Record]:
    found = False
    for record in records:
        found = True
        yield record
    if records.finished:
        raise InputError(f"{path}: the recording is complete; there is nothing to recover")
    if not found:
        raise InputError(f"{path}: not a single whole chunk can be read")


def _end() -> object:
    return ros.new(
        "crowdbot_msgs/RunEnd", complete=False, status=RECOVERED, arrived=False, goal_time=0.0
    )
