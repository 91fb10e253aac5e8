"""Observation of the last scans of a lidar."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array
from crowdbot.plugin.for_learning import LearningContext, RobotInputs, sensor_named
from crowdbot.plugins.observations.goal_build import SIZE, bounds, goal_and_motion
from crowdbot.plugins.observations.lidar_stack import LidarStackSpec


class LidarStack:
    """Keeps the sectors of the last scans of each world."""

    def __init__(self, spec: LidarStackSpec, context: LearningContext) -> None:
        self._spec, self._limits = spec, context.limits
        self._name = sensor_named(context.sensors, spec.sensor)
        beams = context.sensors[self._name].shape[-1]
        sectors = min(spec.sectors, beams)
        self._first = np.linspace(0, beams, sectors, endpoint=False).astype(np.int64)
        self._kept = np.ones((spec.scans, context.worlds, sectors))
        self.low, self.high = bounds((spec.scans * sectors, 0.0, 1.0), (1, 0.0, 1.0),
                                     (SIZE - 1, -1.0, 1.0))  # fmt: skip

    def observe(self, seen: RobotInputs) -> NDArray[np.float32]:
        """Return (W, N): scans from the latest to the earliest, goal, motion."""
        now = self._sectors(seen.readings[self._name])
        later = np.concatenate([now[np.newaxis], self._kept[:-1]])
        self._kept = np.where(seen.stepped[:, np.newaxis], later, self._kept)
        self._kept[:, seen.fresh] = now[seen.fresh]
        worlds = len(now)
        scans = np.moveaxis(self._kept, 0, 1).reshape(worlds, -1)
        rest = goal_and_motion(seen, self._limits, self._spec.goal_range)
        return np.column_stack([scans, rest]).astype(np.float32)

    def _sectors(self, ranges: Array) -> Array:
        """Return (W, S) the nearest return of each sector, from 0 to 1; of layers, of any."""
        level = ranges.min(axis=1) if ranges.ndim == 3 else ranges
        nearest: Array = np.minimum.reduceat(level, self._first, axis=1)
        return np.minimum(nearest / self._spec.range, 1.0)


def build(spec: LidarStackSpec, context: LearningContext) -> LidarStack:
    """Return an observer that has seen nothing yet."""
    return LidarStack(spec, context)
