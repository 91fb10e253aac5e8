"""Records of one robot, or of the parts shared by several, converted to `Trajectories`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

import numpy as np

from crowdbot.core.recording.container.records import Record, decode
from crowdbot.core.recording.header import RecordingHeader, RobotHeader, check_format, with_tilts
from crowdbot.core.recording.motion.states import States, StatesReader, series
from crowdbot.core.recording.person_task import person_task_of
from crowdbot.core.recording.reading.driver_commands import DriverCommands
from crowdbot.core.recording.reading.scan_collector import ScanCollector
from crowdbot.core.recording.reading.scans import ReplayScan
from crowdbot.core.recording.topics import Topic
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError

#: The last two are recorded of a robot that goes sideways.
_ROBOT = ("x", "y", "theta", "v", "w", "vx", "vy")
_CONTACT = ("t0", "t1", "agent", "impulse", "peak_force", "relative_speed", "bearing")


class PlannerDrawing(NamedTuple):
    """A planner's drawing: time (s), rows (K, C) in the robot's base frame, and K texts or none."""

    t: float
    rows: Array
    texts: tuple[str, ...] | None = None


class RobotRecords:
    """Collected records of one robot, decoded on demand.

    Args:
        path: the recording, for messages.
        max_rate: keep at most this many scans of each sensor per second, Hz; None: all.
    """

    #: Topic of the run's own state -> type of its messages.
    TOPICS: ClassVar[Mapping[str, str]] = {
        Topic.HEADER: "crowdbot_msgs/msg/RunHeader",
        Topic.TILTS: "crowdbot_msgs/msg/SensorTilts",
        Topic.PERSON_TASK: "crowdbot_msgs/msg/PersonTask",
        Topic.CANDIDATES: "crowdbot_msgs/msg/VelocityCandidates",
        Topic.PERSON_GOALS: "crowdbot_msgs/msg/PersonGoals",
        Topic.STATE: "crowdbot_msgs/msg/RunStates",
        Topic.TRIP: "crowdbot_msgs/msg/Trip",
        Topic.CONTACTS: "crowdbot_msgs/msg/Contact",
        Topic.SIGNAL: "crowdbot_msgs/msg/Series",
        Topic.PLANNER_TIME: "crowdbot_msgs/msg/Series",
        Topic.TRACKS: "crowdbot_msgs/msg/Drawing",
        Topic.THOUGHTS: "crowdbot_msgs/msg/Drawing",
        Topic.THOUGHT_TEXTS: "crowdbot_msgs/msg/DrawnTexts",
        Topic.END: "crowdbot_msgs/msg/RunEnd",
    }

    def __init__(self, path: Path, max_rate: float | None) -> None:
        self._path = path
        self._records: dict[str, list[Record]] = {topic: [] for topic in self.TOPICS}
        self._scans = ScanCollector(path, max_rate)
        self._driver = DriverCommands(path)
        self._header: RecordingHeader | None = None

    # ---------------------------------------------------------------------- collecting
    def add(self, topic: str, record: Record) -> None:
        """Take a record of one of `TOPICS`."""
        self._records[topic].append(record)

    def add_header(self, topic: str, record: Record) -> None:
        """Add a header record, or one with the tilts of sensors; readings can be decoded after it.

        Raises:
            InputError: it is damaged, or of a format that is not read.
        """
        self.add(topic, record)
        self._header = None
        if self.has_header:
            self._scans.open(self.header)
            self._driver.open(self.header)

    def wants(self, topic: str) -> bool:
        """Return True if a topic holds range readings or commands that are kept."""
        return self._scans.wants(topic) or self._driver.wants(topic)

    def add_reading(self, topic: str, record: Record) -> None:
        """Add a range reading or a command."""
        (self._driver if self._driver.wants(topic) else self._scans).add(topic, record)

    # ------------------------------------------------------------------- what there is
    @property
    def names_header(self) -> bool:
        """Return True if there is a record on the header's topic."""
        return bool(self._records[Topic.HEADER])

    @property
    def has_header(self) -> bool:
        """Return True if the header was written by crowdbot."""
        return any(r.msgtype == self.TOPICS[Topic.HEADER] for r in self._records[Topic.HEADER])

    @property
    def header(self) -> RecordingHeader:
        """Return the constants of the run.

        Raises:
            InputError: there is no header, or it is inconsistent.
        """
        if not self.names_header:
            raise InputError(f"{self._path}: no recording of crowdbot: {Topic.HEADER} is missing")
        if self._header is None:
            header = RecordingHeader.from_message(self._messages(Topic.HEADER)[0])
            for tilts in self._messages(Topic.TILTS):
                header = replace(header, sensors=with_tilts(header.sensors, tilts))
            for task in self._messages(Topic.PERSON_TASK):
                header = replace(header, person=person_task_of(task))
            self._header = header
        return self._header

    @property
    def end(self) -> Any | None:
        """Return the ``crowdbot_msgs/RunEnd``; None for an interrupted run."""
        ends = self._messages(Topic.END)
        return ends[-1] if ends else None

    @property
    def ended(self) -> float | None:
        """Return the time at which the run ended, s; None if it was interrupted."""
        ends = self._records[Topic.END]
        return ends[0].ns / 1e9 if ends else None

    @property
    def complete(self) -> bool:
        """Return True if the run was not interrupted, as far as the recording shows."""
        return all(bool(end.complete) for end in self._messages(Topic.END))

    @property
    def last_sample(self) -> float:
        """Return the time of the last sample, s; 0 without any."""
        states = self._records[Topic.STATE]
        return states[-1].ns / 1e9 if states else 0.0

    def scans(self, sensor: str | None) -> list[ReplayScan]:
        """Return the range readings of one sensor, or of all.

        Raises:
            InputError: there is no header, or a reading is damaged.
            UnknownNameError: there is no such sensor.
        """
        return self._scans.scans(self.header, sensor)

    def drawings(self) -> dict[str, list[PlannerDrawing]]:
        """Return the drawings of the planner by name, in the order of time.

        Raises:
            InputError: a drawing is damaged.
        """
        found: dict[str, list[PlannerDrawing]] = {}
        for topic in (Topic.TRACKS, Topic.THOUGHTS, Topic.THOUGHT_TEXTS):
            records = self._records[topic]
            for record, message in zip(records, self._messages(topic), strict=True):
                drawing = self._drawing(record.ns / 1e9, message)
                found.setdefault(message.name, []).append(drawing)
        return {name: sorted(drawn, key=lambda one: one.t) for name, drawn in found.items()}

    def _drawing(self, t: float, message: Any) -> PlannerDrawing:
        columns, texts = int(message.columns), getattr(message, "texts", None)
        fits = columns >= 1 and not len(message.data) % columns
        if not fits or (texts is not None and len(texts) != len(message.data) // columns):
            raise InputError(f"{self._path}: damaged: a drawing '{message.name:.40}'")
        rows = np.asarray(message.data, np.float64).reshape(-1, columns)
        return PlannerDrawing(t, rows, None if texts is None else tuple(texts))

    @cached_property
    def people(self) -> Trajectories | None:
        """Return the people if they are recorded apart from robots; None without any.

        Raises:
            InputError: as `trajectories`.
        """
        return None if self.header.agents is None else self.trajectories()

    def trajectories(self) -> Trajectories:
        """Return everything as arrays.

        Raises:
            InputError: header or samples are missing or inconsistent.
        """
        header = self.header
        if not self._records[Topic.STATE]:
            raise InputError(f"{self._path}: the recording holds no sample")
        people = 0 if header.agents is None else len(header.agents.id)
        choices = self._messages(Topic.CANDIDATES), self._messages(Topic.PERSON_GOALS)
        samples = self._messages(Topic.STATE)
        try:
            states = StatesReader(people, *choices).states(samples)
            run = Trajectories.from_arrays(
                **self._shared(header, states),
                **self._robot(header, states.robot),
                **self._agents(header, states),
            )
        except (InputError, ValueError) as error:
            raise InputError(f"{self._path}: damaged: {error}") from error
        end = self._records[Topic.STATE][-1].ns
        commands = self._driver.commands(header, end)
        return replace(run, commands=commands, person=header.person)

    # ------------------------------------------------------------------------ decoding
    def _messages(self, topic: str) -> list[Any]:
        """Return the messages of one of `TOPICS`.

        Raises:
            InputError: one is of another type than crowdbot writes there, or damaged.
        """
        return [self._message(self.TOPICS[topic], record) for record in self._records[topic]]

    def _message(self, expected: str, record: Record) -> Any:
        if record.msgtype == self.TOPICS[Topic.HEADER]:
            check_format(self._path, record.data)
        if record.msgtype != expected or record.encoding != "cdr":
            found = record.msgtype or "a message without schema"
            raise InputError(
                f"{self._path}: {record.topic} holds {found} "
                f"({record.encoding or 'no encoding'}), not {expected} (cdr)"
            )
        return decode(self._path, record)

    def _shared(self, header: RecordingHeader, states: States) -> dict[str, Any]:
        times = series(self._messages(Topic.PLANNER_TIME))
        return {
            "t": states.t,
            "goal_zone": header.goal_zone,
            "walls": header.walls,
            "planner_step_time": next((rows[:, 1] for rows in times.values()), None),
            "signals": series(self._messages(Topic.SIGNAL)),
        }

    def _robot(self, header: RecordingHeader, rows: Array) -> dict[str, Any]:
        robot = header.robot
        if robot is None:
            return {}
        names = _ROBOT if rows.shape[1] == len(_ROBOT) else _ROBOT[:5]
        if rows.shape[1] != len(names):
            raise InputError(f"a sample of the robot does not have {len(names)} numbers")
        ends = self._messages(Topic.END)
        return {
            **{f"robot_{name}": column for name, column in zip(names, rows.T, strict=True)},
            "robot_radius": robot.radius,
            "robot_mass": robot.mass,
            "robot_goal_time": ends[0].goal_time if ends and ends[0].arrived else None,
            "robot_goal": robot.goal,
            "robot_goal_radius": robot.goal_radius,
            "robot_speed_limit": _fastest(robot),
            "robot_footprint": robot.footprint,
            "contacts": _columns(self._messages(Topic.CONTACTS), _CONTACT),
        }

    def _agents(self, header: RecordingHeader, states: States) -> dict[str, Any]:
        agents = header.agents
        if agents is None:
            return {}
        names = ("agent_x", "agent_y", "agent_vx", "agent_vy")
        trips = _columns(self._messages(Topic.TRIP), ("agent", "t0", "t1", "reached"))
        return {
            **{name: states.agents[:, i] for i, name in enumerate(names)},
            "agent_id": agents.id,
            "agent_radius": agents.radius,
            "agent_mass": agents.mass,
            "agent_jump": states.jump[1:] if states.has_jump.any() else None,
            **{f"trip_{name}": column for name, column in trips.items()},
        }


def _fastest(robot: RobotHeader) -> float | None:
    """Return the top speed in any direction, m/s; None if not recorded or not positive."""
    if robot.limits is None:
        return None
    fastest = math.hypot(robot.limits.v_max, robot.limits.vy_max)
    return fastest if fastest > 0.0 else None


def _columns(rows: list[Any], names: tuple[str, ...]) -> dict[str, list[Any]]:
    return {name: [getattr(row, name) for row in rows] for name in names}
