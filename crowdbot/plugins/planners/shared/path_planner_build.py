"""Base of planners that follow a path around static obstacles: perceive, plan, drive."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping

from crowdbot.plugin import Command, Observation, RobotLimits, SensorInfo, Task
from crowdbot.plugins.planners.goal_seek_build import bearing, braking_speed
from crowdbot.plugins.planners.shared.path_finder_build import PathFinder
from crowdbot.plugins.planners.shared.robot_outline_build import swept_half_width
from crowdbot.plugins.planners.shared.rungs import RungSpec
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene, PlannerSurroundings

_ARRIVED = 0.1
#: Free space beside the robot on the way past what stands, m.
_BESIDE = 0.12


class PathPlanner(ABC):
    """Base of planners that head for points on a path to the goal.

    Args:
        spec: of the planner.
        leaves: True if the robot leaves barriers that no lidar sees; see `PlannerSurroundings`.

    Attributes:
        limits: of the robot; set by `reset`.
    """

    limits: RobotLimits

    def __init__(self, spec: RungSpec, *, leaves: bool = True) -> None:
        self._rungs = spec
        self._surroundings = PlannerSurroundings(spec, leaves=leaves)
        self._path_finder = PathFinder(1.0)

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Store limits, outline and mounts; compile kernels that are not compiled yet."""
        self.limits = limits
        self._surroundings.reset(sensors, task.robot)
        width = swept_half_width(self._rungs.robot_radius, task.robot)
        self._path_finder = PathFinder(width + _BESIDE)
        self.prepare(task, seed)

    def step(self, obs: Observation) -> Command:
        """Return the command towards the next point of the path; zero at the goal."""
        scene = self._surroundings.see(obs)
        distance, _ = bearing(scene.pose, obs.goal)
        if distance <= _ARRIVED:
            return self.interrupted(Command(0.0, 0.0), at_goal=True)
        if self._surroundings.away is not None:
            return self.interrupted(self._surroundings.away, at_goal=False)
        waypoint = self._path_finder.waypoint(obs.t, scene.pose, scene.seen, obs.goal)
        top = min(self._rungs.speed * self.limits.v_max, braking_speed(distance, self.limits.a_max))
        return self.drive(obs, scene, waypoint, top)

    def interrupted(self, command: Command, *, at_goal: bool) -> Command:
        """Return the command of a step without a plan, at the goal or away from a barrier."""
        del at_goal
        return command

    @abstractmethod
    def prepare(self, task: Task, seed: int) -> None:
        """Reset the memory for a robot with `limits`, and compile kernels."""

    @abstractmethod
    def drive(
        self, obs: Observation, scene: PlannerScene, waypoint: tuple[float, float], top: float
    ) -> Command:
        """Return the command towards a point.

        Args:
            obs: for its time and signals.
            scene: the surroundings.
            waypoint: next point of the path, m, in the frame of the scene.
            top: largest speed from which the robot stops at the goal, m/s.
        """
