"""Position of a person's stick, read from untrusted messages."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from crowdbot.core.live.commands import stick_command
from crowdbot.core.types.motion import Command
from crowdbot.core.types.robot import RobotLimits
from crowdbot.errors import InputError

_MOST_NUMBER = 2**53


@dataclass(frozen=True, slots=True)
class Stick:
    """Deflection of the stick on a person's page.

    Attributes:
        number: counts the positions of a page; 0: none yet.
        ahead, left, aside: deflections from -1 to 1: forward, turning to the left, to the left
            without turning.
        yaw: direction of the view of a person who walks, rad, world frame.
    """

    number: int = 0
    ahead: float = 0.0
    left: float = 0.0
    aside: float = 0.0
    yaw: float = 0.0


CENTRED = Stick()


def stick_of(message: Mapping[str, Any]) -> Stick:
    """Return the stick of a message ``{n, ahead, left, aside, yaw}``.

    Raises:
        InputError: a field is missing or not a finite number.
    """
    number = message.get("n")
    if isinstance(number, bool) or not isinstance(number, int) or not 0 < number < _MOST_NUMBER:
        raise InputError("'n' of a stick is a whole number above 0")
    ahead, left, aside = (_deflection(message, name) for name in ("ahead", "left", "aside"))
    return Stick(number, ahead, left, aside, _number(message, "yaw"))


def command_of(stick: Stick, limits: RobotLimits) -> Command:
    """Return the velocities for a stick's position: full deflection is the robot's limit."""
    v, w, _ = stick_command(stick.ahead, stick.left, limits)
    return Command(v, w, stick.aside * limits.vy_max)


def _deflection(message: Mapping[str, Any], name: str) -> float:
    return min(1.0, max(-1.0, _number(message, name)))


def _number(message: Mapping[str, Any], name: str) -> float:
    value = message.get(name, 0.0)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise InputError(f"'{name}' of a stick is a finite number")
    return float(value)
