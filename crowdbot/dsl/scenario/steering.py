"""Steering parts: behaviour in addition to the crowd policy; off by default.

Formulas and sources: docs/reference/crowd/steering.md.
"""

from __future__ import annotations

from typing import Annotated

from annotated_types import Ge, Le

from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.quantities import (
    NonNegativeDuration,
    NonNegativeLength,
    PositiveAcceleration,
    PositiveDuration,
    PositiveLength,
)
from crowdbot.dsl.spec.spec import Spec


class TimeGapSpec(Spec):
    """Limits speed by the room ahead: (distance ahead - room) / time."""

    time: PositiveDuration = default(1.0, "Time gap kept to people ahead, s.")
    oncoming_time: PositiveDuration = default(
        0.023, "The same to people who come the other way, s; the default is nearly 0."
    )
    room: NonNegativeLength = default(
        0.27, "Distance between centres, ahead, at which people stand, m."
    )
    half_width: PositiveLength = default(0.28, "People farther to the side do not count, m.")


class PersonalSpaceSpec(Spec):
    """A push away from others' future positions, stronger ahead than behind."""

    strength: PositiveAcceleration = default(
        1.13, "Push where discs are going to touch, ahead, m/s^2."
    )
    reach: PositiveLength = default(0.4, "Distance over which it falls to 1/e, m.")
    anticipation: NonNegativeDuration = default(0.5, "How far ahead people place each other, s.")
    behind: Annotated[float, Ge(0), Le(1)] = default(
        0.78, "Share of the push that is left straight behind."
    )


class LanesSpec(Spec):
    """In opposing flow, a person steps behind others who walk the same way."""

    strength: PositiveAcceleration = default(1.0, "Largest acceleration to the side, m/s^2.")
    reach: PositiveLength = default(2.0, "Distance ahead over which others matter e times less, m.")
    half_width: PositiveLength = default(0.6, "People farther to the side do not count, m.")
    follow: Annotated[float, Ge(0)] = default(
        1.0, "How much those who walk along count beside those who come."
    )


class WallPushSpec(Spec):
    """A push away from walls."""

    strength: PositiveAcceleration = default(3.3, "Push where the disc touches, m/s^2.")
    reach: PositiveLength = default(0.13, "Distance over which it falls to 1/e, m.")


class WanderSpec(Spec):
    """A slow random acceleration of each person, from the stream ``crowd.wander``."""

    deviation: PositiveAcceleration = default(0.21, "Standard deviation along each axis, m/s^2.")
    time: PositiveDuration = default(0.41, "Time in which its correlation falls to 1/e, s.")


class SteeringSpec(Spec):
    """Steering parts; each is off unless named."""

    time_gap: TimeGapSpec | None = default(None, "Slow down behind others.", omitted=True)
    personal_space: PersonalSpaceSpec | None = default(None, "Keep away from others.", omitted=True)
    lanes: LanesSpec | None = default(None, "Walk behind those who go the same way.", omitted=True)
    wall_push: WallPushSpec | None = default(None, "Keep away from walls.", omitted=True)
    wander: WanderSpec | None = default(None, "Never walk quite straight.", omitted=True)
