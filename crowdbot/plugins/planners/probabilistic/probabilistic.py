"""Probabilistic shared control: the most likely path of user, robot and crowd together."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Gt, Le, Lt

from crowdbot.plugin import (
    Component,
    PlannerDocument,
    PositiveDuration,
    PositiveLength,
    PositiveSpeed,
    default,
)
from crowdbot.plugins.planners.shared.rungs import LadderSpec


class ProbabilisticSpec(LadderSpec):
    """Joint distribution of Trautman, with Gaussians of constant velocity for the processes."""

    needs: ClassVar[tuple[str, ...]] = ("joystick", "lidar")
    half: ClassVar[str] = "autonomy"

    kind: Literal["probabilistic"] = "probabilistic"
    autonomy: PlannerDocument = default(
        {"kind": "dwa"},
        "The planner whose way the robot would take alone: its document, its kind, or a file.",
    )
    horizon: PositiveDuration = default(2.0, "Length of the ways, s.", le=5.0)
    agreeability: PositiveLength = default(
        0.3, "Distance of the robot's way from the user's that agrees, m."
    )
    user_spread: PositiveSpeed = default(0.5, "Spread of the user's way, growing with time, m/s.")
    robot_spread: PositiveSpeed = default(
        0.8, "Spread of the planner's way, growing with time, m/s."
    )
    people_spread: PositiveSpeed = default(
        0.15, "Spread of the velocities with which people may go on, in each direction, m/s."
    )
    avoidance: Annotated[float, Gt(0), Lt(1)] = default(
        0.9999, "Interaction with people and walls, a fraction."
    )
    safety: PositiveLength = default(0.3, "Gap at which that interaction has fallen to 61 %, m.")
    standing: Annotated[float, Gt(0), Le(1)] = default(
        0.7,
        "Share of a contact with a person that counts where the robot stands; from "
        "0.5 m/s on all of it does.",
    )
    window: PositiveDuration = default(0.5, "Candidates are reachable in this time, s.")
    speeds: Annotated[int, Ge(2), Le(20)] = default(6, "Number of speeds.")
    yaw_rates: Annotated[int, Ge(3), Le(41)] = default(15, "Number of yaw rates.")


PROBABILISTIC = Component(
    spec=ProbabilisticSpec,
    summary="most likely way of user, robot and crowd together (Trautman 2015)",
    examples=({}, {"autonomy": {"kind": "goal_seek"}}),
)
