"""An office: two rooms and a door between them."""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import Component, EnvironmentSpec, PositiveLength
from pydantic import Field, model_validator


class OfficeSpec(EnvironmentSpec):
    """Rooms along x from the origin on; the door is in the middle of the wall between them."""

    kind: Literal["acme.office"] = "acme.office"
    length: PositiveLength = Field(default=12.0, description="Both rooms along x, m.")
    width: PositiveLength = Field(default=6.0, description="Along y, m.")
    door: PositiveLength = Field(default=1.6, description="Width of the door, m.")
    thickness: PositiveLength = Field(default=0.15, description="Of the wall between, m.")
    wall_height: PositiveLength = Field(default=2.6, description="Height of all walls, m.")

    @model_validator(mode="after")
    def _door_fits(self) -> OfficeSpec:
        if self.door >= self.width:
            raise ValueError("the door must be narrower than the office")
        return self


OFFICE = Component(
    spec=OfficeSpec,
    build="crowdbot_acme.office_build:build",
    summary="two rooms and a door between them",
    examples=(
        {
            "zones": {
                "left": {"x": ["1 m", "3 m"], "y": ["-1 m", "1 m"]},
                "right": {"x": ["9 m", "11 m"], "y": ["-1 m", "1 m"]},
            }
        },
        {"door": "2.5 m"},
    ),
)
