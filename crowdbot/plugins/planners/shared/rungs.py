"""Parameters of planners on the ladder of sensing, which reason about people."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Gt, Le

from crowdbot.plugin import NonNegativeLength, PlannerSpec, PositiveLength, default
from crowdbot.plugins.planners.shared.near_sensors import NEAR_SENSORS, near_sensors_field


class LadderSpec(PlannerSpec):
    """The ladder of sensing: the same planner with increasingly better knowledge.

    On its last rungs, ``truth``, the planner is privileged.
    """

    needs: ClassVar[tuple[str, ...]] = ("lidar",)

    tracks: Literal["lidar", "tracker", "truth"] = default(
        "tracker", "People: of the last scans, as the people tracker follows them, or the truth."
    )
    localisation: Literal["odometry", "corrected", "truth"] = default(
        "corrected", "The robot's pose: by wheels, with the heading of walls, or the truth."
    )
    robot_radius: PositiveLength | None = default(
        None, "Radius of the robot, m; unset: the robot's own outline."
    )
    person_radius: NonNegativeLength = default(0.25, "Disc that is kept clear around people, m.")

    near_sensors: bool = near_sensors_field()

    @property
    def wants(self) -> tuple[str, ...]:
        """Return the near sensors, if it takes them."""
        return NEAR_SENSORS if self.near_sensors else ()

    @property
    def privileged(self) -> bool:
        """Return True if the planner gets the ground truth."""
        return "truth" in (self.tracks, self.localisation)


class RungSpec(LadderSpec):
    """A planner on the ladder of sensing that drives the robot, without a user."""

    speed: Annotated[float, Gt(0), Le(1)] = default(
        1.0, "Cruising speed as a fraction of the robot's largest."
    )
