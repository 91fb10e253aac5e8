"""Stick of a recorded run: replays the same commands at the same steps, without a person."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from crowdbot.core.live.person.seat_stick import reading_of
from crowdbot.core.recording import messages as ros
from crowdbot.core.recording.container.records import Records
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.topics import Topic
from crowdbot.core.runs import run_directory as files
from crowdbot.core.sensing.scene import Scene
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Command, Pose
from crowdbot.core.types.robot import RobotLimits
from crowdbot.core.types.sensor import SensorInfo
from crowdbot.errors import InputError

_HEADER, _TWIST = "crowdbot_msgs/msg/RunHeader", "geometry_msgs/msg/TwistStamped"


class RecordedStick:
    """Sensor whose reading is the recorded command of each step; zero after the last one."""

    def __init__(self, commands: dict[int, Command], limits: RobotLimits, info: SensorInfo) -> None:
        """Take commands by the time of their step, ns."""
        self._commands, self._limits, self._info = commands, limits, info

    def info(self) -> SensorInfo:
        """Return the constant description."""
        return self._info

    def read(self, scene: Scene, pose: Pose, t: float, rng: np.random.Generator) -> Array:
        """Return the command of a step."""
        del scene, pose, rng
        command = self._commands.get(ros.nanoseconds(t), Command(0.0, 0.0))
        return reading_of(command, self._limits, self._info)


def recorded_sticks(
    run: Path, robot: str = ""
) -> Callable[[RobotLimits, SensorInfo], RecordedStick]:
    """Return a factory for the sticks of a recorded run.

    Args:
        run: a run directory, or a recording.
        robot: name of the robot of several; empty for the only one.

    Raises:
        InputError: it cannot be read, or no joystick was recorded.
    """
    path = run / files.RECORDING if run.is_dir() else run
    space = f"/{robot}" if robot else ""
    topic, commands = "", dict[int, Command]()
    for record in Records(path):
        if record.topic == f"{space}{Topic.HEADER}" and record.msgtype == _HEADER:
            topic = topic or _stick_topic(ros.from_cdr(record.data, _HEADER), space)
        elif topic and record.topic == topic and record.msgtype == _TWIST:
            twist = ros.from_cdr(record.data, _TWIST).twist
            commands[record.ns] = Command(twist.linear.x, twist.angular.z, twist.linear.y)
    if not commands:
        raise InputError(f"{run}: no commands of a person in it: 'crowdbot teleop' records them")
    return lambda limits, info: RecordedStick(commands, limits, info)


def _stick_topic(message: object, space: str) -> str:
    sensors = RecordingHeader.from_message(message).sensors
    found = next((n for n, info in sensors.items() if info.category == "joystick"), "")
    return f"{space}/{found}/cmd_vel" if found else ""
