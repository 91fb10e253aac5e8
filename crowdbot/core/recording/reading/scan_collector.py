"""Read lidar scans and readings of ultrasound and infrared sensors from a recording."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
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

#: A placeholder for any distance, m.
_ANY = 1.0625


class ScanCollector:
    """Collects range readings, and decodes them on demand."""

    def __init__(self, path: Path, max_rate: float | None) -> None:
        self._path, self._max_rate = path, max_rate
        self._sensors: Mapping[str, SensorInfo] = {}
        self._thinning: dict[str, Thinning] = {}
        self._found: dict[str, list[Record]] = {}

    def open(self, header: RecordingHeader) -> None:
        """Set the sensors from the header."""
        self._sensors = {
            **{scan_topic(n): s for n, s in header.sensors.items() if is_scan(s)},
            **{range_topic(n): s for n, s in header.sensors.items() if is_cone(s)},
        }
        self._thinning = {topic: Thinning(self._max_rate) for topic in self._sensors}

    def wants(self, topic: str) -> bool:
        """Return True if a topic, without the robot's name, is one of a range sensor."""
        return topic in self._sensors

    def add(self, topic: str, record: Record) -> None:
        """Take a record of a topic that it `wants`."""
        if self._thinning[topic].keeps(record.ns):
            self._found.setdefault(topic, []).append(record)

    def scans(self, header: RecordingHeader, sensor: str | None) -> list[ReplayScan]:
        """Return the collected readings: lidars before others, in order of their first reading.

        Raises:
            UnknownNameError: the header names no such sensor.
        """
        if sensor is not None:
            known = [n for n, s in header.sensors.items() if is_scan(s) or is_cone(s)]
            if sensor not in known:
                raise UnknownNameError("sensor of distances", sensor, known)
        scans = [
            self._scan(topic, records)
            for topic, records in self._found.items()
            if sensor in (None, _sensor_of(topic))
        ]
        return sorted(scans, key=lambda scan: scan.cone)

    def _scan(self, topic: str, records: Sequence[Record]) -> ReplayScan:
        info = self._sensors[topic]
        assert info.angles is not None  # by is_scan and is_cone
        return ReplayScan(
            sensor=_sensor_of(topic),
            mount=info.mount,
            tilt=info.tilt,
            angles=info.angles,
            range_max=info.range_max,
            t=np.array([record.ns for record in records]) / 1e9,
            ranges=_ranges(self._path, records, "range" if is_cone(info) else "ranges"),
            cone=is_cone(info),
        )


def _sensor_of(topic: str) -> str:
    """Return the sensor of a topic, which is its root."""
    return topic.rpartition("/")[0].removeprefix("/")


def _ranges(path: Path, records: Sequence[Record], field: str) -> Array:
    """Return (K, R) distances, m.

    Messages of one sensor differ only in stamp and distances: their position is found in the first
    message, and then all are extracted at once.
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
    """Return the position of a message's distances (0: none), and their number."""
    count = np.size(getattr(message, field))
    mark = np.full(count, _ANY, np.float32)
    setattr(message, field, mark if field == "ranges" else _ANY)
    return max(ros.to_cdr(message).find(mark.tobytes()), 0) if count else 0, count
