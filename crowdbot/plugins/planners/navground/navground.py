"""navground: behaviours of an independent library as planners, for comparison."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from crowdbot.plugin import Component, NonNegativeLength, PositiveDuration, PositiveLength, default
from crowdbot.plugins.planners.shared.rungs import RungSpec


class NavgroundSpec(RungSpec):
    """Needs ``crowdbot[navground]``; defaults are those of crowdbot's `orca`, where it has them."""

    kind: Literal["navground"] = "navground"
    behavior: Literal["ORCA", "HL", "HRVO", "SocialForce", "Dummy"] = default(
        "ORCA", "Name of the library's behaviour; `Dummy` drives straight on."
    )
    view: PositiveLength = default(
        5.0, "People and points farther than this are not shown to it, m."
    )
    safety_margin: NonNegativeLength = default(0.05, "Added to the robot's radius, m.")
    time_horizon: PositiveDuration = default(2.0, "Of ORCA: time for which nothing is touched, s.")
    settings: dict[Annotated[str, Field(max_length=32)], bool | int | float] = default(
        {}, "Other properties of the behaviour by their names there, such as `eta` of HL."
    )


NAVGROUND = Component(
    spec=NavgroundSpec,
    examples=({"behavior": "HL"},),
    summary="ORCA, HL, HRVO of the library navground, to check ours (crowdbot[navground])",
)
