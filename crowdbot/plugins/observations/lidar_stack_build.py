"""Observation of the last scans of a lidar."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array, Indices, Mask, kernel
from crowdbot.plugin.for_learning import LearningContext, RobotInputs, sensor_named
from crowdbot.plugins.observations.goal_build import SIZE, bounds, goal_and_motion
from crowdbot.plugins.observations.level_ranges_build import level_ranges
from crowdbot.plugins.observations.lidar_stack import LidarStackSpec


class LidarStack:
    """Keeps the sectors of the last scans of each world, as many as the stride needs."""

    def __init__(self, spec: LidarStackSpec, context: LearningContext) -> None:
        self._spec, self._limits = spec, context.limits
        self._infos = {
            name: context.sensors[name]
            for name in (sensor_named(context.sensors, needed) for needed in spec.needs)
        }
        self._first = {
            name: np.linspace(0, beams, min(spec.sectors, beams) + 1).astype(np.int64)
            for name, beams in ((name, info.shape[-1]) for name, info in self._infos.items())
        }
        sectors = sum(len(first) - 1 for first in self._first.values())
        self._kept = np.ones((context.worlds, (spec.scans - 1) * spec.stride + 1, sectors))
        self.low, self.high = bounds((spec.scans * sectors, 0.0, 1.0), (1, 0.0, 1.0),
                                     (SIZE - 1, -1.0, 1.0))  # fmt: skip

    def observe(self, seen: RobotInputs) -> NDArray[np.float32]:
        """Return (W, N): scans from the latest to the earliest, goal, motion."""
        now, column = np.empty((len(seen.pose), self._kept.shape[2])), 0
        for name, first in self._first.items():
            ranges = level_ranges(self._infos[name], seen.readings[name])
            _write_sectors(ranges, first, self._spec.range, column, now)
            column += len(first) - 1
        found = np.empty((len(now), len(self.low)), np.float32)
        _write_scans(now, seen.fresh, seen.stepped, self._spec.stride, self._kept, found)
        found[:, -SIZE:] = goal_and_motion(seen, self._limits, self._spec.goal_range)
        return found


@kernel
def _write_sectors(ranges: Array, first: Indices, most: float, column: int, out: Array) -> None:
    """Write the nearest return of each sector, from 0 to 1, from a column on.

    Args:
        ranges: (W, L, B) of all layers, m.
        first: (S + 1,) the first beam of each sector, and the end of the last one.
    """
    for w in range(ranges.shape[0]):
        for k in range(first.shape[0] - 1):
            nearest = most
            for layer in range(ranges.shape[1]):
                for beam in range(first[k], first[k + 1]):
                    nearest = min(nearest, ranges[w, layer, beam])
            out[w, column + k] = nearest / most


@kernel
def _write_scans(
    now: Array, fresh: Mask, stepped: Mask, stride: int, kept: Array, found: NDArray[np.float32]
) -> None:
    """Keep scans (W, S), and write those that are a stride apart, the latest first.

    Args:
        kept: (W, K, S) the last scans, changed.
        found: (W, N) output; the rest of it is unchanged.
    """
    scans, sectors = kept.shape[1], kept.shape[2]
    for w in range(now.shape[0]):
        if fresh[w] or stepped[w]:
            for k in range(scans - 1, -1, -1):
                for n in range(sectors):
                    kept[w, k, n] = now[w, n] if k == 0 or fresh[w] else kept[w, k - 1, n]
        for k in range(0, scans, stride):
            for n in range(sectors):
                found[w, k // stride * sectors + n] = kept[w, k, n]


build = LidarStack
