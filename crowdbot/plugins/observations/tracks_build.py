"""Observation of the nearest people."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin import Array
from crowdbot.plugin.for_learning import LearningContext, RobotInputs
from crowdbot.plugins.observations.goal_build import SIZE, bounds, goal_and_motion
from crowdbot.plugins.observations.tracks import TracksSpec

_COLUMNS = 6


class TrackRows:
    """Sorts people by distance; keeps nothing."""

    def __init__(self, spec: TracksSpec, context: LearningContext) -> None:
        self._spec, self._limits = spec, context.limits
        row = ((1, 0.0, 1.0), (4, -1.0, 1.0), (1, 0.0, 2.0))
        self.low, self.high = bounds(*row * spec.people, (1, 0.0, 1.0), (SIZE - 1, -1.0, 1.0))

    def observe(self, seen: RobotInputs) -> NDArray[np.float32]:
        """Return (W, N): people, goal, motion."""
        people = self._nearest(seen).reshape(len(seen.pose), -1)
        rest = goal_and_motion(seen, self._limits, self._spec.goal_range)
        return np.column_stack([people, rest]).astype(np.float32)

    def _nearest(self, seen: RobotInputs) -> Array:
        """Return (W, K, 6) the rows of the nearest people."""
        spec, given = self._spec, seen.people
        away = given[:, :, :2] - seen.pose[:, np.newaxis, :2]
        distance = np.hypot(away[:, :, 0], away[:, :, 1])
        distance = np.where(distance <= spec.range, distance, np.inf)
        found = np.zeros((len(given), spec.people, _COLUMNS))
        order = np.argsort(distance, axis=1, kind="stable")[:, : spec.people]
        rows = np.take_along_axis(given, order[:, :, np.newaxis], axis=1)
        seen_ones = np.isfinite(np.take_along_axis(distance, order, axis=1))
        cos, sin = np.cos(seen.pose[:, 2, np.newaxis]), np.sin(seen.pose[:, 2, np.newaxis])
        dx, dy = (rows[:, :, :2] - seen.pose[:, np.newaxis, :2]).transpose(2, 0, 1)
        vx, vy, radius = rows[:, :, 2:].transpose(2, 0, 1)
        columns = [
            np.ones_like(dx),
            (cos * dx + sin * dy) / spec.range,
            (cos * dy - sin * dx) / spec.range,
            np.clip((cos * vx + sin * vy) / spec.fastest, -1.0, 1.0),
            np.clip((cos * vy - sin * vx) / spec.fastest, -1.0, 1.0),
            radius,
        ]
        count = order.shape[1]
        found[:, :count] = np.where(seen_ones[:, :, np.newaxis], np.stack(columns, axis=-1), 0.0)
        return found


def build(spec: TracksSpec, context: LearningContext) -> TrackRows:
    """Return an observer."""
    return TrackRows(spec, context)
