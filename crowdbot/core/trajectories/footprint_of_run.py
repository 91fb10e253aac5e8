"""The robot's footprint in a run."""

from __future__ import annotations

from crowdbot.core.geometry.footprint import Footprint
from crowdbot.core.trajectories.trajectories import Trajectories


def footprint_of(run: Trajectories) -> Footprint | None:
    """Return the outline of a run's robot; None for a disc, or without a robot."""
    if run.robot is None or run.robot_footprint is None:
        return None
    capsule = len(run.robot_footprint) == 2
    return Footprint(run.robot_footprint, run.robot.radius if capsule else 0.0)
