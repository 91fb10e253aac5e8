"""Dense reward: progress to the goal, less costs."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Le

from crowdbot.plugin import Component, RewardSpec, default

Amount = Annotated[float, Ge(0.0), Le(1e6)]


class ProgressSpec(RewardSpec):
    """Progress in metres, and costs of time, contact, forcing people aside, walls and jerks."""

    kind: Literal["progress"] = "progress"
    progress: Amount = default(1.0, "For each metre nearer to the goal, 1/m.")
    arrival: Amount = default(5.0, "For arriving, a number.")
    time: Amount = default(0.05, "Taken off for each second, 1/s.")
    contact: Amount = default(5.0, "Taken off for each second of contact, 1/s.")
    touch: Amount = default(0.0, "Taken off for each step in which a person touches it, a number.")
    forced: Amount = default(
        0.0, "Taken off for each J/kg of work against people who evade at the last moment, kg/J."
    )
    aside: Amount = default(0.0, "Taken off for each person who is driven aside, a number.")
    wall: Amount = default(1.0, "Taken off for each second stopped by a wall, 1/s.")
    change: Amount = default(
        0.01, "Taken off for a change of the command by its whole range, a number."
    )


PROGRESS = Component(spec=ProgressSpec, summary="progress to the goal, at each step")
