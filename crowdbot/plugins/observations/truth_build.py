"""Observation of the ground truth."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.plugin.for_learning import LearningContext, RobotInputs
from crowdbot.plugins.observations.goal_build import bounds, goal_and_motion
from crowdbot.plugins.observations.truth import TruthSpec

_COLUMNS = 6


class EverythingSeen:
    """Returns robot and people; people are in the order of their ids."""

    def __init__(self, spec: TruthSpec, context: LearningContext) -> None:
        self._spec, self._limits = spec, context.limits
        row = ((1, 0.0, 1.0), (4, -1.0, 1.0), (1, 0.0, 2.0))
        self.low, self.high = bounds((9, -1.0, 1.0), *row * spec.people)

    def observe(self, seen: RobotInputs) -> NDArray[np.float32]:
        """Return (W, N): the robot, then people."""
        spec, worlds = self._spec, len(seen.pose)
        here = np.isfinite(seen.people[:, :, 0])
        order = np.argsort(~here, axis=1, kind="stable")[:, : spec.people]
        rows = np.take_along_axis(seen.people, order[:, :, np.newaxis], axis=1)
        scale = [spec.extent] * 2 + [spec.fastest] * 2 + [1.0]
        found = np.zeros((worlds, spec.people, _COLUMNS))
        people = np.concatenate([np.ones((*rows.shape[:2], 1)), rows / scale], axis=2)
        known = np.isfinite(rows[:, :, :1])
        found[:, : rows.shape[1]] = np.where(known, people, 0.0)
        yaw = seen.pose[:, 2]
        robot = [
            seen.pose[:, :2] / spec.extent,
            seen.goal / spec.extent,
            np.cos(yaw),
            np.sin(yaw),
            goal_and_motion(seen, self._limits, spec.extent)[:, 3:],
        ]
        return np.column_stack([*robot, found.reshape(worlds, -1)]).astype(np.float32)


build = EverythingSeen
