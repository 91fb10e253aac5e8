"""Reads a recording back: trajectories bit by bit, scans, and what is in the file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from crowdbot.core.recording.container.records import Record, Records, decode
from crowdbot.core.recording.header import RecordingHeader, with_tilts
from crowdbot.core.recording.reading.assemble import Collected
from crowdbot.core.recording.reading.people_of_fleet import among
from crowdbot.core.recording.reading.scan_collector import Choice, ScanCollector, cones, lidars
from crowdbot.core.recording.reading.scans import ReplayScan
from crowdbot.core.recording.topics import Topic
from crowdbot.core.trajectories.trajectories import Trajectories
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
    return read_whole(path, robot).run


@dataclass(frozen=True, slots=True, kw_only=True)
class WholeRecording:
    """Everything in a run's own recording that says what happened, and whose it is.

    Attributes:
        header: names the scenario, and has the hashes of run and planner.
        complete: the run came to its end and the file has its footer.
        until: time of the last sample, s.
    """

    header: RecordingHeader
    run: Trajectories
    complete: bool
    until: float


def read_whole(path: Path, robot: str | None = None) -> WholeRecording:
    """Trajectories together with header and end; arguments and errors as `read_trajectories`."""
    collected, records = Collected(), Records(path)
    mine, people = _of_robot(path, robot, records)
    for topic, record in mine:
        collected.add_record(path, record._replace(topic=topic))
    run = collected.trajectories(path)
    if people is not None:
        ends = [record.ns / 1e9 for topic, record in mine if topic == Topic.END]
        run = among(run, people, ends[0] if ends else float(run.t[-1]))
    return WholeRecording(
        header=collected.header(path),
        run=run,
        complete=records.finished and collected.complete,
        until=float(run.t[-1]),
    )


def read_run(
    path: Path, max_rate: float, also: Callable[[Record], None] | None = None
) -> tuple[Trajectories, list[ReplayScan]]:
    """Trajectories and what sensors of distances saw, in one pass over a run's own recording.

    Args:
        path: a recording of one robot.
        max_rate: leave out scans so that at most this many per second remain, Hz.
        also: is given each record but those of the trajectories.

    Raises:
        InputError: as `read_trajectories`.
    """
    collected = Collected()
    scans = ScanCollector(path, lambda header: {**lidars(header), **cones(header)}, max_rate)
    for record in Records(path):
        if record.topic not in Collected.TOPICS:
            scans.add(record)
            if also is not None:
                also(record)
            continue
        collected.add_record(path, record)
        if record.topic in (Topic.HEADER, Topic.TILTS):
            scans.open(collected.header(path))
    return collected.trajectories(path), scans.scans()


def holds_run(path: Path) -> bool:
    """Whether a file has a header of crowdbot, for one robot or another.

    Raises:
        InputError: not an MCAP file, or damaged.
    """
    return any(
        record.topic.endswith(Topic.HEADER) and record.msgtype in Collected.TOPICS[Topic.HEADER]
        for record in Records(path)
    )


def _of_robot(
    path: Path, robot: str | None, records: Records | None = None
) -> tuple[list[tuple[str, Record]], Trajectories | None]:
    """Scoring topic and message of one robot, and the people where they are recorded apart.

    Of other topics only the names are looked at.
    """
    by_prefix: dict[str, list[tuple[str, Record]]] = {}
    for record in records or Records(path):
        for topic in Collected.TOPICS:
            if record.topic.endswith(topic):
                prefix = record.topic.removesuffix(topic)
                by_prefix.setdefault(prefix, []).append((topic, record))
    robots = {
        prefix.removeprefix("/"): messages
        for prefix, messages in by_prefix.items()
        if any(topic == Topic.HEADER for topic, _ in messages)
    }
    shared = _shared(path, robots)
    if shared is not None:
        del robots[""]
    if robot is not None:
        if robot.strip("/") not in robots:
            raise UnknownNameError("robot", robot, filter(None, robots))
        name = robot.strip("/")
        return robots[name], shared.people(path) if shared is not None and name else None
    if len(robots) > 1 and "" not in robots:
        raise InputError(
            f"{path}: the recording holds several robots: {', '.join(sorted(robots))}; name one, "
            "with --robot on the command line"
        )
    mine = robots.get("") or next(iter(robots.values()), [])
    return mine, None if shared is None else shared.people(path)


def _shared(path: Path, robots: Mapping[str, list[tuple[str, Record]]]) -> Collected | None:
    """What is recorded for all robots together, beside them; None where there is no such thing."""
    if len(robots) < 2 or "" not in robots:
        return None
    collected = Collected()
    for topic, record in robots[""]:
        collected.add_record(path, record._replace(topic=topic))
    return collected if collected.header(path).robot is None else None


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
    return _scans(path, lambda header: lidars(header, sensor), max_rate)


def read_cones(path: Path, max_rate: float | None = None) -> list[ReplayScan]:
    """The readings of all ultrasound and infrared sensors; arguments as for `read_scans`.

    Raises:
        InputError: no recording of crowdbot.
    """
    return _scans(path, cones, max_rate)


def _scans(path: Path, choose: Choice, max_rate: float | None) -> list[ReplayScan]:
    """What was recorded on the topics that ``choose`` finds."""
    collector, header = ScanCollector(path, choose, max_rate), RecordingHeader(scenario="")
    for record in _with_header(path):
        if record.topic == Topic.HEADER:
            header = _header(path, record)
            collector.open(header)
        elif record.topic == Topic.TILTS:
            collector.open(_tilted(path, header, record))
        else:
            collector.add(record)
    return collector.scans()


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
        elif record.topic == Topic.TILTS and header is not None:
            header = _tilted(path, header, record)
        elif record.topic == Topic.STATE:
            last = record.ns
        elif record.topic == Topic.END:
            end = decode(path, record)
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


def _tilted(path: Path, header: RecordingHeader, record: Record) -> RecordingHeader:
    """The header with what the tilts of sensors are."""
    return replace(header, sensors=with_tilts(header.sensors, decode(path, record)))


def _header(path: Path, record: Record) -> RecordingHeader:
    return RecordingHeader.from_message(decode(path, record))
