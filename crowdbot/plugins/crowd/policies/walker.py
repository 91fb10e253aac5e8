"""Walker: people who follow velocity commands, live or recorded."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Literal

from annotated_types import MinLen
from pydantic import Field, field_validator

from crowdbot.plugin import Component, CrowdPolicySpec, NonNegativeDuration, Quantity, default

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

    @field_validator("recorded")
    @classmethod
    def _in_order(cls, value: tuple[WalkCommand, ...] | None) -> tuple[WalkCommand, ...] | None:
        times = [t for t, _, _ in value or ()]
        for k, (one, two) in enumerate(pairwise(times)):
            if two <= one:
                raise ValueError(
                    f"times must rise; command {k + 2} is at {two:g} s, not after {one:g} s"
                )
        return value


WALKER = Component(
    spec=WalkerSpec,
    summary="a person led by commands: live from a page, or recorded",
    examples=({}, {"recorded": ((0.0, 1.2, 0.0), (3.0, 0.0, 0.0))}),
    exceptions={
        "check_rotation_equivariant": "commands are velocities in the world frame",
    },
)
