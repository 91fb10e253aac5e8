"""Joystick: the command of the robot's driver."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Literal

from annotated_types import Ge, Le, MinLen
from pydantic import Field, field_validator, model_validator

from crowdbot.plugin import (
    Component,
    Length,
    NonNegativeDuration,
    PositiveAngularSpeed,
    PositiveDuration,
    PositiveFrequency,
    PositiveLength,
    PositiveSpeed,
    Quantity,
    SensorSpec,
    Speed,
    default,
)

#: Start time of a command, s; speed, m/s; yaw rate, rad/s.
RecordedCommand = Annotated[
    tuple[NonNegativeDuration, Speed, Annotated[float, Quantity("angular speed")]],
    Field(strict=False),
]
#: A position x, y, m.
Place = Annotated[tuple[Length, Length], Field(strict=False)]


def in_order(
    commands: tuple[tuple[float, float, float], ...] | None,
) -> tuple[tuple[float, float, float], ...] | None:
    """Return recorded commands, if there are any, whose times rise.

    Raises:
        ValueError: they do not.
    """
    times = [t for t, _, _ in commands or ()]
    for k, (one, two) in enumerate(pairwise(times)):
        if two <= one:
            raise ValueError(
                f"times must rise; command {k + 2} is at {two:g} s, not after {one:g} s"
            )
    return commands


class JoystickSpec(SensorSpec):
    """Reading: v (m/s), w (rad/s), the velocity that the driver commands.

    The driver steers straight for the goal regardless of obstacles, or as in `recorded`. All
    defaults are proposed.
    """

    kind: Literal["joystick"] = "joystick"
    rate: PositiveFrequency = default(16.0, "Readings per second, Hz.", le=128)
    goal: Place | None = default(None, "Where the driver wants to go, m; unset: the task's goal.")
    max_speed: PositiveSpeed | None = default(
        None, "Speed of the stick fully ahead, m/s; unset: the robot's."
    )
    max_yaw_rate: PositiveAngularSpeed | None = default(
        None, "Yaw rate of the stick fully aside, rad/s; unset: the robot's."
    )
    steering: Annotated[float, Ge(0)] = default(
        1.5, "Yaw rate for each radian that the goal is off the heading, 1/s."
    )
    slow_distance: PositiveLength = default(1.5, "Nearer to the goal the driver slows down, m.")
    noise: Annotated[float, Ge(0), Le(1)] = default(
        0.1, "Standard deviation of the hand, a fraction of full deflection."
    )
    noise_time: PositiveDuration = default(0.5, "Correlation time of the hand's error, s.")
    recorded: Annotated[tuple[RecordedCommand, ...], MinLen(1)] | None = default(
        None,
        "Commands of a real driver in place of the scripted one, without noise: "
        "[t, v, w], each from t on, s, m/s, rad/s.",
        strict=False,
    )

    _in_order = field_validator("recorded")(in_order)

    @model_validator(mode="after")
    def _one_driver(self) -> JoystickSpec:
        if self.recorded is not None and self.goal is not None:
            raise ValueError("a recorded driver has no goal; leave one of 'recorded', 'goal' out")
        return self


JOYSTICK = Component(
    spec=JoystickSpec,
    summary="velocity that the robot's driver asks for: scripted, or recorded",
    examples=(
        {},
        {"goal": (8.0, 1.0), "noise": 0.0, "rate": 32.0},
        {"recorded": ((0.0, 0.5, 0.0), (0.2, 0.5, -0.3))},
    ),
)
