"""RPP: follow a path, slower in bends and near obstacles, and stop before a collision."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Le

from crowdbot.plugin import (
    Component,
    PositiveAngle,
    PositiveDuration,
    PositiveFrequency,
    PositiveLength,
    PositiveSpeed,
    default,
)
from crowdbot.plugins.planners.shared.rungs import RungSpec


class RppSpec(RungSpec):
    """Defaults are those of nav2's regulated pure pursuit controller; speeds are the robot's."""

    kind: Literal["rpp"] = "rpp"
    look_ahead_time: PositiveDuration = default(
        1.5, "It aims at the point of the way this far ahead at its speed, s."
    )
    look_ahead_min: PositiveLength = default(0.3, "Least look-ahead, m.")
    look_ahead_max: PositiveLength = default(0.9, "Largest look-ahead, m.")
    turn_in_place: PositiveAngle = default(
        0.785, "Heading error above which the robot turns on the spot, rad."
    )
    turn_gain: PositiveFrequency = default(2.0, "Yaw rate per heading error on the spot, 1/s.")
    bend_radius: PositiveLength = default(
        0.9, "Slower in bends with a smaller radius than this, m."
    )
    min_speed: PositiveSpeed = default(
        0.25, "Bends and obstacles do not slow it below this speed, m/s."
    )
    proximity: PositiveLength = default(0.6, "Slower with an obstacle nearer than this, m.")
    proximity_gain: Annotated[float, Ge(0), Le(1)] = default(
        1.0, "Share of the gap, of `proximity`, to which it slows."
    )
    collision_time: PositiveDuration = default(
        1.0, "It stops if its arc hits something within this time, s."
    )


RPP = Component(
    spec=RppSpec,
    summary="regulated pure pursuit, nav2's (Macenski, Singh, Martín, Ginés 2023)",
)
