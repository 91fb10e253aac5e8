"""Walker: people who follow velocity commands, live or recorded."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import MinLen
from pydantic import Field, field_validator

from crowdbot.plugin import Component, CrowdPolicySpec, NonNegativeDuration, Quantity, default
from crowdbot.plugins.sensors.joystick import in_order

_Velocity = Annotated[float, Quantity("speed")]
#: Start time of a command, s; velocity x, y in the world frame, m/s.
WalkCommand = Annotated[
    tuple[NonNegativeDuration, _Velocity, _Velocity],
    Field(strict=False),
]


class WalkerSpec(CrowdPolicySpec):
    """Agents follow commanded velocities, within their largest speed and acceleration.

    `crowdbot walk` commands them from a page; without a page they follow ``recorded``, or stand.
    They avoid no one by themselves, and neither robots nor groups nor steering change their
    velocity; bodies and walls stop them like anyone. Other people see and avoid them.
    """

    kind: Literal["walker"] = "walker"
    recorded: Annotated[tuple[WalkCommand, ...], MinLen(1)] | None = default(
        None,
        "Commands without a page: [t, vx, vy], each from t on, s, m/s, world frame.",
        strict=False,
    )

    _in_order = field_validator("recorded")(in_order)


WALKER = Component(
    spec=WalkerSpec,
    summary="a person led by commands: live from a page, or recorded",
    examples=({}, {"recorded": ((0.0, 1.2, 0.0), (3.0, 0.0, 0.0))}),
    exceptions={
        "check_rotation_equivariant": "commands are velocities in the world frame",
    },
)
