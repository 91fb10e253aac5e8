"""Reads scans and cones out of a recording: all messages of a sensor at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import crowdbot.core.recording.messages as ros
from crowdbot.core.recording.container.records import Record, decode
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.reading.scans import ReplayScan, Thinning
from crowdbot.core.recording.topics import is_cone, is_scan, range_topic, scan_topic
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.errors import UnknownNameError

#: Topic -> sensor, of those to read.
Choice = Callable[[RecordingHeader], Mapping[str, SensorInfo]]
#: Stands for any distance, m.
_ANY = 1.0625


class ScanCollector:
    """Keeps the messages of chosen sensors as they come; decodes them at the end."""

    def __init__(self, path: Path, choose: Choice, max_rate: float | None) -> None:
        self._path, self._choose, self._max_rate = path, choose, max_rate
        self._chosen: Mapping[str, SensorInfo] = {}
        self._thinning: dict[str, Thinning] = {}
        self._found: dict[str, list[Record]] = {}

    def open(self, header: RecordingHeader) -> None:
        """Take the header, which says what sensors there are."""
        self._chosen = self._choose(header)
        self._thinning = {topic: Thinning(self._max_rate) for topic in self._chosen}

    def add(self, record: Record) -> None:
        """Take a message of whatever topic."""
        if record.topic in self._chosen and self._thinning[record.topic].keeps(record.ns):
            self._found.setdefault(record.topic, []).append(record)

    def scans(self) -> list[ReplayScan]:
        """What was kept, in the order in which sensors first came; lidars before cones."""
        scans = [self._scan(topic, records) for topic, records in self._found.items()]
        return sorted(scans, key=lambda scan: scan.cone)

    def _scan(self, topic: str, records: Sequence[Record]) -> ReplayScan:
        info = self._chosen[topic]
        assert info.angles is not None  # by is_scan and is_cone
        return ReplayScan(
            sensor=topic.rpartition("/")[0].removeprefix("/"),
            mount=info.mount,
            tilt=info.tilt,
            angles=info.angles,
            range_max=info.range_max,
            t=np.array([record.ns for record in records]) / 1e9,
            ranges=_ranges(self._path, records, "range" if is_cone(info) else "ranges"),
            cone=is_cone(info),
        )


def lidars(header: RecordingHeader, sensor: str | None = None) -> dict[str, SensorInfo]:
    """Topics of all lidars with plain scans, or of one.

    Raises:
        UnknownNameError: there is no such lidar.
    """
    found = {n: s for n, s in header.sensors.items() if is_scan(s)}
    if sensor is not None and sensor not in found:
        raise UnknownNameError("lidar", sensor, found)
    return {scan_topic(n): s for n, s in found.items() if sensor in (None, n)}


def cones(header: RecordingHeader) -> dict[str, SensorInfo]:
    """Topics of all ultrasound and infrared sensors."""
    return {range_topic(n): s for n, s in header.sensors.items() if is_cone(s)}


def _ranges(path: Path, records: Sequence[Record], field: str) -> Array:
    """(K, R) distances, m.

    Messages of one sensor differ in nothing but stamp and distances: where these are is found in
    the first, and then they are cut out of all at once.
    """
    first = decode(path, records[0])
    start, count = _place(first, field)
    rows = [record.data for record in records]
    if start and all(len(row) == len(rows[0]) and row[:4] == rows[0][:4] for row in rows):
        table = np.frombuffer(b"".join(rows), np.uint8).reshape(len(rows), -1)
        if np.all(table[:, start - 4 : start] == table[0, start - 4 : start]) or field == "range":
            cut = np.ascontiguousarray(table[:, start : start + 4 * count])
            return cut.view("<f4").astype(np.float64)
    ranges = [np.atleast_1d(getattr(decode(path, r), field)) for r in records]
    return np.array(ranges, np.float64)


def _place(message: Any, field: str) -> tuple[int, int]:
    """Where the distances of a message begin (0: nowhere), and how many there are."""
    count = np.size(getattr(message, field))
    mark = np.full(count, _ANY, np.float32)
    setattr(message, field, mark if field == "ranges" else _ANY)
    return max(ros.to_cdr(message).find(mark.tobytes()), 0) if count else 0, count
