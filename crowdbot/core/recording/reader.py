"""Reads a recording back: trajectories bit by bit, scans, and what is in the file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from crowdbot.core.interfaces import SensorInfo
from crowdbot.core.recording import messages as ros
from crowdbot.core.recording.assemble import Collected
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.records import Record, Records
from crowdbot.core.recording.topics import Topic, is_cone, is_scan, range_topic, scan_topic
from crowdbot.core.replay.scan import ReplayScan
from crowdbot.core.trajectory import Trajectories
from crowdbot.errors import InputError, UnknownNameError


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingInfo:
    """What is in a recording.

    Attributes:
        complete: the run came to its end and the file has its footer.
        status: why the run ended; empty where the recording does not say.
        goal_time: arrival, s, or None.
        duration: time of the last sample, s.
        topics: topic -> (message type, number of messages), sorted.
    """

    header: RecordingHeader
    complete: bool
    status: str
    goal_time: float | None
    duration: float
    topics: dict[str, tuple[str, int]]


def read_trajectories(path: Path, robot: str | None = None) -> Trajectories:
    """The arrays that were written, bit by bit; of an interrupted run as far as it came.

    ``trips`` is a table, perhaps empty, where there were people; ``contacts`` where there was a
    robot. ``signals[name]`` is (K, 2): time and value. ``planner_step_time`` is None unless some
    was recorded.

    Args:
        path: a recording.
        robot: whose topics, where each robot has its own below ``/NAME``; needed only where
            there are several.

    Raises:
        InputError: no recording of crowdbot, damaged, or without a single sample.
        UnknownNameError: there is no such robot.
    """
    collected = Collected()
    for topic, record in _of_robot(path, robot):
        _check_type(path, record, Collected.TOPICS[topic])
        collected.add(topic, _decode(path, record))
    return collected.trajectories(path)


def holds_run(path: Path) -> bool:
    """Whether a file has a header of crowdbot, for one robot or another.

    Raises:
        InputError: no MCAP file, or damaged.
    """
    return any(
        record.topic.endswith(Topic.HEADER) and record.msgtype == Collected.TOPICS[Topic.HEADER]
        for record in Records(path)
    )


def _of_robot(path: Path, robot: str | None) -> list[tuple[str, Record]]:
    """Scoring topic and message of one robot; of other topics only the names are looked at."""
    by_prefix: dict[str, list[tuple[str, Record]]] = {}
    for record in Records(path):
        for topic in Collected.TOPICS:
            if record.topic.endswith(topic):
                prefix = record.topic.removesuffix(topic)
                by_prefix.setdefault(prefix, []).append((topic, record))
    robots = {
        prefix.removeprefix("/"): messages
        for prefix, messages in by_prefix.items()
        if any(topic == Topic.HEADER for topic, _ in messages)
    }
    if robot is not None:
        if robot.strip("/") not in robots:
            raise UnknownNameError("robot", robot, filter(None, robots))
        return robots[robot.strip("/")]
    if len(robots) > 1 and "" not in robots:
        raise InputError(
            f"{path}: the recording holds several robots: {', '.join(sorted(robots))}; name one"
        )
    return robots.get("") or next(iter(robots.values()), [])


def _check_type(path: Path, record: Record, expected: str) -> None:
    if (record.msgtype, record.encoding) != (expected, "cdr"):
        found = record.msgtype or "a message without schema"
        raise InputError(
            f"{path}: {record.topic} holds {found} ({record.encoding or 'no encoding'}), "
            f"not {expected} (cdr)"
        )


def read_scans(
    path: Path, sensor: str | None = None, max_rate: float | None = None
) -> list[ReplayScan]:
    """The scans of one lidar, or of all.

    Args:
        path: a recording.
        sensor: name of a lidar; default: all that recorded scans.
        max_rate: leave out scans so that at most this many per second remain, Hz.

    Raises:
        InputError: no recording of crowdbot.
        UnknownNameError: there is no such lidar.
    """
    return _scans(path, lambda header: _lidars(header, sensor), max_rate)


def read_cones(path: Path, max_rate: float | None = None) -> list[ReplayScan]:
    """The readings of all ultrasound and infrared sensors; arguments as for `read_scans`.

    Raises:
        InputError: no recording of crowdbot.
    """
    return _scans(path, _cones, max_rate)


def _scans(
    path: Path,
    choose: Callable[[RecordingHeader], dict[str, SensorInfo]],
    max_rate: float | None,
) -> list[ReplayScan]:
    """What was recorded on the topics that ``choose`` finds."""
    chosen: dict[str, SensorInfo] = {}
    found: dict[str, list[tuple[float, Any]]] = {}
    gap = 0 if max_rate is None else round(1e9 / max_rate)
    due: Counter[str] = Counter()
    for record in _with_header(path):
        if record.topic == Topic.HEADER:
            chosen = choose(_header(path, record))
        elif record.topic in chosen and record.ns >= due[record.topic]:
            due[record.topic] = record.ns - (record.ns % gap if gap else 0) + gap
            message = _decode(path, record)
            ranges = [message.range] if is_cone(chosen[record.topic]) else message.ranges
            found.setdefault(record.topic, []).append((record.ns / 1e9, ranges))
    return [_scan(topic, chosen[topic], rows) for topic, rows in found.items()]


def recording_info(path: Path) -> RecordingInfo:
    """What is in a file, complete or not.

    Raises:
        InputError: no recording of crowdbot, or damaged.
    """
    header, end, last = None, None, 0
    counts: Counter[tuple[str, str]] = Counter()
    records = Records(path)
    for record in _with_header(path, records):
        counts[record.topic, record.msgtype] += 1
        if record.topic == Topic.HEADER:
            header = _header(path, record)
        elif record.topic == Topic.STATE:
            last = record.ns
        elif record.topic == Topic.END:
            end = _decode(path, record)
    assert header is not None  # by _with_header
    return RecordingInfo(
        header=header,
        complete=records.finished and end is not None and end.complete,
        status="" if end is None else end.status,
        goal_time=end.goal_time if end is not None and end.arrived else None,
        duration=last / 1e9,
        topics={topic: (kind, n) for (topic, kind), n in sorted(counts.items())},
    )


def _with_header(path: Path, records: Records | None = None) -> Iterator[Record]:
    """All records, the first of which is the header."""
    first = True
    for record in records or Records(path):
        if first and record.topic != Topic.HEADER:
            break
        first = False
        yield record
    else:
        if not first:
            return
    raise InputError(f"{path}: no recording of crowdbot: it does not begin with {Topic.HEADER}")


def _header(path: Path, record: Record) -> RecordingHeader:
    return RecordingHeader.from_message(_decode(path, record))


def _decode(path: Path, record: Record) -> Any:
    try:
        return ros.from_cdr(record.data, record.msgtype)
    except Exception as error:  # the decoder is generated code; anything may surface
        raise InputError(
            f"{path}: {record.topic}: a {record.msgtype} that cannot be decoded"
        ) from error


def _lidars(header: RecordingHeader, sensor: str | None) -> dict[str, SensorInfo]:
    lidars = {n: s for n, s in header.sensors.items() if is_scan(s)}
    if sensor is not None and sensor not in lidars:
        raise UnknownNameError("lidar", sensor, lidars)
    return {scan_topic(n): s for n, s in lidars.items() if sensor in (None, n)}


def _cones(header: RecordingHeader) -> dict[str, SensorInfo]:
    return {range_topic(n): s for n, s in header.sensors.items() if is_cone(s)}


def _scan(topic: str, info: SensorInfo, rows: list[tuple[float, Any]]) -> ReplayScan:
    assert info.angles is not None  # by is_scan and is_cone
    return ReplayScan(
        sensor=topic.rpartition("/")[0].removeprefix("/"),
        mount=info.mount,
        angles=info.angles,
        range_max=info.range_max,
        t=np.array([t for t, _ in rows]),
        ranges=np.array([r for _, r in rows], np.float64),
        cone=is_cone(info),
    )
