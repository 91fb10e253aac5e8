"""RecordingHeader: the constants of a run; the first message of a recording."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import crowdbot.core.recording.messages as ros
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.person_task import TaskPerson
from crowdbot.core.types.robot import RobotLimits, RobotModel
from crowdbot.core.types.sensor import Pinhole, SensorInfo
from crowdbot.errors import InputError

#: Raised when the meaning of a ``/crowdbot/...`` message changes; and the oldest that is read.
VERSION, OLDEST = 4, 3
#: The format, after the four bytes that each serialised message begins with.
_FORMAT = struct.Struct("<4xI")
_LIMITS = ("v_min", "v_max", "w_max", "a_max", "alpha_max", "vy_max")


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotHeader:
    """The robot; m, kg.

    Attributes:
        goal: centre of the goal, world frame.
        base_height: height of base_link above the floor.
        footprint: outline of a body that is not a disc, as in `RobotModel.footprint`.
    """

    radius: float
    mass: float
    goal: tuple[float, float] | None = None
    goal_radius: float = 0.0
    base_height: float = 0.0
    limits: RobotLimits | None = None
    footprint: Array | None = None

    @classmethod
    def of(cls, model: RobotModel, goal: tuple[float, float] | None) -> RobotHeader:
        """Return the constants of a robot model with a goal, if it is a point."""
        return cls(
            radius=model.footprint_radius, mass=model.mass, goal=goal,
            base_height=model.base_height, limits=model.limits, footprint=model.footprint,
        )  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True)
class AgentsHeader:
    """People: id, radius (m), mass (kg), each (M,)."""

    id: NDArray[np.int64]
    radius: Array
    mass: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingHeader:
    """Constants of a run.

    Attributes:
        hashes: name -> hash, e.g. ``spec`` and ``realisation``.
        robot, agents: None if the run has none.
        walls: (S, 4) segments x0, y0, x1, y1, m.
        goal_zone: (K, 2) polygon, m.
        person: the person that the robot's task is about; it is written apart from the header.
        namespace: prefix of topics and frames of one robot of several. It is not written, since the
            header's topic contains it.
    """

    scenario: str
    hashes: Mapping[str, str] = field(default_factory=dict)
    robot: RobotHeader | None = None
    agents: AgentsHeader | None = None
    sensors: Mapping[str, SensorInfo] = field(default_factory=dict)
    walls: Array | None = None
    goal_zone: Array | None = None
    person: TaskPerson | None = None
    namespace: str = ""

    def to_message(self) -> Any:
        """Return the header as ``crowdbot_msgs/msg/RunHeader``."""
        return ros.new(
            "crowdbot_msgs/RunHeader",
            version=VERSION,
            scenario=self.scenario,
            hash_names=list(self.hashes),
            hashes=list(self.hashes.values()),
            robot=[_robot_message(self.robot)] if self.robot else [],
            agents=[_agents_message(self.agents)] if self.agents else [],
            sensors=[sensor_message(name, info) for name, info in self.sensors.items()],
            walls=ros.table(self.walls),
            goal_zone=ros.table(self.goal_zone),
            cameras=[
                ros.new("crowdbot_msgs/Camera", sensor=n, **asdict(i.camera))
                for n, i in self.sensors.items()
                if i.camera
            ],
            privileged=[n for n, i in self.sensors.items() if i.privileged],
        )

    @classmethod
    def from_message(cls, message: Any) -> RecordingHeader:
        """Read the header from its message.

        Raises:
            InputError: the message has a format that is not read, or contradicts itself.
        """
        if problem := format_problem(message.version):
            raise InputError(problem)
        try:
            return cls(
                scenario=message.scenario,
                hashes=dict(zip(message.hash_names, message.hashes, strict=True)),
                robot=_robot(message.robot[0]) if message.robot else None,
                agents=_agents(message.agents[0]) if message.agents else None,
                sensors=_sensors(message),
                walls=ros.from_table(message.walls),
                goal_zone=ros.from_table(message.goal_zone),
            )
        except (ValueError, LookupError) as error:  # tables and lists of the wrong length
            raise InputError(f"the recording's header contradicts itself: {error}") from error


def format_problem(version: int) -> str:
    """Return why a format cannot be read, and what to do; empty if it can."""
    read = f"the recording has format {version}; the {{}} that this crowdbot reads is {{}}: "
    if version > VERSION:
        return read.format("newest", VERSION) + "update crowdbot"
    if version < OLDEST:
        remedy = "make the run again, or read it with the crowdbot that recorded it"
        return read.format("oldest", OLDEST) + remedy
    return ""


def check_format(path: Path, data: bytes) -> None:
    """Raise an error for a header whose format cannot be read, before it is decoded.

    Args:
        path: the recording, for the message.
        data: a serialised ``crowdbot_msgs/msg/RunHeader``.

    Raises:
        InputError: the format is too old or too new.
    """
    if len(data) >= _FORMAT.size and (problem := format_problem(_FORMAT.unpack_from(data)[0])):
        raise InputError(f"{path}: {problem}")


def tilts_message(sensors: Mapping[str, SensorInfo]) -> Any | None:
    """Return roll and pitch of sensors as ``crowdbot_msgs/SensorTilts``; None if all are level.

    They are separate so that the header's bytes stay the same without tilts.
    """
    tilted = {name: info.tilt for name, info in sensors.items() if any(info.tilt)}
    if not tilted:
        return None
    return ros.new(
        "crowdbot_msgs/SensorTilts",
        sensor=list(tilted),
        roll=np.array([roll for roll, _ in tilted.values()]),
        pitch=np.array([pitch for _, pitch in tilted.values()]),
    )


def with_tilts(sensors: Mapping[str, SensorInfo], message: Any) -> dict[str, SensorInfo]:
    """Return a header's sensors with the tilts of a message, which may name other sensors, too.

    Raises:
        InputError: its lists have different lengths.
    """
    if not len(message.sensor) == len(message.roll) == len(message.pitch):
        raise InputError("the recording lists tilts of sensors of unequal number")
    tilts = zip(message.roll.tolist(), message.pitch.tolist(), strict=True)
    tilt_of = dict(zip(message.sensor, tilts, strict=True))
    return {n: replace(s, tilt=tilt_of[n]) if n in tilt_of else s for n, s in sensors.items()}


def with_frames(header: RecordingHeader) -> RecordingHeader:
    """Return the header with the frames of its sensors in its namespace, if it has one."""
    if not header.namespace:
        return header
    return replace(
        header,
        sensors={
            name: replace(info, frame=f"{header.namespace}/{info.frame}")
            for name, info in header.sensors.items()
        },
    )


def _robot_message(robot: RobotHeader) -> Any:
    limits = None if robot.limits is None else limit_numbers(robot.limits)
    return ros.new(
        "crowdbot_msgs/RobotInfo",
        radius=robot.radius,
        mass=robot.mass,
        goal=ros.table(robot.goal),
        goal_radius=robot.goal_radius,
        base_height=robot.base_height,
        limits=ros.table(limits),
        footprint=ros.table(robot.footprint),
    )


def limit_numbers(limits: RobotLimits) -> list[float]:
    """Return the limits as numbers; the last one, for sideways motion, is omitted if 0."""
    numbers = [getattr(limits, name) for name in _LIMITS]
    return numbers if limits.vy_max else numbers[:-1]


def _robot(message: Any) -> RobotHeader:
    goal, limits = ros.from_table(message.goal), ros.from_table(message.limits)
    if limits is not None and len(limits) not in (len(_LIMITS) - 1, len(_LIMITS)):
        raise ValueError(f"{len(limits)} limits of the robot")
    return RobotHeader(
        radius=message.radius,
        mass=message.mass,
        goal=None if goal is None else (float(goal[0]), float(goal[1])),
        goal_radius=message.goal_radius,
        base_height=message.base_height,
        limits=None
        if limits is None
        else RobotLimits(**dict(zip(_LIMITS, limits.tolist(), strict=False))),
        footprint=ros.from_table(message.footprint),
    )


def _agents_message(agents: AgentsHeader) -> Any:
    return ros.new(
        "crowdbot_msgs/AgentsInfo",
        id=np.ascontiguousarray(agents.id, np.int64),
        radius=np.ascontiguousarray(agents.radius, np.float64),
        mass=np.ascontiguousarray(agents.mass, np.float64),
    )


def _agents(message: Any) -> AgentsHeader:
    if not len(message.id) == len(message.radius) == len(message.mass):
        raise InputError("the recording's header lists ids, radii and masses of unequal number")
    return AgentsHeader(id=message.id, radius=message.radius, mass=message.mass)


def sensor_message(name: str, info: SensorInfo) -> Any:
    """Return a sensor's description as ``crowdbot_msgs/Sensor``."""
    return ros.new(
        "crowdbot_msgs/Sensor",
        name=name,
        category=info.category,
        frame=info.frame,
        mount=np.array(info.mount, np.float64),
        rate=info.rate,
        shape=np.array(info.shape, np.uint32),
        ros_type=info.ros_type,
        angles=ros.table(info.angles),
        range_min=info.range_min,
        range_max=info.range_max,
    )


def _sensors(message: Any) -> dict[str, SensorInfo]:
    """Return the descriptions of the sensors, by name."""
    sensors = {s.name: _sensor(s) for s in message.sensors}
    for found in message.cameras:
        camera = Pinhole(
            width=found.width, height=found.height, focal=found.focal, colour=bool(found.colour)
        )
        sensors[found.sensor] = replace(sensors[found.sensor], camera=camera)
    for name in message.privileged:
        sensors[name] = replace(sensors[name], privileged=True)
    return sensors


def _sensor(message: Any) -> SensorInfo:
    x, y, z, yaw = message.mount.tolist()
    return SensorInfo(
        category=message.category,
        frame=message.frame,
        mount=(x, y, z, yaw),
        rate=message.rate,
        shape=tuple(message.shape.tolist()),
        ros_type=message.ros_type,
        angles=ros.from_table(message.angles),
        range_min=message.range_min,
        range_max=message.range_max,
    )
