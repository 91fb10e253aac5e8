"""Observation of the ground truth, in the world frame."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Le

from crowdbot.plugin import Component, ObservationSpec, PositiveLength, PositiveSpeed, default

Everyone = Annotated[int, Ge(1), Le(4096)]


class TruthSpec(ObservationSpec):
    """Pose, goal and motion of the robot, and all people, in the world's frame; it is privileged.

    First x and y of the robot and of its goal divided by ``extent``, cosine and sine of its
    heading, and v, w and vy divided by their limits; then for each person 1 (0 for no one), x and y
    divided by ``extent``, velocity x and y divided by ``fastest``, and the radius in metres.
    """

    kind: Literal["truth"] = "truth"
    privileged: ClassVar[bool] = True
    people: Everyone = default(100, "Room for this many; the rest is left out.")
    extent: PositiveLength = default(50.0, "Largest coordinate, m.")
    fastest: PositiveSpeed = default(3.0, "Faster people are this fast, m/s.")


TRUTH = Component(spec=TruthSpec, summary="everything, in the world's frame")
