import math
from collections.abc import Mapping

from crowdbot import Command, Observation, RobotLimits, SensorInfo, Task


class MyPlanner:
    needs = ("lidar",)  # categories or names of sensors

    def __init__(self, gap: float = 0.8) -> None:
        self.gap = gap  # stand still while anything is nearer than this, m

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        self.limits = limits

    def step(self, obs: Observation) -> Command:
        nearest = min(float(r.values.min()) for r in obs.readings.values())
        obs.log("my_planner/nearest", min(nearest, 100.0))
        bearing = math.atan2(obs.goal[1] - obs.pose.y, obs.goal[0] - obs.pose.x)
        error = math.remainder(bearing - obs.pose.yaw, math.tau)
        return Command(self.limits.v_max if nearest > self.gap else 0.0, 2.0 * error)
