"""Probabilistic shared control: the most likely path of user, robot and crowd together."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Gt, Le, Lt
from pydantic import Field

from crowdbot.plugin import (
    Component,
    PlannerDocument,
    PositiveDuration,
    PositiveLength,
    PositiveSpeed,
)
from crowdbot.plugins.planners.shared.rungs import LadderSpec


class ProbabilisticSpec(LadderSpec):
    """Joint distribution of Trautman, with Gaussians of constant velocity for the processes."""

    needs: ClassVar[tuple[str, ...]] = ("joystick", "lidar")
    half: ClassVar[str] = "autonomy"

    kind: Literal["probabilistic"] = "probabilistic"
    autonomy: PlannerDocument = Field(
        default={"kind": "dwa"},
        description="The planner whose way the robot would take alone: its document, its kind, "
        "or a file.",
    )
    horizon: PositiveDuration = Field(default=2.0, le=5.0, description="Length of the ways, s.")
    agreeability: PositiveLength = Field(
        default=0.3, description="Distance of the robot's way from the user's that agrees, m."
    )
    user_spread: PositiveSpeed = Field(
        default=0.5, description="Spread of the user's way, growing with time, m/s."
    )
    robot_spread: PositiveSpeed = Field(
        default=0.8, description="Spread of the planner's way, growing with time, m/s."
    )
    people_spread: PositiveSpeed = Field(
        default=0.15,
        description="Spread of the velocities with which people may go on, in each direction, m/s.",
    )
    avoidance: Annotated[float, Gt(0), Lt(1)] = Field(
        default=0.9999, description="Interaction with people and walls, a fraction."
    )
    safety: PositiveLength = Field(
        default=0.3, description="Gap at which that interaction has fallen to 61 %, m."
    )
    standing: Annotated[float, Gt(0), Le(1)] = Field(
        default=0.7,
        description="Share of a contact with a person that counts where the robot stands; from "
        "0.5 m/s on all of it does.",
    )
    window: PositiveDuration = Field(
        default=0.5, description="Candidates are reachable in this time, s."
    )
    speeds: Annotated[int, Ge(2), Le(20)] = Field(default=6, description="Number of speeds.")
    yaw_rates: Annotated[int, Ge(3), Le(41)] = Field(default=15, description="Number of yaw rates.")


PROBABILISTIC = Component(
    spec=ProbabilisticSpec,
    summary="most likely way of user, robot and crowd together (Trautman 2015)",
    examples=({}, {"autonomy": {"kind": "goal_seek"}}),
)
