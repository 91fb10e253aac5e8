"""Recording: one object for everything in a recording, which is opened and read once."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Generator
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from types import TracebackType
from typing import Self

from crowdbot.core.recording.container.records import Record, Records
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.reading.one_robot import PlannerDrawing, RobotRecords
from crowdbot.core.recording.reading.people_of_fleet import among
from crowdbot.core.recording.reading.scans import ReplayScan
from crowdbot.core.recording.topics import Topic
from crowdbot.core.support.arguments import path_of
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.errors import InputError, UnknownNameError


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingInfo:
    """The contents of a recording.

    Attributes:
        complete: True if the run is complete and the file has its footer.
        status: why the run ended; empty if unknown.
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


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotRecording:
    """Recorded data of one robot and the people near it, or of people without a robot.

    Attributes:
        header: names the scenario, and has the hashes of run and planner.
        run: until the robot ended, with the people whom it met.
        complete: the run came to its end and the file has its footer.
        until: time of the last sample, s.
    """

    header: RecordingHeader
    run: Trajectories
    complete: bool
    until: float


class Recording:
    """A recording of one robot, of several, or of people alone.

    The file is read once, front to back, and only as far as needed: the header comes first, other
    data need the whole file. Of an interrupted run the data until the interruption are returned.

    Args:
        path: a file that crowdbot recorded.
        max_rate: keep at most this many scans of each sensor per second, Hz; None: all.
        observe: is given each record that is not part of the run's own state, such as images.

    Raises:
        InputError: from any method: not an MCAP file, not a recording of crowdbot, damaged, or too
            large when decompressed.
    """

    def __init__(
        self,
        path: Path | str,
        *,
        max_rate: float | None = None,
        observe: Callable[[Record], None] | None = None,
    ) -> None:
        self.path = path_of("path", path)
        self._records = Records(self.path)
        self._cursor: Generator[Record, None, None] | None = iter(self._records)
        self._failure: InputError | None = None
        self._max_rate, self._observe = max_rate, observe
        self._by_prefix: dict[str, RobotRecords] = {}  # "/NAME", or "" on the first level
        self._takers: dict[str, Callable[[Record], None] | None] = {}  # by topic
        self._counts: Counter[str] = Counter()
        self._types: dict[str, str] = {}  # ROS type of each topic
        self._first: str | None = None  # topic of the first message
        self._sampled = False  # a sample was seen, after which no header comes
        self._robots: dict[str | None, RobotRecording] = {}

    def __reduce__(self) -> tuple[Callable[[Path], Recording], tuple[Path]]:
        """Return pickling data, with which another process opens and reads the file itself."""
        return partial(Recording, max_rate=self._max_rate, observe=self._observe), (self.path,)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the file; data that were read stay available."""
        if self._cursor is not None:
            self._cursor.close()
            self._cursor = None
            self._failure = self._failure or InputError(f"{self.path}: closed before it was read")
        # Bound methods of this object: a cycle that only the garbage collector would free.
        self._takers.clear()

    # ------------------------------------------------------------------------ questions
    @property
    def holds_run(self) -> bool:
        """Return True if the file has a header written by crowdbot, for any robot."""
        while not self._has_header() and self._advance():
            pass
        return self._has_header()

    @property
    def robots(self) -> tuple[str, ...]:
        """Return the names of the robots if there are several, else an empty tuple."""
        self._read_headers()
        names = [
            n.removeprefix("/") for n, part in self._by_prefix.items() if n and part.has_header
        ]
        return tuple(names) if len(names) > 1 else ()

    @property
    def header(self) -> RecordingHeader:
        """Return the constants of the run; with several robots, the shared ones."""
        if self._first is None:
            self._advance()
        if self._first != Topic.HEADER:
            raise InputError(
                f"{self.path}: no recording of crowdbot: it does not begin with {Topic.HEADER}"
            )
        self._read_headers()
        return self._by_prefix[""].header

    @cached_property
    def info(self) -> RecordingInfo:
        """Return a summary of the contents of the file, complete or not."""
        header, shared = self.header, self._by_prefix[""]
        self._drain()
        end = shared.end
        return RecordingInfo(
            header=header,
            complete=self._records.finished and end is not None and bool(end.complete),
            status="" if end is None else end.status,
            goal_time=end.goal_time if end is not None and end.arrived else None,
            duration=shared.last_sample,
            topics={topic: (self._types[topic], n) for topic, n in sorted(self._counts.items())},
        )

    def robot(self, name: str | None = None) -> RobotRecording:
        """Return the recorded data of one robot, with the people whom it met.

        Args:
            name: which; needed only where there are several.

        Raises:
            InputError: there is no sample, or there are several robots and none is named.
            UnknownNameError: there is no such robot.
        """
        if name not in self._robots:
            self._robots[name] = self._assembled(name)
        return self._robots[name]

    def trajectories(self, robot: str | None = None) -> Trajectories:
        """Return the recorded arrays, bit by bit; arguments and errors as `robot`.

        ``trips`` is a table, perhaps empty, where there were people; ``contacts`` where there was a
        robot. ``signals[name]`` is (K, 2): time and value. ``planner_step_time`` is None unless
        some was recorded.
        """
        return self.robot(robot).run

    def scans(self, sensor: str | None = None, robot: str | None = None) -> list[ReplayScan]:
        """Return range readings: those of lidars, then those of ultrasound and infrared sensors.

        Args:
            sensor: name of one; None: all that recorded some.
            robot: whose; needed only where there are several.

        Raises:
            InputError: there are several robots and none is named.
            UnknownNameError: there is no such sensor or robot.
        """
        self._drain()
        return self._chosen(robot)[0].scans(sensor)

    def drawings(self, robot: str | None = None) -> dict[str, list[PlannerDrawing]]:
        """Return the drawings of the planner by name, such as its ``tracks`` of people.

        Args:
            robot: whose; needed only where there are several.

        Raises:
            InputError: a drawing is damaged, or there are several robots and none is named.
        """
        self._drain()
        return self._chosen(robot)[0].drawings()

    # -------------------------------------------------------------------------- reading
    def _has_header(self) -> bool:
        return any(part.has_header for part in self._by_prefix.values())

    def _read_headers(self) -> None:
        while not self._sampled and self._advance():
            pass

    def _drain(self) -> None:
        """Read all that is left, without a call for each message."""
        if self._cursor is None or self._first is None:
            self._advance()
        if self._cursor is None:
            return
        counts, takers = self._counts, self._takers
        try:
            for record in self._cursor:
                topic = record.topic
                counts[topic] += 1
                take = takers[topic] if topic in takers else self._learned(record)
                if take is not None:
                    take(record)
        except InputError as error:
            self._failure = error
            raise
        self._cursor = None

    def _learned(self, record: Record) -> Callable[[Record], None] | None:
        """Return the function that takes the records of a topic, found at its first record."""
        topic = record.topic
        self._types[topic] = record.msgtype
        self._takers[topic] = self._taker(topic)
        return self._takers[topic]

    def _advance(self) -> bool:
        """Read one message; False at the end of the file.

        Raises:
            InputError: the file is damaged, or was closed; the same each time.
        """
        if self._failure is not None:
            raise self._failure
        if self._cursor is None:
            return False
        try:
            record = next(self._cursor, None)
            if record is not None:
                self._take(record)
        except InputError as error:
            self._failure = error
            raise
        if record is None:
            self._cursor = None
        return record is not None

    def _take(self, record: Record) -> None:
        topic = record.topic
        self._counts[topic] += 1
        take = self._takers[topic] if topic in self._takers else self._learned(record)
        if take is not None:
            take(record)
        if self._first is None:
            self._first = topic

    def _taker(self, topic: str) -> Callable[[Record], None] | None:
        """Return the function that takes the records of a topic; None: nothing does."""
        for known in RobotRecords.TOPICS:
            if topic.endswith(known):
                prefix = topic.removesuffix(known)
                part = self._by_prefix.setdefault(prefix, RobotRecords(self.path, self._max_rate))
                if known in (Topic.HEADER, Topic.TILTS, Topic.PERSON_TASK):
                    return partial(self._take_header, part, known)
                take = partial(part.add, known)
                return partial(self._take_sample, take) if known == Topic.STATE else take
        for prefix, part in self._by_prefix.items():
            if topic.startswith(prefix) and part.wants(topic.removeprefix(prefix)):
                return partial(part.add_reading, topic.removeprefix(prefix))
        return self._observe

    def _take_header(self, part: RobotRecords, topic: str, record: Record) -> None:
        part.add_header(topic, record)
        self._takers.clear()  # it may name sensors whose topics nothing took before

    def _take_sample(self, take: Callable[[Record], None], record: Record) -> None:
        take(record)
        self._sampled = True

    # ------------------------------------------------------------------- whose records
    def _assembled(self, name: str | None) -> RobotRecording:
        self._drain()
        part, people = self._chosen(name)
        run = part.trajectories()
        if people is not None:
            run = among(run, people, float(run.t[-1]) if part.ended is None else part.ended)
        ended = people is None or part.ended is not None
        return RobotRecording(
            header=part.header,
            run=run,
            complete=self._records.finished and part.complete and ended,
            until=float(run.t[-1]),
        )

    def _chosen(self, name: str | None) -> tuple[RobotRecords, Trajectories | None]:
        """Return the records of one robot, and those of people that are recorded separately."""
        robots = {
            prefix.removeprefix("/"): part
            for prefix, part in self._by_prefix.items()
            if part.names_header
        }
        shared = robots.get("") if len(robots) > 1 else None
        if shared is not None and shared.header.robot is not None:
            shared = None
        if shared is not None:
            del robots[""]
        if name is not None:
            chosen = robots.get(name.strip("/"))
            if chosen is None:
                raise UnknownNameError("robot", name, filter(None, robots))
        elif len(robots) > 1 and "" not in robots:
            raise InputError(
                f"{self.path}: the recording holds several robots: {', '.join(sorted(robots))}; "
                "name one, with --robot on the command line"
            )
        else:
            first = next(iter(robots.values()), RobotRecords(self.path, None))
            chosen = robots.get("", first)
        return chosen, None if shared is None else shared.people
