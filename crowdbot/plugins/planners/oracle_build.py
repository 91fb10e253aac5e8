"""Oracle: the people MPC with the truth, whose people give way in each plan."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from crowdbot.plugin import Array, Indices, Observation, RobotLimits, SensorInfo, Task
from crowdbot.plugins.planners.crowd_prediction.crowd_prediction_build import CrowdPrediction
from crowdbot.plugins.planners.oracle import OracleSpec


class Oracle(CrowdPrediction):
    """Predicts people as if the robot was not there; plans decide what they do for it."""

    name = "oracle"

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Store the limits and mounts; compile kernels that are not compiled yet."""
        super().reset(task, limits, sensors, seed)
        self._radius = None

    def yields(self, obs: Observation, rows: Indices) -> Array:
        """Return from which time to contact people give way, (N,) s; never if it is not known."""
        assert obs.truth is not None
        notice = obs.truth.people_notice
        return notice[rows] if len(notice) else np.zeros(len(rows))


def build(spec: OracleSpec) -> Oracle:
    """Build a planner from its spec."""
    return Oracle(spec)
