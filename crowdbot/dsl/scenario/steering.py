"""Steering parts: behaviour in addition to the crowd policy; off by default.

Formulas and sources: docs/reference/crowd/steering.md.
"""

from __future__ import annotations

from typing import Annotated, Any

from annotated_types import Ge, Le
from pydantic import Field

from crowdbot.dsl.spec.quantities import (
    NonNegativeDuration,
    NonNegativeLength,
    PositiveAcceleration,
    PositiveDuration,
    PositiveLength,
)
from crowdbot.dsl.spec.spec import Spec


def unset(value: Any) -> bool:
    """Return True if an optional field is unset, and so not part of the hash."""
    return value is None


class TimeGapSpec(Spec):
    """Limits speed by the room ahead: (distance ahead - room) / time."""

    time: PositiveDuration = Field(default=1.0, description="Time gap kept to people ahead, s.")
    oncoming_time: PositiveDuration = Field(
        default=0.023,
        description="The same to people who come the other way, s; the default is nearly 0.",
    )
    room: NonNegativeLength = Field(
        default=0.27, description="Distance between centres, ahead, at which people stand, m."
    )
    half_width: PositiveLength = Field(
        default=0.28, description="People farther to the side do not count, m."
    )


class PersonalSpaceSpec(Spec):
    """A push away from others' future positions, stronger ahead than behind."""

    strength: PositiveAcceleration = Field(
        default=1.13, description="Push where discs are going to touch, ahead, m/s^2."
    )
    reach: PositiveLength = Field(
        default=0.4, description="Distance over which it falls to 1/e, m."
    )
    anticipation: NonNegativeDuration = Field(
        default=0.5, description="How far ahead people place each other, s."
    )
    behind: Annotated[float, Ge(0), Le(1)] = Field(
        default=0.78, description="Share of the push that is left straight behind."
    )


class LanesSpec(Spec):
    """In opposing flow, a person steps behind others who walk the same way."""

    strength: PositiveAcceleration = Field(
        default=1.0, description="Largest acceleration to the side, m/s^2."
    )
    reach: PositiveLength = Field(
        default=2.0, description="Distance ahead over which others matter e times less, m."
    )
    half_width: PositiveLength = Field(
        default=0.6, description="People farther to the side do not count, m."
    )
    follow: Annotated[float, Ge(0)] = Field(
        default=1.0, description="How much those who walk along count beside those who come."
    )


class WallPushSpec(Spec):
    """A push away from walls."""

    strength: PositiveAcceleration = Field(
        default=3.3, description="Push where the disc touches, m/s^2."
    )
    reach: PositiveLength = Field(
        default=0.13, description="Distance over which it falls to 1/e, m."
    )


class WanderSpec(Spec):
    """A slow random acceleration of each person, from the stream ``crowd.wander``."""

    deviation: PositiveAcceleration = Field(
        default=0.21, description="Standard deviation along each axis, m/s^2."
    )
    time: PositiveDuration = Field(
        default=0.41, description="Time in which its correlation falls to 1/e, s."
    )


class SteeringSpec(Spec):
    """Steering parts; each is off unless named."""

    time_gap: TimeGapSpec | None = Field(
        default=None, exclude_if=unset, description="Slow down behind others."
    )
    personal_space: PersonalSpaceSpec | None = Field(
        default=None, exclude_if=unset, description="Keep away from others."
    )
    lanes: LanesSpec | None = Field(
        default=None, exclude_if=unset, description="Walk behind those who go the same way."
    )
    wall_push: WallPushSpec | None = Field(
        default=None, exclude_if=unset, description="Keep away from walls."
    )
    wander: WanderSpec | None = Field(
        default=None, exclude_if=unset, description="Never walk quite straight."
    )
