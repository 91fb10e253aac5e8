"""Observation of the last scans of a lidar."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array, Indices
from crowdbot.plugin.for_learning import LearningContext, RobotInputs, sensor_named
from crowdbot.plugins.observations.goal_build import SIZE, bounds, goal_and_motion
from crowdbot.plugins.observations.lidar_stack import LidarStackSpec


class LidarStack:
    """Keeps the sectors of the last scans of each world, all that a stride later needs."""

    def __init__(self, spec: LidarStackSpec, context: LearningContext) -> None:
        self._spec, self._limits = spec, context.limits
        names = [sensor_named(context.sensors, name) for name in spec.needs]
        counts = [context.sensors[name].shape[-1] for name in names]
        self._first = {
            name: np.linspace(0, beams, min(spec.sectors, beams), endpoint=False).astype(np.int64)
            for name, beams in zip(names, counts, strict=True)
        }
        sectors = sum(map(len, self._first.values()))
        self._kept = np.ones(((spec.scans - 1) * spec.stride + 1, context.worlds, sectors))
        self.low, self.high = bounds((spec.scans * sectors, 0.0, 1.0), (1, 0.0, 1.0),
                                     (SIZE - 1, -1.0, 1.0))  # fmt: skip

    def observe(self, seen: RobotInputs) -> NDArray[np.float32]:
        """Return (W, N): scans from the latest to the earliest, goal, motion."""
        each = [self._sectors(seen.readings[n], first) for n, first in self._first.items()]
        now = np.concatenate(each, axis=1)
        later = np.concatenate([now[np.newaxis], self._kept[:-1]])
        self._kept = np.where(seen.stepped[:, np.newaxis], later, self._kept)
        self._kept[:, seen.fresh] = now[seen.fresh]
        worlds = len(now)
        scans = np.moveaxis(self._kept[:: self._spec.stride], 0, 1).reshape(worlds, -1)
        rest = goal_and_motion(seen, self._limits, self._spec.goal_range)
        return np.column_stack([scans, rest]).astype(np.float32)

    def _sectors(self, ranges: Array, first: Indices) -> Array:
        """Return (W, S) the nearest return of each sector, from 0 to 1; of layers, of any."""
        level = ranges.min(axis=1) if ranges.ndim == 3 else ranges
        nearest: Array = np.minimum.reduceat(level, first, axis=1)
        return np.minimum(nearest / self._spec.range, 1.0)


def build(spec: LidarStackSpec, context: LearningContext) -> LidarStack:
    """Return an observer that has seen nothing yet."""
    return LidarStack(spec, context)
