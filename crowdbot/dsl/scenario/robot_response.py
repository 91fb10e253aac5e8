"""How people take robots: behaviour, not contact; chosen by ``kind``, `human` if none is named.

Sources of the numbers: docs/reference/crowd.md.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar, Literal

from annotated_types import Ge, Gt, Le, Lt
from pydantic import BeforeValidator, Field, model_validator

from crowdbot.dsl.spec.quantities import (
    NonNegativeDuration,
    NonNegativeLength,
    NonNegativeSpeed,
    NonNegativeSteeringStiffness,
    PositiveAcceleration,
    PositiveDuration,
    PositiveLength,
    PositiveSpeed,
    Quantity,
)
from crowdbot.dsl.spec.spec import Spec


class RobotResponse(Spec):
    """How people respond to the robot: their behaviour, not contact.

    People who yield see it and keep clear of it, in the way that `kind` says. People who ignore it
    walk as if it were not there, until they touch it. People who are distracted ignore a robot that
    moves, but stop short of one that stands, as of anything that stands in their way.
    """

    category: ClassVar[str] = "robot response"
    #: The kind of a response that names none.
    usual: ClassVar[str] = "human"
    kind: str = Field(description="Name of the response.")
    reaction: Literal["yield", "ignore", "mixed", "distracted"] = Field(
        default="yield",
        description="Who takes notice of the robot: all, nobody, or some; with `distracted`, "
        "some while it moves and all when it stands.",
    )
    ignoring_fraction: Annotated[float, Gt(0), Lt(1)] | None = Field(
        default=None,
        description="With `mixed` or `distracted`: the fraction of people who ignore the robot, "
        "the least attentive ones.",
    )
    margin: NonNegativeLength = Field(
        default=0.25,
        description="Perceived radius minus real radius of the robot, m, of the disc that crowd "
        "policies are shown; and how far around the outline `keep_off` acts.",
    )
    velocity: Literal["visible", "hidden"] = Field(
        default="visible", description="Whether people see how the robot moves."
    )

    @model_validator(mode="after")
    def _fraction_of_a_mixture(self) -> RobotResponse:
        some = self.reaction in ("mixed", "distracted")
        if some != (self.ignoring_fraction is not None):
            raise ValueError("reaction 'mixed' or 'distracted' and ignoring_fraction go together")
        return self

    @property
    def all_stop_short(self) -> bool:
        """Whether those who ignore a robot that moves stop short of one that stands."""
        return self.reaction == "distracted"

    @property
    def ignoring(self) -> float:
        """Fraction of people who ignore the robot."""
        if self.ignoring_fraction is not None:
            return self.ignoring_fraction
        return 1.0 if self.reaction == "ignore" else 0.0

    @property
    def late(self) -> float:
        """Fraction of those who do not ignore the robot who notice it late."""
        return 0.0


class HumanResponse(RobotResponse):
    """People notice a robot, react after a while, and evade it no faster than legs can.

    They look ahead, step aside in time and brake. Some notice late. Nobody is thrown aside, and
    nobody who takes notice of the robot walks into it while it stands.
    """

    kind: Literal["human"] = Field(default="human", description="Name of the response.")
    late_fraction: Annotated[float, Ge(0), Le(1)] = Field(
        default=0.4,
        description="Fraction who notice late, of those who do not ignore the robot; the least "
        "attentive ones.",
    )
    late_time: NonNegativeDuration = Field(
        default=0.7, description="Time to contact at which late people notice the robot, s."
    )
    late_time_standing: NonNegativeDuration = Field(
        default=2.5, description="The same where the robot stands, s."
    )
    late_gap: NonNegativeLength = Field(
        default=0.3, description="Surface gap at which late people notice it in any case, m."
    )
    sight: PositiveLength = Field(
        default=6.0,
        description="Surface gap within which attentive people notice the robot, and beyond "
        "which everybody forgets it, m.",
    )
    field_of_view: Annotated[float, Gt(0), Le(math.tau), Quantity("angle")] = Field(
        default=math.radians(200.0),
        description="Full angle about the way faced in which people notice the robot, rad.",
    )
    reaction_time: NonNegativeDuration = Field(
        default=0.3, description="From noticing to doing something, s."
    )
    horizon: PositiveDuration = Field(
        default=3.0, description="How far ahead in time people look, s."
    )
    clearance: NonNegativeLength = Field(
        default=0.25, description="Surface gap that people want when they pass, m."
    )
    lateral_acceleration: PositiveAcceleration = Field(
        default=2.0, description="Largest acceleration sideways, m/s^2."
    )
    braking: PositiveAcceleration = Field(
        default=3.0, description="Largest deceleration of a person, m/s^2."
    )
    total_acceleration: PositiveAcceleration = Field(
        default=3.0,
        description="Largest acceleration by policy and evasion together, m/s^2.",
    )
    stop_gap: NonNegativeLength = Field(
        default=0.25, description="Surface gap at which those who brake come to rest, m."
    )
    standing_speed: NonNegativeSpeed = Field(
        default=0.05, description="A robot at most this fast stands, m/s."
    )
    moving_speed: PositiveSpeed = Field(
        default=0.3, description="A robot at least this fast moves, m/s."
    )
    standing_gap: NonNegativeLength = Field(
        default=0.2, description="Surface gap that people keep to a robot that stands, m."
    )
    standing_stiffness: NonNegativeSteeringStiffness = Field(
        default=100.0, description="How firmly people who are pushed keep that gap, 1/s^2."
    )
    shown_to_policies: bool = Field(
        default=False,
        description="Whether the crowd policies of attentive people are shown the robot, too.",
    )

    @model_validator(mode="after")
    def _standing_is_slower(self) -> HumanResponse:
        if not self.standing_speed < self.moving_speed:
            raise ValueError("standing_speed must be smaller than moving_speed")
        return self

    @property
    def late(self) -> float:
        """Fraction of those who do not ignore the robot who notice it late."""
        return self.late_fraction


class KeepOffResponse(RobotResponse):
    """A force within `margin` of the outline: the response before 2026-11-22, for comparison.

    `stiffness × overlap` drives people out of the margin, without a limit. It throws them
    aside at 8 to 10 m/s² and lets a blind robot through; see decision 0017.
    """

    kind: Literal["keep_off"] = Field(default="keep_off", description="Name of the response.")
    stiffness_moving: NonNegativeSteeringStiffness = Field(
        default=62.5, description="Steering stiffness beside a moving robot, 1/s^2."
    )
    stiffness_stopped: NonNegativeSteeringStiffness = Field(
        default=125.0, description="Steering stiffness beside a stopped robot, 1/s^2."
    )
    slow_speed: PositiveSpeed = Field(
        default=0.2, description="Below this robot speed the stiffness rises linearly, m/s."
    )

    @model_validator(mode="after")
    def _acts_on_who_takes_notice(self) -> KeepOffResponse:
        if self.all_stop_short:
            raise ValueError("keep_off has no reaction 'distracted'; choose 'mixed'")
        return self


def _usual(value: Any) -> Any:
    return {"kind": RobotResponse.usual, **value} if isinstance(value, dict) else value


#: One of the responses; of the usual kind where none is named.
RobotResponseChoice = Annotated[
    Annotated[HumanResponse | KeepOffResponse, Field(discriminator="kind")],
    BeforeValidator(_usual),
]

__all__ = ["HumanResponse", "KeepOffResponse", "RobotResponse", "RobotResponseChoice"]
