"""Base of learned planners: try each action for one step, and rate the next state by a network."""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np

from crowdbot.plugin import Array, Observation
from crowdbot.plugins.planners.shared.driver_build import VelocityPlanner
from crowdbot.plugins.planners.shared.learned import ValueSearchSpec
from crowdbot.plugins.planners.shared.perceptron_build import Singles
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene
from crowdbot.plugins.planners.shared.value_search_build import (
    OF_PAIR,
    ValueSearchRobot,
    actions,
    look_ahead,
    touches,
)

#: Free space beside the robot along what stands, m.
_BESIDE = 0.03


class ValueNetwork(Protocol):
    """A network that values joint states."""

    def values(self, states: Singles) -> Singles:
        """Return the values (A,) of states (A, N, 13)."""


class LearnedPlanner(VelocityPlanner):
    """Decides at the rate of the network's training, and keeps the velocity meanwhile."""

    def __init__(self, spec: ValueSearchSpec, network: ValueNetwork) -> None:
        super().__init__(spec)
        self._spec, self._network = spec, network
        self._unicycle = spec.kinematics == "unicycle"
        self._choices = actions(1.0, spec.speed_samples, spec.rotation_samples, unicycle=False)
        self._next, self._chosen = -math.inf, (0.0, 0.0)

    def forget(self) -> None:
        """Reset the last decision; compile kernels."""
        self._next, self._chosen = -math.inf, (0.0, 0.0)
        spec = self._spec
        self._choices = actions(
            1.0, spec.speed_samples, spec.rotation_samples, unicycle=self._unicycle
        )
        one = ValueSearchRobot(0.0, 0.0, 0.0, 0.3, 4.0, 0.0, 1.0)
        self.worths(one, self._choices, np.ones((1, 5)))
        touches(self._choices, 0.0, np.ones((1, 2)), (0.3, 1.0), 0)

    def velocity(self, obs: Observation, scene: PlannerScene, wish: Array) -> tuple[float, float]:
        """Return the velocity of the best action, m/s; without people that towards the goal."""
        if len(scene.people) == 0:
            self._next = -math.inf
            return float(wish[0]), float(wish[1])
        if obs.t < self._next - 1e-6:
            return self._chosen
        self._next = obs.t + self._spec.step_time
        pose, top = scene.pose, float(np.hypot(*wish))
        speed = self._spec.speed * self.limits.v_max
        goal = min(self._spec.goal_distance, math.hypot(obs.goal[0] - pose.x, obs.goal[1] - pose.y))
        ahead = wish / top if top > 0.0 else np.zeros(2)
        robot = ValueSearchRobot(
            pose.x, pose.y, pose.yaw, self.radius,
            pose.x + goal * float(ahead[0]), pose.y + goal * float(ahead[1]), speed,
        )  # fmt: skip
        choices = self._choices * (min(top, speed), 1.0)
        worths = self.worths(robot, choices, self._people_after(scene))
        best = self._best(scene, choices, worths)
        obs.log("learned/worth", float(worths[best]) if best >= 0 else 0.0)
        v, angle = (choices[best].tolist()) if best >= 0 else (0.0, 0.0)
        angle += pose.yaw if self._unicycle else 0.0
        self._chosen = v * math.cos(angle), v * math.sin(angle)
        return self._chosen

    def worths(self, robot: ValueSearchRobot, choices: Array, people: Array) -> Array:
        """Return the worth (A,) of each action: its reward and the discounted value after it.

        Args:
            choices: (A, 2) speeds and directions.
            people: (N, 5) at the end of the step, N > 0.
        """
        spec = self._spec
        states = np.zeros((len(choices), len(people), OF_PAIR), dtype=np.float32)
        rewards = np.zeros(len(choices))
        times = spec.step_time, spec.discomfort
        look_ahead(robot, choices, people, times, self._unicycle, states, rewards)
        discount = spec.gamma ** (spec.step_time * robot.speed)
        after: Array = self._network.values(states).astype(np.float64)
        return np.asarray(rewards + discount * after)

    def _people_after(self, scene: PlannerScene) -> Array:
        """Return the nearest people (N, 5) after one step at constant velocity."""
        people = scene.people
        away = np.hypot(people[:, 0] - scene.pose.x, people[:, 1] - scene.pose.y)
        near = people[np.argsort(away, kind="stable")[: self._spec.neighbours]]
        moved = near.copy()
        moved[:, :2] += self._spec.step_time * near[:, 2:4]
        return moved

    def _best(self, scene: PlannerScene, choices: Array, worths: Array) -> int:
        """Return the best action that touches nothing that stands; -1 if there is none."""
        yaw = scene.pose.yaw if self._unicycle else 0.0
        points = np.ascontiguousarray(scene.points - (scene.pose.x, scene.pose.y))
        reach = self.radius + _BESIDE, self._spec.wall_time
        for k in np.argsort(-worths, kind="stable").tolist():
            if reach[1] == 0.0 or not touches(choices, yaw, points, reach, k):
                return int(k)
        return -1
