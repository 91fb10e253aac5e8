"""The same small planner inside and outside: turn to the goal, go."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any


def follow(pose: Sequence[float], goal: Sequence[float]) -> tuple[float, float]:
    """v (m/s) and w (rad/s) towards the goal."""
    x, y, yaw = pose
    turn = math.remainder(math.atan2(goal[1] - y, goal[0] - x) - yaw, math.tau)
    return 0.6 * max(math.cos(turn), 0.0), 1.5 * turn


class Pursuit:
    needs = ()

    def reset(self, task: Any, limits: Any, sensors: Any, seed: int) -> None:
        del limits, sensors, seed
        self._goal = task.goal

    def step(self, obs: Any) -> tuple[float, float]:
        return follow(obs.pose, self._goal)


class Straight:
    """Sums and products alone, which every language rounds alike; functions of angles are not."""

    needs = ()

    def reset(self, task: Any, limits: Any, sensors: Any, seed: int) -> None:
        del limits, sensors, seed
        self._goal = task.goal

    def step(self, obs: Any) -> tuple[float, float]:
        _, y, yaw = obs.pose
        return 0.6, 0.5 * (self._goal[1] - y) - yaw
