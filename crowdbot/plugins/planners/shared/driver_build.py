"""Base of planners that choose a velocity: perceive, plan around obstacles, choose, drive."""

from __future__ import annotations

import math
from abc import abstractmethod

import numpy as np

from crowdbot.plugin import Array, Command, Observation, RobotBody, Task
from crowdbot.plugins.planners.goal_seek_build import bearing
from crowdbot.plugins.planners.shared.follow_velocity_build import follow
from crowdbot.plugins.planners.shared.path_planner_build import PathPlanner
from crowdbot.plugins.planners.shared.robot_outline_build import disc_radius
from crowdbot.plugins.planners.shared.rungs import RungSpec
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene, in_base


class VelocityPlanner(PathPlanner):
    """Base of planners that choose a velocity in each step.

    Attributes:
        body: of the robot.
        radius: of the disc that holds the robot, m.
    """

    def __init__(self, spec: RungSpec) -> None:
        super().__init__(spec)
        self.body: RobotBody | None = None
        self.radius = disc_radius(spec.robot_radius, None)

    def prepare(self, task: Task, seed: int) -> None:
        """Store the outline; compile kernels that are not compiled yet."""
        del seed
        self.body = task.robot
        self.radius = disc_radius(self._rungs.robot_radius, task.robot)
        self.forget()

    def drive(
        self, obs: Observation, scene: PlannerScene, waypoint: tuple[float, float], top: float
    ) -> Command:
        """Return the command towards the chosen velocity."""
        _, error = bearing(scene.pose, waypoint)
        ahead = scene.pose.yaw + error
        wish = np.array([top * math.cos(ahead), top * math.sin(ahead)])
        return self.pursue(obs, scene, wish, error)

    def pursue(self, obs: Observation, scene: PlannerScene, wish: Array, error: float) -> Command:
        """Return the command with which the drive follows the chosen velocity.

        Args:
            obs, scene, wish: as for `velocity`.
            error: angle from the heading to the desired velocity, rad.
        """
        chosen = self.velocity(obs, scene, wish)
        here = np.array([scene.pose.x, scene.pose.y])
        obs.draw("velocity", lambda: in_base(scene.pose, np.array([here, here + chosen])))
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
