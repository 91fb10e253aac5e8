"""Corridor: two side walls, two end walls that stop only the robot, portals beyond the ends."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from crowdbot.dsl import Component, EnvironmentSpec, PositiveLength


class CorridorSpec(EnvironmentSpec):
    """Origin on the centre line of the start wall, x along the corridor."""

    kind: Literal["corridor"] = "corridor"
    length: PositiveLength = Field(default=50.0, description="Length along x, m.")
    width: PositiveLength = Field(default=10.0, description="Width along y, m.")
    wall_height: PositiveLength = Field(default=2.5, description="Height of the walls, m.")


CORRIDOR = Component(
    spec=CorridorSpec,
    build="crowdbot.plugins.environments.corridor_build:build",
    summary="straight corridor; people walk through its ends into portals",
)
