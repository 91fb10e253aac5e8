"""Crowd prediction: the people MPC, with people whom `CrowdForecast` predicts."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from crowdbot.plugin import Array, Indices, Observation, RobotLimits, SensorInfo, Task
from crowdbot.plugins.planners.crowd_prediction.crowd_prediction import CrowdPredictionSpec
from crowdbot.plugins.planners.crowd_prediction.forecast_build import CrowdForecast
from crowdbot.plugins.planners.people_mpc.people_mpc_build import PeopleMpc
from crowdbot.plugins.planners.people_mpc.plan_world_build import STEP
from crowdbot.plugins.planners.shared.robot_outline_build import disc_radius
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene, in_base

#: Predictions are drawn at intervals of this many steps.
_SHOWN_STEP = 6


class CrowdPrediction(PeopleMpc):
    """Predicts people's responses to the robot's last plan, then plans again."""

    name = "crowd_prediction"

    def __init__(self, spec: CrowdPredictionSpec) -> None:
        super().__init__(spec)
        self._own = spec
        self._radius: float | None = disc_radius(spec.robot_radius, None)
        self._forecast = CrowdForecast(spec.crowd, spec.settle_time, spec.memory)

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Store the limits and mounts; compile kernels that are not compiled yet."""
        self._radius = disc_radius(self._own.robot_radius, task.robot)
        self._forecast.reset()
        super().reset(task, limits, sensors, seed)

    def predicted(
        self, obs: Observation, scene: PlannerScene, rows: Indices, waypoint: tuple[float, float]
    ) -> Array:
        """Return people's predicted positions (T, N, 2), m, and draw them."""
        path = np.concatenate([[[scene.pose.x, scene.pose.y]], self.path(scene, waypoint)])
        numbers = scene.tracks[rows, 0].astype(np.int64)
        people = np.ascontiguousarray(scene.people[rows])
        found = self._forecast.predict(
            obs.t, numbers, people, path, self._radius, STEP
        )  # fmt: skip
        obs.log(f"{self.name}/trust", self._forecast.trust)
        obs.draw(
            "predicted people",
            lambda: in_base(scene.pose, found[_SHOWN_STEP - 1 :: _SHOWN_STEP].reshape(-1, 2)),
        )
        return found


build = CrowdPrediction
