"""Small recordings and comparisons for the tests of recording and replay."""

from __future__ import annotations

import struct
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from mcap.writer import MCAP0_MAGIC
from numpy.typing import NDArray

from crowdbot.core.recording.header import AgentsHeader, RecordingHeader, RobotHeader
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.plugin import Array, Command, Reading, RobotLimits, SensorInfo

ANGLES = np.linspace(-2.0, 2.0, 33)
WALLS = np.array([[0.0, -5.0, 50.0, -5.0], [0.0, 5.0, 50.0, 5.0]])
ZONE = np.array([[45.0, -2.0], [48.0, -2.0], [48.0, 2.0], [45.0, 2.0]])
LIDAR = SensorInfo(
    category="lidar",
    frame="front_lidar",
    mount=(0.1, 0.02, 0.3, 0.5),
    rate=16.0,
    shape=(33,),
    ros_type="sensor_msgs/msg/LaserScan",
    angles=ANGLES,
    range_min=0.1,
    range_max=10.0,
)
ODOMETRY = SensorInfo(
    category="odometry",
    frame="odom",
    mount=(0.0, 0.0, 0.0, 0.0),
    rate=64.0,
    shape=(5,),
    ros_type="nav_msgs/msg/Odometry",
)
SMELL = SensorInfo(
    category="nose", frame="nose", mount=(0.0, 0.0, 1.0, 0.0), rate=1.0, shape=(2, 3), ros_type=""
)
LIMITS = RobotLimits(v_min=-0.1, v_max=0.65, w_max=3.14, a_max=1.0, alpha_max=2.0)


@dataclass(frozen=True)
class Run:
    """What a test writes: t (N,), robot (N, 5), agents (N, 4, M), jump (N, M)."""

    t: Array
    robot: Array | None
    agents: Array | None
    jump: NDArray[np.bool_] | None


def random_run(n: int = 40, m: int = 7, seed: int = 3) -> Run:
    """Walkers and a robot; the last person is absent now and then, one is teleported."""
    rng = np.random.default_rng(seed)
    t = np.arange(n) / 16.0
    velocity = rng.normal(0.0, 1.0, (2, m)) + np.zeros((n, 2, m))
    position = rng.uniform((0.0, -4.0), (50.0, 4.0), (m, 2)).T + velocity * t[:, None, None]
    agents = np.concatenate((position, velocity), axis=1)
    jump = np.zeros((n, m), np.bool_)
    if m:
        agents[n // 2 :, 0, 0] += 20.0
        jump[n // 2, 0] = True
        agents[n // 4 : n // 3, :, m - 1] = np.nan
    robot = np.column_stack((1.0 + 0.5 * t, np.sin(t), 0.3 * t, 0.5 + 0.0 * t, 0.3 + 0.0 * t))
    return Run(t, robot, agents, jump)


def header_of(run: Run, **changes: Any) -> RecordingHeader:
    """A header that fits a run."""
    m = 0 if run.agents is None else run.agents.shape[2]
    given: dict[str, Any] = {
        "scenario": "test/one",
        "hashes": {"spec": "abc", "realisation": "def"},
        "robot": None
        if run.robot is None
        else RobotHeader(
            radius=0.2, mass=6.3, goal=(46.5, 0.0), goal_radius=0.5, base_height=0.01, limits=LIMITS
        ),
        "agents": None
        if run.agents is None
        else AgentsHeader(
            id=np.arange(m) * 3 + 100, radius=np.full(m, 0.33), mass=np.linspace(60.0, 90.0, m)
        ),
        "sensors": {"front": LIDAR, "wheels": ODOMETRY, "nose": SMELL}
        if run.robot is not None
        else {},
        "walls": WALLS,
        "goal_zone": ZONE,
    }
    return RecordingHeader(**{**given, **changes})


def write_samples(writer: RecordingWriter, run: Run, *, flush_at: int | None = None) -> None:
    """Everything a simulation would write, but for the end."""
    for k, t in enumerate(run.t.tolist()):
        writer.state(
            t,
            None if run.robot is None else run.robot[k],
            None if run.agents is None else run.agents[k],
            None if run.jump is None else run.jump[k],
        )
        if run.robot is not None:
            write_robot(writer, t, run.robot[k])
        if k == flush_at:
            writer.flush()


def write_robot(writer: RecordingWriter, t: float, robot: Array) -> None:
    """Readings and a command at one time."""
    ranges = np.where(ANGLES > 0.0, 1.0 + t, np.inf)
    writer.reading("front", Reading(t, ranges))
    for i in range(4):
        writer.reading("wheels", Reading(t + i / 64, robot + 0.01))
    writer.reading("nose", Reading(t, np.arange(6.0).reshape(2, 3) + t))
    writer.command(t, Command(0.4, -0.2))
    writer.planner_time(t, 0.01 + t)
    writer.signal(t, "doubt", -0.0)


#: What a recording is told of the robot.
URDF = '<robot name="one"><link name="base_link"/></robot>'


def write_run(
    path: Path,
    run: Run,
    *,
    record: Literal["all", "used", "none"] = "all",
    goal_time: float | None = 2.25,
) -> None:
    """A whole recording with a trip and two contacts."""
    writer = RecordingWriter(path, header_of(run), record=record, description=URDF)
    write_samples(writer, run)
    if run.agents is not None and run.agents.shape[2]:
        writer.trip(100, 0.0, 1.1, True)
        writer.trip(103, 0.5, 2.0, False)
    if run.robot is not None:
        writer.contact(0.3, 0.40625, 103, 1.5, 20.0, 0.7)
        writer.contact(1.0, 1.1, -1, 0.1, 2.0, 0.2)
    writer.close(goal_time, True, "arrived" if goal_time is not None else "timeout")


def bits(value: Any) -> Any:
    """A value with arrays as bytes, so that == is bit by bit (NaN, -0.0)."""
    if isinstance(value, np.ndarray):
        return (value.dtype.str, value.shape, value.tobytes())
    if is_dataclass(value):
        return {f.name: bits(getattr(value, f.name)) for f in fields(value)}
    if isinstance(value, dict):
        return {k: bits(v) for k, v in value.items()}
    return value


def chunk_ends(data: bytes) -> list[int]:
    """Offsets behind each chunk record, found by walking over the records."""
    ends, at = [], len(MCAP0_MAGIC)
    while at + 9 <= len(data):
        opcode, length = struct.unpack_from("<BQ", data, at)
        at += 9 + length
        if opcode == 0x06:
            ends.append(at)
        if opcode == 0x02:
            break
    return ends
