"""Commands of a robot's driver and planner, in recordings with a joystick."""

from __future__ import annotations

from pathlib import Path

from crowdbot.core.recording.container.records import Record
from crowdbot.core.recording.header import RecordingHeader
from crowdbot.core.recording.reading.commands import commands_of, twist_row
from crowdbot.core.recording.topics import Topic
from crowdbot.core.trajectories.commands import Commands


class DriverCommands:
    """Records of the first joystick and of the planner's commands, decoded on demand."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._joystick: str | None = None
        self._user: list[Record] = []
        self._final: list[Record] = []

    def open(self, header: RecordingHeader) -> None:
        """Set the joystick's name from the header, if the robot has one."""
        names = (n for n, s in header.sensors.items() if s.category == "joystick")
        self._joystick = next(names, None)

    def wants(self, topic: str) -> bool:
        """Return True if a topic holds these commands."""
        return self._is_user(topic) or (self._joystick is not None and topic == Topic.COMMAND)

    def add(self, topic: str, record: Record) -> None:
        """Take a command."""
        (self._user if self._is_user(topic) else self._final).append(record)

    def commands(self, header: RecordingHeader, end: int) -> Commands | None:
        """Return the commands until a time (ns); None if either kind was not recorded.

        Raises:
            InputError: a command is damaged.
        """
        limits = None if header.robot is None else header.robot.limits
        if not self._user or not self._final or limits is None:
            return None
        user, final = (
            [twist_row(self._path, r) for r in rows] for rows in (self._user, self._final)
        )
        return commands_of(self._path, user, final, end, v_max=limits.v_max, w_max=limits.w_max)

    def _is_user(self, topic: str) -> bool:
        name = self._joystick
        return name is not None and (topic == f"/{name}" or topic.startswith(f"/{name}/"))
