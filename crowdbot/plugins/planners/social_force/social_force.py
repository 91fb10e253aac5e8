"""Social force: pulled to the goal, pushed by people and walls."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Le

from crowdbot.plugin import (
    Component,
    PositiveAcceleration,
    PositiveDuration,
    PositiveLength,
    default,
)
from crowdbot.plugins.planners.shared.rungs import RungSpec


class SocialForceSpec(RungSpec):
    """Parameters of Helbing, Farkas, Vicsek 2000: 2000 N for 80 kg, 0.08 m, 0.5 s."""

    kind: Literal["social_force"] = "social_force"
    relaxation_time: PositiveDuration = default(
        0.5, "Time in which the wanted velocity is taken on, s."
    )
    strength: PositiveAcceleration = default(
        25.0, "Acceleration by a surface that is touched, m/s^2."
    )
    range: PositiveLength = default(0.08, "Distance over which it falls to 1/e, m.")
    view: Annotated[float, Ge(0), Le(1)] = default(
        0.5, "Weight of what is behind; 1: it counts like what is ahead."
    )


SOCIAL_FORCE = Component(
    spec=SocialForceSpec,
    summary="the social force model as a robot (Helbing, Farkas, Vicsek 2000)",
)
