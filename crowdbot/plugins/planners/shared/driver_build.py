"""Base of planners that choose a velocity: perceive, plan around obstacles, choose, drive."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping

import numpy as np

from crowdbot.plugin import Array, Command, Observation, RobotBody, RobotLimits, SensorInfo, Task
from crowdbot.plugins.planners.goal_seek_build import bearing, braking_speed
from crowdbot.plugins.planners.shared.follow_velocity_build import follow
from crowdbot.plugins.planners.shared.path_finder_build import PathFinder
from crowdbot.plugins.planners.shared.robot_outline_build import disc_radius, swept_half_width
from crowdbot.plugins.planners.shared.rungs import RungSpec
from crowdbot.plugins.planners.shared.surroundings_build import (
    PlannerScene,
    PlannerSurroundings,
    in_base,
)

_ARRIVED = 0.1
#: Free space beside the robot on the way past what stands, m.
_BESIDE = 0.12


class VelocityPlanner(ABC):
    """Base of planners that choose a velocity in each step.

    Attributes:
        limits, body: of the robot.
        radius: of the disc that holds the robot, m.
    """

    def __init__(self, spec: RungSpec) -> None:
        self._rungs = spec
        self._surroundings = PlannerSurroundings(spec, leaves=True)
        self._path_finder = PathFinder(1.0)
        self.limits: RobotLimits | None = None
        self.body: RobotBody | None = None
        self.radius = disc_radius(spec.robot_radius, None)

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Store limits, outline and mounts; compile kernels that are not compiled yet."""
        del seed
        self.limits, self.body = limits, task.robot
        self.radius = disc_radius(self._rungs.robot_radius, task.robot)
        self._surroundings.reset(sensors, task.robot)
        self._path_finder = PathFinder(
            swept_half_width(self._rungs.robot_radius, task.robot) + _BESIDE
        )
        self.forget()

    def step(self, obs: Observation) -> Command:
        """Return the command towards the chosen velocity; zero at the goal."""
        assert self.limits is not None
        scene = self._surroundings.see(obs)
        distance, _ = bearing(scene.pose, obs.goal)
        if distance <= _ARRIVED:
            return Command(0.0, 0.0)
        if self._surroundings.away is not None:
            return self._surroundings.away
        waypoint = self._path_finder.waypoint(obs.t, scene.pose, scene.seen, obs.goal)
        _, error = bearing(scene.pose, waypoint)
        top = min(self._rungs.speed * self.limits.v_max, braking_speed(distance, self.limits.a_max))
        ahead = scene.pose.yaw + error
        wish = np.array([top * math.cos(ahead), top * math.sin(ahead)])
        return self.drive(obs, scene, wish, error)

    def drive(self, obs: Observation, scene: PlannerScene, wish: Array, error: float) -> Command:
        """Return the command with which the drive follows the chosen velocity.

        Args:
            obs, scene, wish: as for `velocity`.
            error: angle from the heading to the desired velocity, rad.
        """
        assert self.limits is not None
        chosen = self.velocity(obs, scene, wish)
        here = np.array([scene.pose.x, scene.pose.y])
        obs.draw("velocity", in_base(scene.pose, np.array([here, here + chosen])))
        return follow(chosen, scene.pose.yaw, error, self.limits)

    @abstractmethod
    def forget(self) -> None:
        """Reset the memory, and compile kernels."""

    @abstractmethod
    def velocity(self, obs: Observation, scene: PlannerScene, wish: Array) -> tuple[float, float]:
        """Return the chosen velocity, m/s, in the frame of the scene.

        Args:
            obs: for its time and signals.
            scene: the surroundings.
            wish: (2,) velocity straight to the next stretch of the way, m/s.
        """


def velocity_of(scene: PlannerScene) -> tuple[float, float]:
    """Return the robot's velocity in the frame of the scene, m/s."""
    v, _, vy = scene.twist
    c, s = math.cos(scene.pose.yaw), math.sin(scene.pose.yaw)
    return c * v - s * vy, s * v + c * vy
