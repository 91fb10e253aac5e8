"""Observation: an occupancy grid of lidar returns."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin.for_learning import LearningContext, RobotInputs
from crowdbot.plugins.observations.goal_build import SIZE, bounds, goal_and_motion, lidar_named
from crowdbot.plugins.observations.occupancy import OccupancySpec


class OccupancyGrid:
    """Marks the cells with returns of the latest scan; keeps no memory."""

    def __init__(self, spec: OccupancySpec, context: LearningContext) -> None:
        self._spec, self._limits = spec, context.limits
        self._name, info = lidar_named(context, spec.sensor)
        x, y, _, yaw = info.mount
        assert info.angles is not None
        beams = info.angles if info.angles.ndim == 1 else info.angles[..., 0].ravel()
        level = 1.0 if info.angles.ndim == 1 else np.cos(info.angles[..., 1].ravel())
        self._mount, self._along = (x, y), np.cos(beams + yaw) * level
        self._across = np.sin(beams + yaw) * level
        self.low, self.high = bounds((spec.cells**2, 0.0, 1.0), (1, 0.0, 1.0),
                                     (SIZE - 1, -1.0, 1.0))  # fmt: skip

    def observe(self, seen: RobotInputs) -> NDArray[np.float32]:
        """Return (W, N): the grid, goal, motion."""
        ranges, spec = seen.readings[self._name], self._spec
        worlds, per_metre = len(ranges), spec.cells / spec.side
        flat = np.where(np.isfinite(ranges), ranges, 1e9).reshape(worlds, -1)
        i = np.floor((self._mount[0] + flat * self._along + 0.5 * spec.side) * per_metre)
        j = np.floor((self._mount[1] + flat * self._across + 0.5 * spec.side) * per_metre)
        inside = (i >= 0) & (i < spec.cells) & (j >= 0) & (j < spec.cells)
        world = np.broadcast_to(np.arange(worlds)[:, np.newaxis], flat.shape)
        grid = np.zeros((worlds, spec.cells, spec.cells), np.float32)
        grid[world[inside], i[inside].astype(int), j[inside].astype(int)] = 1.0
        rest = goal_and_motion(seen, self._limits, spec.goal_range)
        return np.column_stack([grid.reshape(worlds, -1), rest]).astype(np.float32)


build = OccupancyGrid
