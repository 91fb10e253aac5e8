"""Two robots: a trolley on two wheels, and a puck that goes in every direction."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import Field

from crowdbot.plugin import Component, PositiveMass, PositiveSpeed, RobotSpec, hookimpl


class TrolleySpec(RobotSpec):
    """Two driven wheels, a caster and a mast, as described in trolley.urdf."""

    kind: Literal["my_robots.trolley"] = "my_robots.trolley"
    max_speed: PositiveSpeed = Field(default=0.8, description="Largest |v|, m/s.")


class PuckSpec(RobotSpec):
    """A flat cylinder on omni wheels."""

    controls: ClassVar[tuple[str, ...]] = ("force", "kinematic")
    kind: Literal["my_robots.puck"] = "my_robots.puck"
    mass: PositiveMass = Field(default=12.0, description="Whole robot, kg.")


TROLLEY = Component(
    spec=TrolleySpec, build="my_robots.trolley_build:build", summary="trolley on two wheels"
)
PUCK = Component(
    spec=PuckSpec, build="my_robots.puck_build:build", summary="puck that also goes sideways"
)


@hookimpl
def crowdbot_components() -> dict[str, list[Component[RobotSpec]]]:
    return {"robot": [TROLLEY, PUCK]}
