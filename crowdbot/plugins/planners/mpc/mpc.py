"""MPC: a nonlinear program over velocities, with predicted people, solved in each step."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le

from crowdbot.plugin import (
    Component,
    NonNegativeLength,
    NonNegativeSpeed,
    PositiveDuration,
    default,
)
from crowdbot.plugins.planners.shared.rungs import RungSpec

Weight = Annotated[float, Ge(0)]


class MpcSpec(RungSpec):
    """Parameters of the MPC, which needs ``crowdbot[mpc]`` (CasADi).

    Weights are of squared residuals.
    """

    kind: Literal["mpc"] = "mpc"
    person_radius: NonNegativeLength = default(0.22, "Disc that is kept clear around people, m.")
    horizon: PositiveDuration = default(3.0, "Length of a plan, s.", le=10.0)
    stages: Annotated[int, Ge(3), Le(40)] = default(
        12, "Velocities of a plan, each for an equal part of the horizon."
    )
    iterations: Annotated[int, Ge(1), Le(50)] = default(4, "Most quadratic programs for a plan.")
    neighbours: Annotated[int, Ge(1), Le(20)] = default(
        6, "People who constrain a stage, those who come nearest."
    )
    planes: Annotated[int, Ge(1), Le(8)] = default(
        3, "Half-planes of what stands that bound the free space of a stage."
    )
    margin: NonNegativeLength = default(0.12, "Clearance below which closeness costs, m.")
    margin_growth: NonNegativeSpeed = default(
        0.03, "Growth of this clearance to people with time ahead, m/s."
    )
    touch: NonNegativeLength = default(
        0.05, "Clearance that must remain while the robot brakes, m."
    )
    progress: Weight = default(1.0, "Weight of speed lost towards the goal.")
    contour: Weight = default(0.02, "Weight of the way off the straight line.")
    heading: Weight = default(0.2, "Weight of the angle to the goal.")
    closeness: Weight = default(30.0, "Weight of clearance that people lack.")
    walls: Weight = default(60.0, "Weight of clearance that walls lack.")
    smoothness: Weight = default(0.05, "Weight of changes of velocity.")
    patience: Annotated[float, Gt(0), Le(1)] = default(
        0.9, "A plan on another side is taken if it costs less than this share of the last."
    )


MPC = Component(
    spec=MpcSpec,
    summary="nonlinear model-predictive control among predicted people (CasADi; crowdbot[mpc])",
)
