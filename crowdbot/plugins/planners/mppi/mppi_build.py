"""MPPI: perceive, sample around the last plan, drive the weighted mean.

Williams, Drews, Goldfain, Rehg, Theodorou, "Aggressive driving with model predictive path integral
control", ICRA 2016. Numbers of samples, noise, temperature and control weight are the defaults of
nav2's MPPI controller (docs.nav2.org, configuration of the MPPI controller).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from crowdbot.plugin import Array, Command, Observation, RobotLimits, SensorInfo, Task
from crowdbot.plugins.planners.goal_seek_build import bearing, braking_speed
from crowdbot.plugins.planners.mppi import rollouts_build as rollouts
from crowdbot.plugins.planners.mppi import samples_build as samples
from crowdbot.plugins.planners.mppi.mppi import MppiSpec
from crowdbot.plugins.planners.shared.braking_build import AroundRobot, MotionState, can_brake
from crowdbot.plugins.planners.shared.cover_build import covering_discs
from crowdbot.plugins.planners.shared.distance_field_build import DistanceField
from crowdbot.plugins.planners.shared.driven_path_build import driven
from crowdbot.plugins.planners.shared.path_finder_build import PathFinder
from crowdbot.plugins.planners.shared.robot_outline_build import swept_half_width
from crowdbot.plugins.planners.shared.starts_build import STARTS, starts
from crowdbot.plugins.planners.shared.surroundings_build import PlannerSurroundings, people_near

_ARRIVED, _BESIDE = 0.1, 0.12
#: Time for which a command is held before the robot must be able to brake, s; clearance then, m.
_HELD, _TOUCH = 0.1, 0.04


class Mppi:
    """The MPPI planner; remembers its last plan."""

    def __init__(self, spec: MppiSpec) -> None:
        self._spec = spec
        self._surroundings = PlannerSurroundings(spec, leaves=True)
        self._field = DistanceField()
        self._limits: RobotLimits | None = None
        self._robot = covering_discs(spec.robot_radius, None)
        self._path_finder = PathFinder(1.0)
        self._p: Array = np.zeros(samples.PARAMETERS)
        self._samples = self._drawn(2, 0)
        self._next = 0.0

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Draw the noise; compile kernels that are not compiled yet."""
        spec = self._spec
        self._limits, self._next = limits, 0.0
        self._surroundings.reset(sensors, task.robot)
        self._robot = covering_discs(spec.robot_radius, task.robot)
        self._path_finder = PathFinder(swept_half_width(spec.robot_radius, task.robot) + _BESIDE)
        self._p = _parameters(spec, limits)
        self._samples = self._drawn(2, 0)
        around = rollouts.RolloutObstacles(
            np.ones((1, 5)), self._field.values, (0.0, 0.0), self._robot, (9.0, 0.0)
        )
        rollouts.improve(around, self._p, (0.0,) * 6, self._samples)
        samples.shift(self._samples.plan)
        can_brake(
            AroundRobot(np.ones((1, 5)), np.ones((1, 2)), self._robot), (0.0,) * 6,
            (0.0, 0.0, 0.0), (limits.a_max, limits.alpha_max), (_HELD, _TOUCH),
        )  # fmt: skip
        self._samples = self._drawn(spec.samples, seed)

    def step(self, obs: Observation) -> Command:
        """Return the first control of the improved plan; zero at the goal."""
        assert self._limits is not None
        spec, limits = self._spec, self._limits
        scene = self._surroundings.see(obs)
        pose = scene.pose
        distance, _ = bearing(pose, obs.goal)
        if distance <= _ARRIVED:
            self._samples.plan[:] = 0.0
            return Command(0.0, 0.0)
        if self._surroundings.away is not None:
            return self._surroundings.away
        self._shift(obs.t)
        top = min(spec.speed * limits.v_max, braking_speed(distance, limits.a_max))
        self._p[samples.TOP] = top
        waypoint = self._path_finder.waypoint(obs.t, pose, scene.seen, obs.goal)
        self._field.fill(scene.points, pose.x, pose.y)
        people = people_near(scene, limits.v_max, spec.steps * spec.step_time, samples.MOST_PEOPLE)
        around = rollouts.RolloutObstacles(
            people, self._field.values, self._field.corner, self._robot, waypoint
        )
        state = (pose.x, pose.y, pose.yaw, *scene.twist)
        self._start(state, waypoint, top)
        cost = rollouts.improve(around, self._p, state, self._samples)
        obs.log("mppi/cost", min(cost, 100.0))
        obs.draw("plan", driven(self._samples.plan[::2], 2.0 * spec.step_time))
        return self._braking(AroundRobot(people, scene.points, self._robot), state)

    def _drawn(self, count: int, seed: int) -> samples.Samples:
        spec = self._spec
        knots = 1 + max(1, round((spec.steps - 1) * spec.step_time / spec.noise_time))
        return samples.drawn(count, spec.steps, knots, STARTS, seed)

    def _start(self, state: MotionState, waypoint: tuple[float, float], top: float) -> None:
        """Write the simple plans that are rolled out beside the noisy ones."""
        assert self._limits is not None
        shape = self._spec.steps, 3 if self._limits.vy_max > 0.0 else 2
        plans = starts(state, waypoint, self._limits, shape, self._spec.step_time, top)
        self._samples.simple[:, :, : shape[1]] = plans

    def _braking(self, world: AroundRobot, state: MotionState) -> Command:
        """Return the first control of the plan, slower where the robot could not stop in time.

        The mean of rollouts that pass on both sides may pass on neither.
        """
        assert self._limits is not None
        v, w, vy = self._samples.plan[1].tolist()  # the first is over when the robot has it
        slew = self._limits.a_max, self._limits.alpha_max
        for share in (1.0, 0.5, 0.0):
            if can_brake(world, state, (share * v, w, share * vy), slew, (_HELD, _TOUCH)):
                return Command(share * v, w, share * vy)
        return Command(0.0, 0.0)

    def _shift(self, t: float) -> None:
        """Move the plan on to a time, s."""
        if t <= self._next - self._spec.step_time:
            self._next = t
        while self._next < t:
            samples.shift(self._samples.plan)
            self._next += self._spec.step_time


def _parameters(spec: MppiSpec, limits: RobotLimits) -> Array:
    p = np.zeros(samples.PARAMETERS)
    p[samples.A_MAX], p[samples.ALPHA_MAX] = limits.a_max, limits.alpha_max
    p[samples.V_MIN], p[samples.V_MAX] = limits.v_min, limits.v_max
    p[samples.W_MAX], p[samples.VY_MAX] = limits.w_max, limits.vy_max
    p[samples.DT], p[samples.TEMPERATURE] = spec.step_time, spec.temperature
    p[samples.CONTROL], p[samples.COMFORT] = spec.control_weight, spec.comfort
    p[samples.GROWTH], p[samples.PROGRESS] = spec.margin_growth, spec.progress
    p[samples.HEADING], p[samples.CLEARANCE] = spec.heading, spec.clearance
    p[samples.COLLISION], p[samples.BACKWARD] = spec.collision, spec.backward
    p[samples.V_NOISE], p[samples.W_NOISE] = spec.speed_noise, spec.yaw_rate_noise
    p[samples.TOP] = spec.speed * limits.v_max
    return p


build = Mppi
