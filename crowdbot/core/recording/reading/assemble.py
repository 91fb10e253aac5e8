"""Puts the scoring topics of a recording together into `Trajectories`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar

from crowdbot.core.recording.container.records import Record, decode
from crowdbot.core.recording.header import RecordingHeader, RobotHeader, with_tilts
from crowdbot.core.recording.motion.states import States, StatesReader, series
from crowdbot.core.recording.topics import Topic
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array
from crowdbot.errors import InputError

#: The last two are recorded of a robot that goes sideways.
_ROBOT = ("x", "y", "theta", "v", "w", "vx", "vy")
_CONTACT = ("t0", "t1", "agent", "impulse", "peak_force", "relative_speed")


class Collected:
    """Messages of the scoring topics, in the order they came."""

    #: Topic -> message types, newest format first.
    TOPICS: ClassVar[Mapping[str, tuple[str, ...]]] = {
        Topic.HEADER: ("crowdbot_msgs/msg/RunHeader",),
        Topic.TILTS: ("crowdbot_msgs/msg/SensorTilts",),
        Topic.CANDIDATES: ("crowdbot_msgs/msg/VelocityCandidates",),
        Topic.PERSON_GOALS: ("crowdbot_msgs/msg/PersonGoals",),
        Topic.STATE: ("crowdbot_msgs/msg/RunStates", "crowdbot_msgs/msg/RunState"),
        Topic.TRIP: ("crowdbot_msgs/msg/Trip",),
        Topic.CONTACTS: ("crowdbot_msgs/msg/Contact",),
        Topic.SIGNAL: ("crowdbot_msgs/msg/Series", "crowdbot_msgs/msg/Signal"),
        Topic.PLANNER_TIME: ("crowdbot_msgs/msg/Series", "crowdbot_msgs/msg/Signal"),
        Topic.END: ("crowdbot_msgs/msg/RunEnd",),
    }

    def __init__(self) -> None:
        self._by_topic: dict[str, list[Any]] = {t: [] for t in self.TOPICS}

    def add(self, topic: str, message: Any) -> None:
        """Take one message of one of `TOPICS`."""
        self._by_topic[topic].append(message)

    def add_record(self, path: Path, record: Record) -> None:
        """Take one message that has not been decoded yet, on one of `TOPICS`.

        Raises:
            InputError: it is of another type than crowdbot writes there, or damaged.
        """
        expected = self.TOPICS[record.topic]
        if record.msgtype not in expected or record.encoding != "cdr":
            found = record.msgtype or "a message without schema"
            raise InputError(
                f"{path}: {record.topic} holds {found} ({record.encoding or 'no encoding'}), "
                f"not {expected[0]} (cdr)"
            )
        self.add(record.topic, decode(path, record))

    def people(self, path: Path) -> Trajectories | None:
        """The people of a recording that holds them apart from its robots; None without any.

        Raises:
            InputError: as `trajectories`.
        """
        if not self._by_topic[Topic.HEADER] or self.header(path).agents is None:
            return None
        return self.trajectories(path)

    @property
    def complete(self) -> bool:
        """Whether the run came to its end, or, in recordings of others, does not say so."""
        return all(bool(end.complete) for end in self._by_topic[Topic.END])

    def header(self, path: Path) -> RecordingHeader:
        """The constants of the run.

        Raises:
            InputError: there is no header, or it contradicts itself.
        """
        if not self._by_topic[Topic.HEADER]:
            raise InputError(f"{path}: no recording of crowdbot: {Topic.HEADER} is missing")
        header = RecordingHeader.from_message(self._by_topic[Topic.HEADER][0])
        for tilts in self._by_topic[Topic.TILTS]:
            header = replace(header, sensors=with_tilts(header.sensors, tilts))
        return header

    def trajectories(self, path: Path) -> Trajectories:
        """All of it as arrays.

        Raises:
            InputError: header or samples are missing, or do not fit each other.
        """
        header = self.header(path)
        if not self._by_topic[Topic.STATE]:
            raise InputError(f"{path}: the recording holds no sample")
        try:
            people = 0 if header.agents is None else len(header.agents.id)
            by_topic = self._by_topic
            reader = StatesReader(people, by_topic[Topic.CANDIDATES], by_topic[Topic.PERSON_GOALS])
            states = reader.states(by_topic[Topic.STATE])
            return Trajectories.from_arrays(
                **self._shared(header, states),
                **self._robot(header, states.robot),
                **self._agents(header, states),
            )
        except (InputError, ValueError) as error:
            raise InputError(f"{path}: damaged: {error}") from error

    def _shared(self, header: RecordingHeader, states: States) -> dict[str, Any]:
        times = series(self._by_topic[Topic.PLANNER_TIME])
        return {
            "t": states.t,
            "goal_zone": header.goal_zone,
            "walls": header.walls,
            "planner_step_time": next((rows[:, 1] for rows in times.values()), None),
            "signals": series(self._by_topic[Topic.SIGNAL]),
        }

    def _robot(self, header: RecordingHeader, rows: Array) -> dict[str, Any]:
        robot = header.robot
        if robot is None:
            return {}
        names = _ROBOT if rows.shape[1] == len(_ROBOT) else _ROBOT[:5]
        if rows.shape[1] != len(names):
            raise InputError(f"a sample of the robot does not have {len(names)} numbers")
        ends = self._by_topic[Topic.END]
        return {
            **{f"robot_{name}": column for name, column in zip(names, rows.T, strict=True)},
            "robot_radius": robot.radius,
            "robot_mass": robot.mass,
            "robot_goal_time": ends[0].goal_time if ends and ends[0].arrived else None,
            "robot_goal": robot.goal,
            "robot_goal_radius": robot.goal_radius,
            "robot_speed_limit": _fastest(robot),
            "robot_footprint": robot.footprint,
            "contacts": self._contacts(),
        }

    def _contacts(self) -> dict[str, list[Any]]:
        rows = self._by_topic[Topic.CONTACTS]
        bearing = [getattr(row, "bearing", math.nan) for row in rows]  # since format 2
        return {**_columns(rows, _CONTACT), "bearing": bearing}

    def _agents(self, header: RecordingHeader, states: States) -> dict[str, Any]:
        agents = header.agents
        if agents is None:
            return {}
        names = ("agent_x", "agent_y", "agent_vx", "agent_vy")
        trips = _columns(self._by_topic[Topic.TRIP], ("agent", "t0", "t1", "reached"))
        return {
            **{name: states.agents[:, i] for i, name in enumerate(names)},
            "agent_id": agents.id,
            "agent_radius": agents.radius,
            "agent_mass": agents.mass,
            "agent_jump": states.jump[1:] if states.told.any() else None,
            **{f"trip_{name}": column for name, column in trips.items()},
        }


def _fastest(robot: RobotHeader) -> float | None:
    """The largest speed in any direction, m/s; None where it is not recorded or not positive."""
    if robot.limits is None:
        return None
    fastest = math.hypot(robot.limits.v_max, robot.limits.vy_max)
    return fastest if fastest > 0.0 else None


def _columns(rows: list[Any], names: tuple[str, ...]) -> dict[str, list[Any]]:
    return {name: [getattr(row, name) for row in rows] for name in names}
