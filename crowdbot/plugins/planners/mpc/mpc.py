"""MPC: a nonlinear program over velocities, with predicted people, solved in each step."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le
from pydantic import Field

from crowdbot.plugin import Component, NonNegativeLength, NonNegativeSpeed, PositiveDuration
from crowdbot.plugins.planners.shared.rungs import RungSpec

Weight = Annotated[float, Ge(0)]


class MpcSpec(RungSpec):
    """Parameters of the MPC, which needs ``crowdbot[mpc]`` (CasADi).

    Weights are of squared residuals.
    """

    kind: Literal["mpc"] = "mpc"
    person_radius: NonNegativeLength = Field(
        default=0.22, description="Disc that is kept clear around people, m."
    )
    horizon: PositiveDuration = Field(default=3.0, le=10.0, description="Length of a plan, s.")
    stages: Annotated[int, Ge(3), Le(40)] = Field(
        default=12, description="Velocities of a plan, each for an equal part of the horizon."
    )
    iterations: Annotated[int, Ge(1), Le(50)] = Field(
        default=4, description="Most quadratic programs for a plan."
    )
    neighbours: Annotated[int, Ge(1), Le(20)] = Field(
        default=6, description="People who constrain a stage, those who come nearest."
    )
    planes: Annotated[int, Ge(1), Le(8)] = Field(
        default=3, description="Half-planes of what stands that bound the free space of a stage."
    )
    margin: NonNegativeLength = Field(
        default=0.12, description="Clearance below which closeness costs, m."
    )
    margin_growth: NonNegativeSpeed = Field(
        default=0.03, description="Growth of this clearance to people with time ahead, m/s."
    )
    touch: NonNegativeLength = Field(
        default=0.05, description="Clearance that must remain while the robot brakes, m."
    )
    progress: Weight = Field(default=1.0, description="Weight of speed lost towards the goal.")
    contour: Weight = Field(default=0.02, description="Weight of the way off the straight line.")
    heading: Weight = Field(default=0.2, description="Weight of the angle to the goal.")
    closeness: Weight = Field(default=30.0, description="Weight of clearance that people lack.")
    walls: Weight = Field(default=60.0, description="Weight of clearance that walls lack.")
    smoothness: Weight = Field(default=0.05, description="Weight of changes of velocity.")
    patience: Annotated[float, Gt(0), Le(1)] = Field(
        default=0.9,
        description="A plan on another side is taken if it costs less than this share of the last.",
    )


MPC = Component(
    spec=MpcSpec,
    summary="nonlinear model-predictive control among predicted people (CasADi; crowdbot[mpc])",
)
