"""Safety stop: the user's command, slowed down where the robot could not stop in time."""

from __future__ import annotations

from typing import ClassVar, Literal

from crowdbot.plugin import (
    Component,
    NonNegativeDuration,
    NonNegativeLength,
    PlannerDocument,
    default,
)
from crowdbot.plugins.planners.shared.rungs import LadderSpec


class SafetyStopSpec(LadderSpec):
    """Safeguarded driving: the user drives as long as the robot can stop in time."""

    needs: ClassVar[tuple[str, ...]] = ("joystick", "lidar")
    half: ClassVar[str] = "autonomy"

    kind: Literal["safety_stop"] = "safety_stop"
    autonomy: PlannerDocument | None = default(
        None,
        "Planner that drives while the user's command is not safe: its document, its "
        "kind, or a file; unset: the robot brakes.",
    )
    reaction_time: NonNegativeDuration = default(0.2, "Driven before braking sets in, s.")
    margin: NonNegativeLength = default(0.1, "Free space that is kept around the robot, m.")


SAFETY_STOP = Component(
    spec=SafetyStopSpec,
    summary="what the user asks for, with brakes before a collision",
    examples=({}, {"autonomy": {"kind": "goal_seek"}}),
)
