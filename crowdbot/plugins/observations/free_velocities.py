"""Observation: for each of a fan of velocities, how long the robot could keep it."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Gt, Le

from crowdbot.plugin import (
    Component,
    NonNegativeLength,
    ObservationSpec,
    PositiveDuration,
    PositiveLength,
    PositiveSpeed,
    default,
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
    in that frame divided by ``fastest``; and goal and motion as in ``lidar_stack``. People are
    those whom the people tracker follows in the lidars; in a batch of worlds, where there is no
    tracker, those who are within ``range``. So the policy is not privileged.
    """

    kind: Literal["free_velocities"] = "free_velocities"
    tracks: ClassVar[bool] = True
    sensor: str = default("lidar", "Name or category of the lidar.")
    others: tuple[str, ...] = default((), "Further lidars.", strict=False)
    directions: Directions = default(17, "Directions of the fan.")
    widest: HalfTurn = default(2.0, "Angle of the outermost directions, rad.")
    speeds: Speeds = default(2, "Speeds, evenly up to the largest one.")
    horizon: PositiveDuration = default(4.0, "Later contacts do not count, s.")
    room: PositiveLength = default(0.8, "A larger gap is no better, m.")
    sectors: Sectors = default(12, "Sectors of equal width around the robot.")
    people: People = default(8, "How many people are listed, at most.")
    person_radius: NonNegativeLength = default(0.33, "Radius of people, m.")
    range: PositiveLength = default(6.0, "What is farther is not seen, m.")
    fastest: PositiveSpeed = default(3.0, "Faster people are this fast, m/s.")
    goal_range: PositiveLength = default(10.0, "Farther goals are this far, m.")

    @property
    def needs(self) -> tuple[str, ...]:
        """Return the needed lidars."""
        return (self.sensor, *self.others)


FREE_VELOCITIES = Component(
    spec=FreeVelocitiesSpec,
    summary="how long each of a fan of velocities is free of people and walls",
)
