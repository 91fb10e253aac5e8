"""Read ROS commands and times from untrusted plain values."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from crowdbot.core.types.motion import Command
from crowdbot.core.types.robot import RobotLimits
from crowdbot.errors import InputError

#: Range of seconds of a stamp in ROS 2.
_MOST_SECONDS = 2**31


def twist(message: Any) -> tuple[Command, int | None]:
    """Return a Twist or TwistStamped as a command, with its stamp (ns).

    Raises:
        InputError: it is neither.
    """
    stamp = None
    if isinstance(message, Mapping) and "twist" in message:
        head = message.get("header")
        stamp = time_ns(head.get("stamp")) if isinstance(head, Mapping) else None
        message = message["twist"]
    if not isinstance(message, Mapping):
        raise InputError("a command is a geometry_msgs/Twist or a geometry_msgs/TwistStamped")
    linear, angular = message.get("linear", {}), message.get("angular", {})
    return Command(_number(linear, "x"), _number(angular, "z"), _number(linear, "y")), stamp


def joy(message: Any, limits: RobotLimits) -> Command:
    """Return a sensor_msgs/Joy as a command: axis 1 is forward, axis 0 to the left.

    Raises:
        InputError: it is not one, or has fewer axes.
    """
    axes = message.get("axes") if isinstance(message, Mapping) else None
    if not isinstance(axes, Sequence) or isinstance(axes, str) or len(axes) < 2:
        raise InputError("a joystick is a sensor_msgs/Joy with at least two axes")
    left, ahead = (_number({"axis": value}, "axis") for value in axes[:2])
    return stick_command(ahead, left, limits)


def stick_command(ahead: float, left: float, limits: RobotLimits) -> Command:
    """Return the velocities for a stick's deflection, -1 to 1; full deflection is the limit."""
    ahead, left = min(1.0, max(-1.0, ahead)), min(1.0, max(-1.0, left))
    v = ahead * limits.v_max if ahead > 0.0 else -ahead * limits.v_min
    return Command(v + 0.0, left * limits.w_max)


def time_ns(message: Any) -> int | None:
    """Return a ROS 1 or ROS 2 time in ns; None if it is not one."""
    if not isinstance(message, Mapping):
        return None
    seconds = message.get("sec", message.get("secs", 0))
    rest = message.get("nanosec", message.get("nsecs", message.get("nsec", 0)))
    if not all(isinstance(x, int) and not isinstance(x, bool) for x in (seconds, rest)):
        return None
    if not (0 <= seconds < _MOST_SECONDS and 0 <= rest < 10**9):
        return None
    return int(seconds) * 10**9 + int(rest)


def _number(vector: Any, name: str) -> float:
    """Return one component; a missing one is 0, as in rosbridge messages."""
    value = vector.get(name, 0.0) if isinstance(vector, Mapping) else math.nan
    if isinstance(value, bool) or not isinstance(value, int | float) or abs(value) > 1e300:
        raise InputError(f"'{name}' of a command must be a number")
    if not math.isfinite(value):
        raise InputError(f"'{name}' of a command must be finite")
    return float(value)
