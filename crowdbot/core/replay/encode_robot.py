"""Packs the robots of a run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from crowdbot.core.replay.pack import pack_words
from crowdbot.core.replay.shown_run import Seen, ShownRun
from crowdbot.core.trajectories.trajectories import RobotTrack
from crowdbot.core.types.arrays import Array


def encode_robots(shown: ShownRun) -> tuple[dict[str, Any], dict[str, str]]:
    """A list of robots, and of each its x, y, theta, v, w (5, N) as float32."""
    run = shown.run
    robots = [] if run.robot is None else [(run.robot, run.robot_footprint, shown.look)]
    about = [_about(*robot) for robot in robots]
    blobs = {f"robot{i}": pack_words(_rows(robot)) for i, (robot, _, _) in enumerate(robots)}
    return {"robots": about}, blobs


def _rows(robot: RobotTrack) -> Array:
    return np.stack((robot.x, robot.y, robot.theta, robot.v, robot.w)).astype("<f4")


def _about(robot: RobotTrack, outline: Array | None, look: Sequence[Seen]) -> dict[str, Any]:
    return {
        "radius": robot.radius,
        "outline": [] if outline is None else np.round(outline, 4).tolist(),
        "goal": robot.goal,
        "goalRadius": robot.goal_radius,
        "goalTime": robot.goal_time,
        "look": [[colour, np.round(part, 3).tolist()] for part, colour in look],
    }
