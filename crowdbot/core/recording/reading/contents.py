"""Contents of any MCAP file: topics with counts, rates and sizes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from crowdbot.core.recording.container.records import Record, Records, decode
from crowdbot.core.recording.topics import Topic

#: Status of a recovered recording.
RECOVERED = "recovered"


@dataclass(slots=True)
class TopicContents:
    """One topic.

    Attributes:
        size: bytes of its messages, before compression.
        first, last: log times of its first and last message, s.
    """

    name: str
    msgtype: str
    count: int = 0
    size: int = 0
    first: float = 0.0
    last: float = 0.0

    @property
    def rate(self) -> float | None:
        """Return messages per second; None for fewer than two."""
        span = self.last - self.first
        return (self.count - 1) / span if self.count > 1 and span > 0.0 else None


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingContents:
    """A whole file.

    Attributes:
        finished: the file has its end; an interrupted one has not.
        complete: the run itself came to its end, too.
        status: reason for the end of the run, or ``recovered``; empty if unknown.
        is_run: True if crowdbot recorded it.
        end: time of the last message, s.
        size: size of the file, bytes.
        attachments: name -> bytes of the files inside.
    """

    topics: tuple[TopicContents, ...]
    finished: bool
    complete: bool
    status: str
    is_run: bool
    end: float
    size: int
    attachments: Mapping[str, int]


def contents(path: Path) -> RecordingContents:
    """Read the contents of a file.

    Raises:
        InputError: not an MCAP file, damaged, or too large when decompressed.
    """
    topics: dict[tuple[str, str], TopicContents] = {}
    end: Any = None
    last = 0.0
    is_run = False
    records = Records(path)
    for record in records:
        _count(topics, record)
        last = max(last, record.ns / 1e9)
        is_run = is_run or record.topic.endswith(Topic.HEADER)
        if record.topic.endswith(Topic.END):
            end = decode(path, record)
    return RecordingContents(
        topics=tuple(topics[key] for key in sorted(topics)),
        finished=records.finished,
        complete=records.finished and bool(getattr(end, "complete", not is_run)),
        status=str(getattr(end, "status", "")),
        is_run=is_run,
        end=last,
        size=path.stat().st_size,
        attachments=records.attachments,
    )


def _count(topics: dict[tuple[str, str], TopicContents], record: Record) -> None:
    key, t = (record.topic, record.msgtype), record.ns / 1e9
    topic = topics.get(key)
    if topic is None:
        topic = topics[key] = TopicContents(record.topic, record.msgtype, first=t, last=t)
    topic.count += 1
    topic.size += len(record.data)
    topic.first, topic.last = min(topic.first, t), max(topic.last, t)
