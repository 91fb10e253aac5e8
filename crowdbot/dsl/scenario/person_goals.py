"""Goals that are people: approach, follow, accompany and lead a person or a group.

Distances are gaps between surfaces: the robot's outline, and the disc of the person or the circle
around the group. The zones of Hall (The Hidden Dimension, 1966) have their borders at 0.45, 1.2 and
3.6 m. docs/reference/people_as_goals.md has the source of each default.
"""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Gt, Le
from pydantic import Field, model_validator

from crowdbot.dsl.spec.default import default
from crowdbot.dsl.spec.quantities import (
    NonNegativeLength,
    PositiveDuration,
    PositiveLength,
    Quantity,
)
from crowdbot.dsl.spec.spec import Spec

_Sector = Annotated[float, Gt(0), Le(math.pi), Quantity("angle")]
_AngleError = Annotated[float, Ge(0), Le(math.pi), Quantity("angle")]


class WhichPerson(Spec):
    """A person or a group of the crowd: a number, a name, or one drawn by the crowd's seed."""

    agent: Annotated[int, Ge(0), Le(2**31 - 1)] | None = default(
        None, "Number of an explicit agent."
    )
    group: Annotated[int, Ge(0), Le(2**31 - 1)] | None = default(
        None, "Number of a group of explicit agents: all of them together."
    )
    spawn: str | None = default(
        None, "Name of a spawn, of whose people the crowd's seed draws one."
    )
    stream: str | None = default(
        None, "Name of a stream, of whose people the crowd's seed draws one."
    )
    whole_group: bool = default(False, "With spawn or stream: the group of the drawn person.")

    @property
    def written(self) -> tuple[str, ...]:
        """Return the names of the given fields that identify the person."""
        names = ("agent", "group", "spawn", "stream")
        return tuple(name for name in names if getattr(self, name) is not None)

    @model_validator(mode="after")
    def _one_way(self) -> WhichPerson:
        if len(self.written) != 1:
            given = " and ".join(f"'{name}'" for name in self.written) or "none"
            raise ValueError(f"write one of 'agent', 'group', 'spawn' and 'stream', not {given}")
        if self.whole_group and self.written[0] in ("agent", "group"):
            raise ValueError("'whole_group' belongs to 'spawn' and 'stream'; write 'group' instead")
        return self

    def __str__(self) -> str:
        """Return the person's name for messages, such as ``agent 3``."""
        (name,) = self.written
        value = getattr(self, name)
        text = f"{name} {value}" if name in ("agent", "group") else f"{name} '{value}'"
        return f"a group of {text}" if self.whole_group else text


class TaskGoal(Spec):
    """A goal: a zone to reach, or a person to be with."""

    #: The default kind of goal.
    usual: ClassVar[str] = "zone"
    kind: str = Field(description="A zone, or what to do with a person.")


class PersonGoal(TaskGoal):
    """Fields shared by all goals about a person."""

    #: True if the time in place counts only without interruption.
    in_a_row: ClassVar[bool] = False
    person: WhichPerson = Field(description="Which person or group.")
    knows: Literal["tracked", "told"] = default(
        "tracked",
        "How the robot knows where the person is. tracked: one pose at the start, as "
        "one who points at a person gives it, then its own lidars; told: the pose four times a "
        "second, as from a device that the person wears.",
    )
    position_error: NonNegativeLength = default(
        0.15, "Standard deviation of a pose that the robot gets, each axis, m."
    )
    heading_error: _AngleError = default(
        math.radians(10.0), "Standard deviation of the facing direction that the robot gets, rad."
    )
    distance: PositiveLength = Field(description="Wanted gap between robot and person, m.")
    tolerance: PositiveLength = Field(
        description="How much the gap may differ from `distance` in place, m."
    )
    angle: _Sector = Field(
        description="How much the direction from the person to the robot may differ, rad."
    )

    @model_validator(mode="after")
    def _apart(self) -> PersonGoal:
        if self.tolerance >= self.distance:
            raise ValueError(
                f"tolerance ({self.tolerance:g} m) is less than distance ({self.distance:g} m): "
                "touching the person is never in place"
            )
        return self


class ApproachGoal(PersonGoal):
    """Come to a person from the front, to social distance, and face the person."""

    in_a_row: ClassVar[bool] = True
    kind: Literal["approach"] = "approach"
    distance: PositiveLength = default(1.5, "Wanted gap, m.")
    tolerance: PositiveLength = default(0.4, "Allowed difference of the gap, m.")
    angle: _Sector = default(math.radians(45.0), "Allowed angle off the person's front, rad.")
    hold: PositiveDuration = default(2.0, "The task is done after this time in place, in a row, s.")


class FollowGoal(PersonGoal):
    """Stay behind a person."""

    kind: Literal["follow"] = "follow"
    distance: PositiveLength = default(1.2, "Wanted gap, m.")
    tolerance: PositiveLength = default(0.6, "Allowed difference of the gap, m.")
    angle: _Sector = default(math.radians(60.0), "Allowed angle off the person's back, rad.")
    hold: PositiveDuration = default(20.0, "The task is done after this time in place, in all, s.")


class AccompanyGoal(PersonGoal):
    """Go beside a person."""

    kind: Literal["accompany"] = "accompany"
    side: Literal["left", "right", "either"] = default(
        "either", "Side of the person, as the person sees it."
    )
    distance: PositiveLength = default(0.75, "Wanted gap, m.")
    tolerance: PositiveLength = default(0.5, "Allowed difference of the gap, m.")
    angle: _Sector = default(math.radians(50.0), "Allowed angle off the person's side, rad.")
    hold: PositiveDuration = default(20.0, "The task is done after this time in place, in all, s.")


class LeadGoal(PersonGoal):
    """Go ahead of a person into a zone; the person follows, and must be near the robot there.

    The person has no goal but the robot: walks towards it, stops `keeps` away, and stands while it
    is farther than `loses`. The limits are those of all people.
    """

    kind: Literal["lead"] = "lead"
    zone: str = Field(description="Name of the zone to lead the person to.")
    distance: PositiveLength = default(1.2, "Wanted gap, m.")
    tolerance: PositiveLength = default(0.75, "Allowed difference of the gap, m.")
    angle: _Sector = default(math.radians(60.0), "Allowed angle off the person's front, rad.")
    keeps: PositiveLength = default(1.0, "Gap to the robot at which the person stops, m.")
    loses: PositiveLength = default(4.0, "Gap beyond which the person waits for the robot, m.")

    @model_validator(mode="after")
    def _in_order(self) -> LeadGoal:
        if self.keeps >= self.loses:
            raise ValueError(
                f"keeps ({self.keeps:g} m) is less than loses ({self.loses:g} m): "
                "the person would never walk"
            )
        return self
