"""MPPI: perceive, sample around the last plan, drive the weighted mean.

Williams, Drews, Goldfain, Rehg, Theodorou, "Aggressive driving with model predictive path integral
control", ICRA 2016. Numbers of samples, noise, temperature and control weight are the defaults of
nav2's MPPI controller (docs.nav2.org, configuration of the MPPI controller).
"""

from __future__ import annotations

import numpy as np

from crowdbot.plugin import Array, Command, Observation, RobotLimits, Task
from crowdbot.plugins.planners.mppi import rollouts_build as rollouts
from crowdbot.plugins.planners.mppi import samples_build as samples
from crowdbot.plugins.planners.mppi.mppi import MppiSpec
from crowdbot.plugins.planners.shared.braking_build import AroundRobot, MotionState, can_brake
from crowdbot.plugins.planners.shared.cover_build import covering_discs
from crowdbot.plugins.planners.shared.distance_field_build import DistanceField
from crowdbot.plugins.planners.shared.driven_path_build import driven
from crowdbot.plugins.planners.shared.path_planner_build import PathPlanner
from crowdbot.plugins.planners.shared.starts_build import STARTS, starts
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene, people_near

#: Time for which a command is held before the robot must be able to brake, s; clearance then, m.
_HELD, _TOUCH = 0.1, 0.04


class Mppi(PathPlanner):
    """The MPPI planner; remembers its last plan."""

    def __init__(self, spec: MppiSpec) -> None:
        super().__init__(spec)
        self._spec = spec
        self._field = DistanceField()
        self._robot = covering_discs(spec.robot_radius, None)
        self._p: Array = np.zeros(samples.PARAMETERS)
        self._samples = self._drawn(2, 0)
        self._next = 0.0

    def prepare(self, task: Task, seed: int) -> None:
        """Draw the noise; compile kernels that are not compiled yet."""
        spec, limits = self._spec, self.limits
        self._next = 0.0
        self._robot = covering_discs(spec.robot_radius, task.robot)
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

    def interrupted(self, command: Command, *, at_goal: bool) -> Command:
        """Return the command; at the goal the plan is to stand."""
        if at_goal:
            self._samples.plan[:] = 0.0
        return command

    def drive(
        self, obs: Observation, scene: PlannerScene, waypoint: tuple[float, float], top: float
    ) -> Command:
        """Return the first control of the improved plan."""
        spec, limits, pose = self._spec, self.limits, scene.pose
        self._shift(obs.t)
        self._p[samples.TOP] = top
        self._field.fill(scene.points, pose.x, pose.y)
        people = people_near(scene, limits.v_max, spec.steps * spec.step_time, samples.MOST_PEOPLE)
        around = rollouts.RolloutObstacles(
            people, self._field.values, self._field.corner, self._robot, waypoint
        )
        state = (pose.x, pose.y, pose.yaw, *scene.twist)
        self._start(state, waypoint, top)
        cost = rollouts.improve(around, self._p, state, self._samples)
        obs.log("mppi/cost", min(cost, 100.0))
        obs.draw("plan", lambda: driven(self._samples.plan[::2], 2.0 * spec.step_time))
        return self._braking(AroundRobot(people, scene.points, self._robot), state)

    def _drawn(self, count: int, seed: int) -> samples.Samples:
        spec = self._spec
        knots = 1 + max(1, round((spec.steps - 1) * spec.step_time / spec.noise_time))
        return samples.drawn(count, spec.steps, knots, STARTS, seed)

    def _start(self, state: MotionState, waypoint: tuple[float, float], top: float) -> None:
        """Write the simple plans that are rolled out beside the noisy ones."""
        shape = self._spec.steps, 3 if self.limits.vy_max > 0.0 else 2
        plans = starts(state, waypoint, self.limits, shape, self._spec.step_time, top)
        self._samples.simple[:, :, : shape[1]] = plans

    def _braking(self, world: AroundRobot, state: MotionState) -> Command:
        """Return the first control of the plan, slower where the robot could not stop in time.

        The mean of rollouts that pass on both sides may pass on neither.
        """
        v, w, vy = self._samples.plan[1].tolist()  # the first is over when the robot has it
        slew = self.limits.a_max, self.limits.alpha_max
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
