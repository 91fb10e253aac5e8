"""Swerve, step by step."""

from __future__ import annotations

import math
from collections.abc import Mapping

from crowdbot.plugin import Command, Observation, RobotLimits, SensorInfo, Task

from crowdbot_acme.swerve import SwerveSpec

_SIDEWAYS = 0.6  # rad; how far it turns away from who is near


class Swerve:
    """A heading controller whose speed falls from ``slow`` to ``stop``."""

    def __init__(self, spec: SwerveSpec) -> None:
        self._spec = spec

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Remember what the robot can do."""
        del task, sensors, seed
        self._limits = limits

    def step(self, obs: Observation) -> Command:
        """Log the brake, 0 to 1, and return the next command."""
        limits = self._limits
        away, bearing = self._nearest(obs)
        brake = self._brake(away)
        obs.log("acme/brake", brake)
        dx, dy = obs.goal[0] - obs.pose.x, obs.goal[1] - obs.pose.y
        aim = math.atan2(dy, dx) - math.copysign(_SIDEWAYS * brake, bearing)
        error = math.remainder(aim - obs.pose.yaw, math.tau)
        v = min((1.0 - brake) * limits.v_max * max(0.0, math.cos(error)), math.hypot(dx, dy))
        return Command(v, max(-limits.w_max, min(limits.w_max, self._spec.gain * error)))

    def _nearest(self, obs: Observation) -> tuple[float, float]:
        """Distance (m) and bearing (rad) of the nearest person that any radar sees."""
        found = [tuple(r.values[[0, 2]].tolist()) for r in obs.readings.values()]
        return min(found, default=(math.inf, 0.0))

    def _brake(self, away: float) -> float:
        stop, slow = self._spec.stop, max(self._spec.slow, self._spec.stop + 0.01)
        return min(1.0, max(0.0, (slow - away) / (slow - stop)))


def build(spec: SwerveSpec) -> Swerve:
    """A planner from its spec."""
    return Swerve(spec)
