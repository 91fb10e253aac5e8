"""DWA: the dynamic window approach.

Source: Fox, Burgard, Thrun, "The dynamic window approach to collision avoidance", IEEE Robotics and
Automation Magazine 4(1), 1997. Four things are added: rollouts obey the slew limits, a local
direction is chosen before the velocities, lidar points are extrapolated with their observed motion,
and a robot without progress for a while plans a path on a small local map.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Gt, Le
from pydantic import Field

from crowdbot.plugin import (
    Component,
    NonNegativeDuration,
    NonNegativeLength,
    NonNegativeSpeed,
    PlannerRole,
    PlannerSpec,
    PositiveAngle,
    PositiveDuration,
    PositiveLength,
    PositiveSpeed,
)
from crowdbot.plugins.planners.shared.near_sensors import NEAR_SENSORS, near_sensors_field

Weight = Annotated[float, Ge(0)]


class DwaSpec(PlannerSpec):
    """The dynamic window approach, using lidar points and odometry only."""

    role: ClassVar[PlannerRole] = "baseline"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["dwa"] = "dwa"
    robot_radius: PositiveLength | None = Field(
        default=None, description="Radius of the robot, m; unset: the robot's own outline."
    )
    person_radius: NonNegativeLength = Field(
        default=0.33, description="Disc that is kept clear around legs; 0: legs alone, m."
    )
    speed: Annotated[float, Gt(0), Le(1)] = Field(
        default=1.0, description="Cruising speed as a fraction of the robot's largest."
    )
    window: PositiveDuration = Field(
        default=0.5, description="Candidates are the velocities reachable in this time, s."
    )
    speeds: Annotated[int, Ge(2), Le(32)] = Field(default=6, description="Candidate speeds.")
    yaw_rates: Annotated[int, Ge(3), Le(64)] = Field(default=15, description="Candidate yaw rates.")
    horizon: PositiveDuration = Field(default=2.5, description="Length of a rollout, s.")
    turn_time: PositiveDuration = Field(
        default=1.0, description="Time on the arc; the rest of a rollout is straight, s."
    )
    margin: NonNegativeLength = Field(
        default=0.06, description="Clearance that is never given up, m."
    )
    comfort: PositiveLength = Field(
        default=0.4, description="Clearance above which more is no better, m."
    )
    margin_growth: NonNegativeSpeed = Field(
        default=0.05, description="Clearance lost to doubt, per second ahead, m/s."
    )
    look_ahead: PositiveDuration = Field(
        default=4.0, description="Time for which a direction should stay free, s."
    )
    swerve: PositiveAngle = Field(
        default=1.3,
        description="Largest angle from the goal's bearing where people walk, rad.",
    )
    hold: Weight = Field(
        default=0.3, description="Weight of keeping to the last direction; half where people stand."
    )
    look_back: NonNegativeDuration = Field(
        default=0.3, description="Age of the scan that shows what moves; 0 takes all as still, s."
    )
    max_obstacle_speed: PositiveSpeed = Field(
        default=2.5, description="Faster apparent motion is a mismatch, m/s."
    )
    patience: PositiveDuration = Field(
        default=3.0, description="Time without progress before the robot tries to get out, s."
    )
    progress: Weight = Field(default=1.0, description="Weight of way made in the direction.")
    heading: Weight = Field(default=0.4, description="Weight of the final heading.")
    clearance: Weight = Field(default=0.6, description="Weight of the closest approach.")
    impact: Weight = Field(default=1.2, description="Weight of an early predicted hit.")
    near_sensors: bool = near_sensors_field()
    smoothness: Weight = Field(default=0.05, description="Weight of a change of command.")

    @property
    def wants(self) -> tuple[str, ...]:
        """Return the near sensors, if they are to be used."""
        return NEAR_SENSORS if self.near_sensors else ()


DWA = Component(
    spec=DwaSpec,
    summary="dynamic window approach on lidar points (Fox, Burgard, Thrun 1997)",
)
