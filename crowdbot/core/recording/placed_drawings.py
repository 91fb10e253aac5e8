"""Planners' drawings in the world frame: for films, pages and viewers of a finished run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from crowdbot.core.planning.planner import TRACKS
from crowdbot.core.recording.drawings import drawing_in_world
from crowdbot.core.recording.reading.one_robot import PlannerDrawing
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array


class PlacedDrawing(NamedTuple):
    """A drawing in the world.

    Attributes:
        t: time, s.
        name: of the drawing.
        columns: x and y (2, K), m; of tracks also vx and vy, (4, K), m/s.
        texts: one for each column, or None.
    """

    t: float
    name: str
    columns: Array
    texts: tuple[str, ...] | None


def placed_drawings(
    run: Trajectories, drawings: Mapping[str, Sequence[PlannerDrawing]]
) -> list[PlacedDrawing]:
    """Return all drawings of a run in the order of time, from the robot's true poses."""
    if run.robot is None:
        return []
    placed = [
        PlacedDrawing(one.t, name, columns_in_world(run, one, tracks=name == TRACKS), one.texts)
        for name, drawn in sorted(drawings.items())
        for one in drawn
    ]
    return sorted(placed, key=lambda one: one.t)


def columns_in_world(run: Trajectories, drawing: PlannerDrawing, *, tracks: bool) -> Array:
    """Return x and y (2, K) of rows, with the velocities of tracks (4, K).

    They are placed from the robot's true pose at the nearest sample.
    """
    assert run.robot is not None
    at = int(np.argmin(np.abs(run.t - drawing.t)))
    yaw = float(run.robot.theta[at])
    x, y = float(run.robot.x[at]), float(run.robot.y[at])
    return drawing_in_world(x, y, yaw, drawing.rows, tracks=tracks)
