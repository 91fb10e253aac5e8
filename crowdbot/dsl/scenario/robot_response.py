"""The field ``crowd.robot_response``: people's behaviour towards robots, except contact.

For the sources of the numbers, see docs/reference/crowd.md.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar, Literal

from annotated_types import Ge, Gt, Le, Lt
from pydantic import BeforeValidator, Field, model_validator

from crowdbot.dsl.spec.default import default
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
    """People's response to a robot: fields shared by all kinds.

    They look ahead, step aside in time and brake; some notice late. People who ignore the robot
    walk as if it were not there, until they touch it. Distracted people ignore a moving robot, but
    stop in front of a standing one, as in front of any obstacle.
    """

    category: ClassVar[str] = "robot response"
    #: The default kind of response.
    usual: ClassVar[str] = "human"
    kind: str = Field(description="Name of the response.")
    reaction: Literal["yield", "ignore", "mixed", "distracted"] = default(
        "yield",
        "Who notices the robot: all, none, or some; with `distracted`, "
        "some while it moves and all when it stands.",
    )
    ignoring_fraction: Annotated[float, Gt(0), Lt(1)] | None = default(
        None,
        "With `mixed` or `distracted`: the fraction of people who ignore the robot, "
        "the least attentive ones.",
    )
    margin: NonNegativeLength = default(
        0.25,
        "Perceived radius minus real radius of the robot, m, of the disc that crowd "
        "policies are shown.",
    )
    velocity: Literal["visible", "hidden"] = default(
        "visible", "Whether people see how the robot moves."
    )

    late_fraction: Annotated[float, Ge(0), Le(1)] = default(
        0.4,
        "Fraction who notice late, of those who do not ignore the robot; the least attentive ones.",
    )
    late_time: NonNegativeDuration = default(
        0.7, "Time to contact at which late people notice the robot, s."
    )
    late_time_standing: NonNegativeDuration = default(2.5, "The same where the robot stands, s.")
    late_gap: NonNegativeLength = default(
        0.3, "Surface gap at which late people notice it in any case, m."
    )
    sight: PositiveLength = default(
        6.0,
        "Surface gap within which attentive people notice the robot, and beyond "
        "which everyone forgets it, m.",
    )
    field_of_view: Annotated[float, Gt(0), Le(math.tau), Quantity("angle")] = default(
        math.radians(200.0), "Full angle about the way faced in which people notice the robot, rad."
    )
    reaction_time: NonNegativeDuration = default(0.3, "From noticing to doing something, s.")
    horizon: PositiveDuration = default(3.0, "How far ahead in time people look, s.")
    clearance: NonNegativeLength = default(0.25, "Surface gap that people want when they pass, m.")
    lateral_acceleration: PositiveAcceleration = default(
        2.0, "Largest acceleration sideways, m/s^2."
    )
    braking: PositiveAcceleration = default(3.0, "Largest deceleration of a person, m/s^2.")
    total_acceleration: PositiveAcceleration = default(
        3.0, "Largest acceleration by policy and evasion together, m/s^2."
    )
    stop_gap: NonNegativeLength = default(
        0.25, "Surface gap at which those who brake come to rest, m."
    )
    standing_speed: NonNegativeSpeed = default(0.05, "A robot at most this fast stands, m/s.")
    moving_speed: PositiveSpeed = default(0.3, "A robot at least this fast moves, m/s.")
    standing_gap: NonNegativeLength = default(
        0.2, "Surface gap that people keep to a robot that stands, m."
    )
    standing_stiffness: NonNegativeSteeringStiffness = default(
        100.0, "How firmly people who are pushed keep that gap, 1/s^2."
    )
    shown_to_policies: bool = default(
        False, "Whether the crowd policies of attentive people are shown the robot, too."
    )

    @model_validator(mode="after")
    def _fraction_of_a_mixture(self) -> RobotResponse:
        some = self.reaction in ("mixed", "distracted")
        if some != (self.ignoring_fraction is not None):
            raise ValueError("reaction 'mixed' or 'distracted' and ignoring_fraction go together")
        return self

    @model_validator(mode="after")
    def _standing_is_slower(self) -> RobotResponse:
        if not self.standing_speed < self.moving_speed:
            raise ValueError("standing_speed must be smaller than moving_speed")
        return self

    @property
    def all_stop_short(self) -> bool:
        """Return True if people who ignore a moving robot stop in front of a standing one."""
        return self.reaction == "distracted"

    @property
    def ignoring(self) -> float:
        """Return the fraction of people who ignore the robot."""
        if self.ignoring_fraction is not None:
            return self.ignoring_fraction
        return 1.0 if self.reaction == "ignore" else 0.0

    @property
    def late(self) -> float:
        """Return the fraction of people who react late, among those who do not ignore the robot."""
        return self.late_fraction


class HumanResponse(RobotResponse):
    """People notice a robot, react after a delay, and evade it as fast as people can."""

    kind: Literal["human"] = default("human", "Name of the response.")


class GivingWay(RobotResponse):
    """People give way as recorded near robots and vehicles, and more to faster ones.

    The numbers are fitted to recordings of two robots, a golf cart and cars; see
    docs/explanation/people_near_robots.md.
    """

    kind: Literal["giving_way"] = default("giving_way", "Name of the response.")
    late_fraction: Annotated[float, Ge(0), Le(1)] = default(
        0.01,
        "Fraction who notice late, of those who do not ignore the robot; the least "
        "attentive ones. Recorded: 0 to 1 % (NavWareSet, VCI-CITR, VCI-DUT).",
    )
    sight_time: NonNegativeDuration = default(
        5.0,
        "Time to contact within which attentive people notice a robot beyond `sight`, "
        "s. Recorded onsets: 2.4 to 4 s, at 5 to 16 m (VCI-CITR, VCI-DUT).",
    )
    hears: bool = default(
        True,
        "Whether people hear robots faster than `clearance_speed` that come from "
        "behind, as those in VCI-CITR did.",
    )
    hearing_time: PositiveDuration = default(4.0, "Time to contact within which they hear them, s.")
    horizon: PositiveDuration = default(4.0, "How far ahead in time people look, s.")
    clearance: NonNegativeLength = default(
        0.17,
        "Surface gap that people want when they pass a slow robot, m; the mean over "
        "people. Recorded: median 0.17 m at 0.8 to 1.2 m/s (NavWareSet).",
    )
    clearance_range: NonNegativeLength = default(
        0.25,
        "How much more the most attentive person wants, and how much less the least "
        "attentive, m; never less than 0.02 m in all.",
    )
    clearance_growth: NonNegativeDuration = default(
        0.5,
        "Growth of the clearance with the robot's speed above `clearance_speed`, s. "
        "Recorded: 0.27 to 0.41 s on average up to 6 m/s, steeper below 3 m/s.",
    )
    clearance_speed: NonNegativeSpeed = default(1.0, "A faster robot is a vehicle to people, m/s.")
    most_clearance: NonNegativeLength = default(
        1.2,
        "Largest clearance by that growth, m. Recorded: medians of 1.17 m at 3 to "
        "4 m/s and 1.4 m above (VCI-CITR).",
    )
    yield_time: NonNegativeDuration = default(
        0.6,
        "People pass behind a crossing robot if that way is longer by less than the "
        "robot drives in this time, s; behind a vehicle they leave more room.",
    )
    waiting_speed: NonNegativeSpeed = default(
        1.55,
        "People wait for a faster robot that crosses their way, however long it is, "
        "unless they expect to be clear of it in time, m/s. Recorded: 6 % (VCI-DUT) and 12 % "
        "(VCI-CITR) pass before a vehicle that they would meet.",
        omitted=True,
    )
    speeding_up: PositiveAcceleration = default(
        0.6, "Largest acceleration ahead to pass first, m/s^2."
    )
    intent: NonNegativeDuration = default(
        0.5,
        "People who slowed down expect to walk on: time over which what they want "
        "counts in what they predict, s.",
    )
    lateral_acceleration: PositiveAcceleration = default(
        1.2, "Largest acceleration sideways, m/s^2. Recorded: 95 % below 0.9 to 1.3."
    )


def _usual(value: Any) -> Any:
    """Add the default ``kind`` to a response that names none."""
    return {"kind": RobotResponse.usual, **value} if isinstance(value, dict) else value


#: One of the responses, or the default kind.
RobotResponseChoice = Annotated[
    Annotated[HumanResponse | GivingWay, Field(discriminator="kind")],
    BeforeValidator(_usual),
]
