"""Linear blending: a weighted mean of the commands of user and planner."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Le
from pydantic import model_validator

from crowdbot.plugin import (
    Component,
    NonNegativeLength,
    PlannerDocument,
    PositiveDuration,
    PositiveLength,
    default,
)
from crowdbot.plugins.planners.shared.rungs import LadderSpec

Share = Annotated[float, Ge(0), Le(1)]


class LinearBlendingSpec(LadderSpec):
    """Policy blending: the planner's share is fixed, or depends on a distance."""

    needs: ClassVar[tuple[str, ...]] = ("joystick", "lidar")
    half: ClassVar[str] = "autonomy"

    kind: Literal["linear_blending"] = "linear_blending"
    autonomy: PlannerDocument = default(
        {"kind": "dwa"}, "The planner to blend with: its document, its kind, or a file."
    )
    arbitration: Literal["fixed", "goal", "obstacle"] = default(
        "obstacle",
        "The planner's share: `share`, or rising from `least` to `most` towards the "
        "goal or an obstacle.",
    )
    share: Share = default(0.5, "The planner's share if it is fixed.")
    least: Share = default(0.0, "Its share farther away than `distance`.")
    most: Share = default(0.9, "Its share nearer than `full_distance`.")
    distance: PositiveLength = default(2.0, "To the goal, or of the user's way to an obstacle, m.")
    full_distance: NonNegativeLength = default(
        0.3, "As `distance`, where the share is at its most, m."
    )
    look_ahead: PositiveDuration = default(
        1.5, "Obstacles count that the user's way comes near to in it, s."
    )

    @model_validator(mode="after")
    def _in_order(self) -> LinearBlendingSpec:
        if self.full_distance >= self.distance:
            raise ValueError(
                f"full_distance ({self.full_distance:g} m) is less than distance "
                f"({self.distance:g} m)"
            )
        return self


LINEAR_BLENDING = Component(
    spec=LinearBlendingSpec,
    summary="weighted mean of user and planner (Dragan, Srinivasa 2013)",
    examples=({}, {"arbitration": "fixed", "autonomy": {"kind": "goal_seek"}}),
)
