"""DWA: the dynamic window approach.

Source: Fox, Burgard, Thrun, "The dynamic window approach to collision avoidance", IEEE Robotics and
Automation Magazine 4(1), 1997. Four things are added: rollouts obey the slew limits, a local
direction is chosen before the velocities, lidar points are extrapolated with their observed motion,
and a robot without progress for a while plans a path on a small local map.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Gt, Le

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
    default,
)
from crowdbot.plugins.planners.shared.near_sensors import NEAR_SENSORS, near_sensors_field

Weight = Annotated[float, Ge(0)]


class DwaSpec(PlannerSpec):
    """The dynamic window approach, using lidar points and odometry only."""

    role: ClassVar[PlannerRole] = "baseline"
    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    kind: Literal["dwa"] = "dwa"
    robot_radius: PositiveLength | None = default(
        None, "Radius of the robot, m; unset: the robot's own outline."
    )
    person_radius: NonNegativeLength = default(
        0.33, "Disc that is kept clear around legs; 0: legs alone, m."
    )
    speed: Annotated[float, Gt(0), Le(1)] = default(
        1.0, "Cruising speed as a fraction of the robot's largest."
    )
    window: PositiveDuration = default(
        0.5, "Candidates are the velocities reachable in this time, s."
    )
    speeds: Annotated[int, Ge(2), Le(32)] = default(6, "Candidate speeds.")
    yaw_rates: Annotated[int, Ge(3), Le(64)] = default(15, "Candidate yaw rates.")
    horizon: PositiveDuration = default(2.5, "Length of a rollout, s.")
    turn_time: PositiveDuration = default(
        1.0, "Time on the arc; the rest of a rollout is straight, s."
    )
    margin: NonNegativeLength = default(0.06, "Clearance that is never given up, m.")
    comfort: PositiveLength = default(0.4, "Clearance above which more is no better, m.")
    margin_growth: NonNegativeSpeed = default(
        0.05, "Clearance lost to doubt, per second ahead, m/s."
    )
    look_ahead: PositiveDuration = default(4.0, "Time for which a direction should stay free, s.")
    swerve: PositiveAngle = default(
        1.3, "Largest angle from the goal's bearing where people walk, rad."
    )
    hold: Weight = default(0.3, "Weight of keeping to the last direction; half where people stand.")
    look_back: NonNegativeDuration = default(
        0.3, "Age of the scan that shows what moves; 0 takes all as still, s."
    )
    max_obstacle_speed: PositiveSpeed = default(2.5, "Faster apparent motion is a mismatch, m/s.")
    patience: PositiveDuration = default(
        3.0, "Time without progress before the robot tries to get out, s."
    )
    progress: Weight = default(1.0, "Weight of way made in the direction.")
    heading: Weight = default(0.4, "Weight of the final heading.")
    clearance: Weight = default(0.6, "Weight of the closest approach.")
    impact: Weight = default(1.2, "Weight of an early predicted hit.")
    near_sensors: bool = near_sensors_field()
    smoothness: Weight = default(0.05, "Weight of a change of command.")

    @property
    def wants(self) -> tuple[str, ...]:
        """Return the near sensors, if they are to be used."""
        return NEAR_SENSORS if self.near_sensors else ()


DWA = Component(
    spec=DwaSpec,
    summary="dynamic window approach on lidar points (Fox, Burgard, Thrun 1997)",
)
