"""Observation of the nearest people in the robot's frame."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Le

from crowdbot.plugin import Component, ObservationSpec, PositiveLength, PositiveSpeed, default

People = Annotated[int, Ge(1), Le(256)]


class TracksSpec(ObservationSpec):
    """The nearest people, nearest first, then goal and motion; it is privileged.

    Each person has six numbers: 1 (0 for no one, and then all are 0), x and y in the robot's frame
    divided by ``range``, velocity x and y in that frame divided by ``fastest``, and the radius in
    metres. Goal and motion are those of ``lidar_stack``.
    """

    kind: Literal["tracks"] = "tracks"
    privileged: ClassVar[bool] = True
    people: People = default(10, "How many people, at most.")
    range: PositiveLength = default(6.0, "People farther off are not seen, m.")
    fastest: PositiveSpeed = default(3.0, "Faster people are this fast, m/s.")
    goal_range: PositiveLength = default(10.0, "Farther goals are this far, m.")


TRACKS = Component(spec=TracksSpec, summary="nearest people in the robot's frame, as they are")
