import math
from collections.abc import Mapping

from crowdbot.plugin import Command, Observation, RobotLimits, SensorInfo, Task
from crowdbot_careful.waiter import WaiterSpec


class Waiter:
    def __init__(self, spec: WaiterSpec) -> None:
        self.gap = spec.gap

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        self.limits = limits

    def step(self, obs: Observation) -> Command:
        nearest = min(float(r.values.min()) for r in obs.readings.values())
        obs.log("waiter/nearest", min(nearest, 100.0))
        bearing = math.atan2(obs.goal[1] - obs.pose.y, obs.goal[0] - obs.pose.x)
        error = math.remainder(bearing - obs.pose.yaw, math.tau)
        w = max(-self.limits.w_max, min(self.limits.w_max, 2.0 * error))
        return Command(self.limits.v_max if nearest > self.gap else 0.0, w)


def build(spec: WaiterSpec) -> Waiter:
    return Waiter(spec)
