"""Dense reward: progress to the goal, less costs."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Le
from pydantic import Field

from crowdbot.plugin import Component, RewardSpec

Amount = Annotated[float, Ge(0.0), Le(1e6)]


class ProgressSpec(RewardSpec):
    """Progress in metres, and costs of time, contact, forcing people aside, walls and jerks."""

    kind: Literal["progress"] = "progress"
    progress: Amount = Field(default=1.0, description="For each metre nearer to the goal, 1/m.")
    arrival: Amount = Field(default=5.0, description="For arriving, a number.")
    time: Amount = Field(default=0.05, description="Taken off for each second, 1/s.")
    contact: Amount = Field(default=5.0, description="Taken off for each second of contact, 1/s.")
    touch: Amount = Field(
        default=0.0, description="Taken off for each step in which a person touches it, a number."
    )
    forced: Amount = Field(
        default=0.0,
        description="Taken off for each J/kg of work against people who evade at the last moment, "
        "kg/J.",
    )
    aside: Amount = Field(
        default=0.0, description="Taken off for each person who is driven aside, a number."
    )
    wall: Amount = Field(
        default=1.0, description="Taken off for each second stopped by a wall, 1/s."
    )
    change: Amount = Field(
        default=0.01,
        description="Taken off for a change of the command by its whole range, a number.",
    )


PROGRESS = Component(spec=ProgressSpec, summary="progress to the goal, at each step")
