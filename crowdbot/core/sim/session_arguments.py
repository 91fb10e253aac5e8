"""Arguments of a session, checked."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from numbers import Real
from pathlib import Path
from typing import Any

from crowdbot.core.support.arguments import path_of
from crowdbot.core.types.motion import Command
from crowdbot.errors import InputError, kind_of

#: Command of a session: v, w, and vy for a robot that can move sideways; m/s, rad/s.
CommandLike = Command | tuple[float, ...] | Sequence[float]


def checked_recording(recording: str | Path) -> Path:
    """Return the path of a recording.

    Raises:
        InputError: it is a folder.
    """
    path = path_of("recording", recording)
    if path.is_dir():
        raise InputError(f"{path}: a recording is a file, and this is a folder")
    return path


def checked_commands(
    commands: Mapping[str, CommandLike], going_on: Collection[str], robots: Collection[str]
) -> dict[str, Command]:
    """Return the commands of the robots that go on, as finite floats.

    Raises:
        InputError: one is something else, is missing, or is for a robot that is not there.
    """
    if not isinstance(commands, Mapping):
        raise InputError(f"commands are a dict, robot -> command, not {kind_of(commands)}")
    for name in commands:
        if name not in robots:
            raise InputError(f"there is no robot '{name}'; there are {', '.join(robots)}")
    for name in going_on:
        if name not in commands:
            raise InputError(f"robot '{name}' goes on and has no command")
    return {name: checked_command(commands[name]) for name in going_on}


def checked_command(command: CommandLike) -> Command:
    """Return the command as finite floats.

    Raises:
        InputError: it is something else.
    """
    try:
        numbers: tuple[Any, ...] = tuple(command)
    except TypeError:
        numbers = ()
    good = all(isinstance(x, Real) and not isinstance(x, bool) for x in numbers)
    if not (good and len(numbers) in (2, 3) and all(math.isfinite(x) for x in numbers)):
        raise InputError(f"a command is (v, w) or (v, w, vy), finite numbers; not {command!r}")
    return Command(*(float(x) for x in numbers))
