"""Crowd model: a planner that decides like a person of the crowd engine."""

from __future__ import annotations

from typing import Literal

from crowdbot.plugin import Component, default
from crowdbot.plugins.planners.shared.rungs import RungSpec


class CrowdModelSpec(RungSpec):
    """Follows the velocity that a person in its place would choose; knows the truth by default."""

    kind: Literal["crowd_model"] = "crowd_model"
    tracks: Literal["lidar", "tracker", "truth"] = default(
        "truth", "People: of the last scans, as the people tracker follows them, or the truth."
    )
    localisation: Literal["odometry", "corrected", "truth"] = default(
        "truth", "The robot's pose: by wheels, with the heading of walls, or the truth."
    )
    crowd: str = default("calibrated", "Crowd as whose person the robot decides.")


CROWD_MODEL = Component(
    spec=CrowdModelSpec,
    summary="the robot decides as a person of the crowd engine, privileged by default",
)
