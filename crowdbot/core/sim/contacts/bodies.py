"""Robots as rows and outlines, for contacts and people."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from crowdbot.core.crowd.contact.robot_contact import R_BODY, R_SEEN
from crowdbot.core.geometry.footprint import footprint_of_model
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.robot import RobotModel

#: Columns of a robot's row for the first six entries of its state: x, y, yaw, vx, vy, w.
SEEN = np.array([0, 1, 6, 2, 3, 7])


def rows_of(models: Sequence[RobotModel], margin: float = 0.0) -> Array:
    """Return (R, 8) rows of robots, without their poses.

    Args:
        margin: margin around the body that people perceive, m.
    """
    rows = np.zeros((len(models), 8))
    bodies = [footprint_of_model(model) for model in models]
    rows[:, R_BODY] = [body.radius for body in bodies]
    rows[:, R_SEEN] = [body.reach + margin for body in bodies]
    return rows


def outlines_of(models: Sequence[RobotModel]) -> Array:
    """Return (R, K, 2) outlines before rounding, m; padded with NaN."""
    corners = [footprint_of_model(model).corners for model in models]
    outlines = np.full((len(models), max(map(len, corners)), 2), np.nan)
    for outline, points in zip(outlines, corners, strict=True):
        outline[: len(points)] = points
    return outlines
