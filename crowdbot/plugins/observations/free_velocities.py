"""Observation: for each of a fan of velocities, how long the robot could keep it."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Gt, Le
from pydantic import Field

from crowdbot.plugin import (
    Component,
    NonNegativeLength,
    ObservationSpec,
    PositiveDuration,
    PositiveLength,
    PositiveSpeed,
)

Directions = Annotated[int, Ge(3), Le(181)]
Speeds = Annotated[int, Ge(1), Le(16)]
Sectors = Annotated[int, Ge(4), Le(360)]
People = Annotated[int, Ge(0), Le(64)]
HalfTurn = Annotated[float, Gt(0.0), Le(3.141592653589793)]


class FreeVelocitiesSpec(ObservationSpec):
    """A fan of velocities with the free time and gap of each, nearest obstacles, goal and motion.

    A velocity is a direction beside the robot's heading with a share of its largest speed; the last
    one is to stand. Two numbers say how free it is, if the robot had it now and people kept theirs:
    the time to the first contact with a person or a wall, divided by ``horizon``, and the least gap
    on the way, divided by ``room``; 1 is free. Then follow the gap to what is nearest in each
    sector, divided by ``range``, from behind counter-clockwise; of the nearest people 1 (0 for no
    one, and then all are 0), x and y in the robot's frame divided by ``range``, and their velocity
    in that frame divided by ``fastest``; and goal and motion as of ``lidar_stack``. People are
    those whom the people tracker follows in the lidars; in a batch of worlds, where there is no
    tracker, those who are within ``range``. So the policy is not privileged.
    """

    kind: Literal["free_velocities"] = "free_velocities"
    tracks: ClassVar[bool] = True
    sensor: str = Field(default="lidar", description="Name or category of the lidar.")
    others: tuple[str, ...] = Field(default=(), strict=False, description="Further lidars.")
    directions: Directions = Field(default=17, description="Directions of the fan.")
    widest: HalfTurn = Field(default=2.0, description="Angle of the outermost directions, rad.")
    speeds: Speeds = Field(default=2, description="Speeds, evenly up to the largest one.")
    horizon: PositiveDuration = Field(default=4.0, description="Later contacts do not count, s.")
    room: PositiveLength = Field(default=0.8, description="A larger gap is no better, m.")
    sectors: Sectors = Field(default=12, description="Sectors of equal width around the robot.")
    people: People = Field(default=8, description="How many people are listed, at most.")
    person_radius: NonNegativeLength = Field(default=0.33, description="Radius of people, m.")
    range: PositiveLength = Field(default=6.0, description="What is farther is not seen, m.")
    fastest: PositiveSpeed = Field(default=3.0, description="Faster people are this fast, m/s.")
    goal_range: PositiveLength = Field(default=10.0, description="Farther goals are this far, m.")

    @property
    def needs(self) -> tuple[str, ...]:
        """Return the needed lidars."""
        return (self.sensor, *self.others)


FREE_VELOCITIES = Component(
    spec=FreeVelocitiesSpec,
    summary="how long each of a fan of velocities is free of people and walls",
)
