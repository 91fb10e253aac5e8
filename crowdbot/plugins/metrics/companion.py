"""Metrics of tasks whose goal is a person: success, place, and the person's comfort."""

from __future__ import annotations

from functools import partial
from typing import Literal

from crowdbot.plugin import MetricSpec, PositiveDuration, declare_metric, default
from crowdbot.plugins.metrics.parameters import Intimate, JumpSpeed, Social

#: Two metrics change where a person passes a portal.
POSITIONS = "positions of robot and person are compared"

declare = partial(declare_metric, category="person", about_person=True, minimum=0.0)


class AssistedSpec(MetricSpec):
    """1 if the task about the person was done without touching or crowding the person, else 0."""

    kind: Literal["assisted"] = "assisted"
    intimate: Intimate
    jump_speed: JumpSpeed


ASSISTED = declare(AssistedSpec, symbol="S_p", unit="1", better="higher", maximum=1.0, integer=True)


class TimeInPlaceSpec(MetricSpec):
    """Share of time in which the robot is in its place beside the person."""

    kind: Literal["time_in_place"] = "time_in_place"
    jump_speed: JumpSpeed


TIME_IN_PLACE = declare(
    TimeInPlaceSpec,
    symbol="f_pl",
    unit="1",
    better="higher",
    maximum=1.0,
    variants=("corrected", "since"),
)


class TimeToPlaceSpec(MetricSpec):
    """Time until the robot is in its place beside the person for the first time."""

    kind: Literal["time_to_place"] = "time_to_place"
    jump_speed: JumpSpeed


TIME_TO_PLACE = declare(TimeToPlaceSpec, symbol="T_pl", unit="s", better="lower")


class PersonDistanceErrorSpec(MetricSpec):
    """Difference of the gap between robot and person from the wanted one."""

    kind: Literal["person_distance_error"] = "person_distance_error"
    jump_speed: JumpSpeed


PERSON_DISTANCE_ERROR = declare(
    PersonDistanceErrorSpec,
    symbol="e_d",
    unit="m",
    better="lower",
    changes_with={"teleport": POSITIONS},
)


class PersonAngleErrorSpec(MetricSpec):
    """Angle between the wanted direction from the person and the robot's."""

    kind: Literal["person_angle_error"] = "person_angle_error"
    jump_speed: JumpSpeed


PERSON_ANGLE_ERROR = declare(
    PersonAngleErrorSpec,
    symbol="e_α",
    unit="rad",
    better="lower",
    maximum=3.15,
    changes_with={"teleport": POSITIONS},
)


class PersonComfortSpec(MetricSpec):
    """1 less the discomfort of the person: a robot within the intimate zone, or that rushes in."""

    kind: Literal["person_comfort"] = "person_comfort"
    intimate: Intimate
    social: Social
    rush_time: PositiveDuration = default(
        1.0, "A robot that would touch the person sooner rushes, s."
    )
    jump_speed: JumpSpeed


PERSON_COMFORT = declare(PersonComfortSpec, symbol="C_p", unit="1", better="higher", maximum=1.0)
