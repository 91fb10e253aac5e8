"""People MPC: perceive, predict, choose the best plan, drive its beginning, and plan again."""

from __future__ import annotations

import numpy as np

from crowdbot.plugin import Array, Command, Indices, Observation, RobotLimits, Task
from crowdbot.plugins.planners.dwa.window_build import candidates, candidates_aside
from crowdbot.plugins.planners.goal_seek_build import bearing
from crowdbot.plugins.planners.people_mpc import plans_build as plans
from crowdbot.plugins.planners.people_mpc.people_mpc import PeopleMpcSpec
from crowdbot.plugins.planners.people_mpc.plan_world_build import PlanWorld
from crowdbot.plugins.planners.shared.cover_build import covering_discs
from crowdbot.plugins.planners.shared.distance_field_build import DistanceField
from crowdbot.plugins.planners.shared.path_planner_build import PathPlanner
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene, in_base, rows_near

#: At most this many people are predicted, the nearest.
MOST_PEOPLE = 40
#: The prediction that people keep their velocity.
KEPT = np.zeros((0, 0, 2))
#: People do not respond.
IGNORE = np.zeros(0)


class PeopleMpc(PathPlanner):
    """The planner `people_mpc`; remembers its last plan.

    Subclasses predict people otherwise, by `predicted`.
    """

    #: Name of what it logs.
    name = "people_mpc"

    def __init__(self, spec: PeopleMpcSpec) -> None:
        super().__init__(spec)
        self._spec = spec
        self._field = DistanceField()
        self._robot = covering_discs(spec.robot_radius, None)
        self._p: Array = np.zeros(plans.PARAMETERS)
        self._last, self._aside, self._pace = (0.0, 0.0, 0.0), 0.0, 1.0

    def prepare(self, task: Task, seed: int) -> None:
        """Store the outline; compile kernels that are not compiled yet."""
        del seed
        self._robot = covering_discs(self._spec.robot_radius, task.robot)
        self._p = self.parameters(self.limits)
        self._last, self._aside, self._pace = (0.0, 0.0, 0.0), 0.0, 1.0
        self._firsts((0.0, 0.0, 0.0), 1.0, 0.0)
        world = PlanWorld(
            np.ones((1, 5)),
            KEPT,
            self._field.values,
            (0.0, 0.0),
            self._robot,
            (9.0, 0.0),
            IGNORE,
            np.ones((1, 5)),
        )
        state = (0.0,) * 6
        plans.best_plan(world, self._p, state, np.zeros((1, 3)), self._last, 0.0)
        plans.path_of(self._p, state, (9.0, 0.0), self._last, 0.0, 1.0)

    def interrupted(self, command: Command, *, at_goal: bool) -> Command:
        """Return the command, and remember its speed."""
        del at_goal
        self._last = (command.v, 0.0, 0.0)
        return command

    def drive(
        self, obs: Observation, scene: PlannerScene, waypoint: tuple[float, float], top: float
    ) -> Command:
        """Return the beginning of the best plan."""
        pose = scene.pose
        _, error = bearing(pose, waypoint)
        firsts = self._firsts(scene.twist, top, error)
        self._field.fill(scene.points, pose.x, pose.y)
        rows = rows_near(scene, self._p[plans.V_MAX], self._spec.horizon, MOST_PEOPLE)
        state = (pose.x, pose.y, pose.yaw, *scene.twist)
        people = np.ascontiguousarray(scene.people[rows])
        world = PlanWorld(
            people, self.predicted(obs, scene, rows, waypoint),
            self._field.values, self._field.corner, self._robot, waypoint, self.yields(obs, rows),
            np.empty_like(people),
        )  # fmt: skip
        at, aside, pace, cost = plans.best_plan(
            world, self._p, state, firsts, self._last, self._aside
        )
        self._last, self._aside, self._pace = (0.0, 0.0, 0.0), 0.0, plans.PACES[pace]
        if at >= 0:
            v, w, vy = firsts[at].tolist()
            self._last, self._aside = (v, w, vy), plans.ASIDE[aside]
            obs.draw("plan", lambda: in_base(pose, self.path(scene, waypoint)))
        obs.log(f"{self.name}/cost", min(cost, 100.0))
        obs.log(f"{self.name}/pace", self._pace)
        return Command(*self._last)

    def predicted(
        self, obs: Observation, scene: PlannerScene, rows: Indices, waypoint: tuple[float, float]
    ) -> Array:
        """Return people's positions (T, N, 2), see `plans.PlanWorld`; here at constant velocity.

        Args:
            obs: for its time and signals.
            scene: the surroundings.
            rows: (N,) the people of the scene who count.
            waypoint: point that the robot drives to, m.
        """
        del obs, scene, rows, waypoint
        return KEPT

    def parameters(self, limits: RobotLimits) -> Array:
        """Return the parameters of plans."""
        spec, p = self._spec, np.zeros(plans.PARAMETERS)
        p[plans.A_MAX], p[plans.ALPHA_MAX] = limits.a_max, limits.alpha_max
        p[plans.V_MAX], p[plans.W_MAX] = spec.speed * limits.v_max, limits.w_max
        p[plans.HORIZON], p[plans.TURN_TIME] = spec.horizon, spec.turn_time
        p[plans.MARGIN], p[plans.COMFORT] = spec.margin, spec.comfort
        p[plans.GROWTH], p[plans.PROGRESS] = spec.margin_growth, spec.progress
        p[plans.CLEARANCE], p[plans.IMPACT] = spec.clearance, spec.impact
        p[plans.SMOOTHNESS], p[plans.HEADING] = spec.smoothness, spec.heading
        p[plans.HURRY], p[plans.HEADWAY] = spec.hurry, spec.headway
        p[plans.HURRY_WITHIN], p[plans.HURRY_ROOM] = spec.hurry_within, spec.hurry_room
        p[plans.SIDEWAYS] = 1.0 if limits.vy_max > 0.0 else 0.0
        p[plans.ASIDE_COST], p[plans.SWERVE] = 0.5 * spec.smoothness, spec.swerve
        return p

    def yields(self, obs: Observation, rows: Indices) -> Array:
        """Return the time to contact from which people give way (N,), s; here unknown.

        Args:
            obs: for the truth.
            rows: (N,) the people of the scene who count.
        """
        del obs, rows
        return IGNORE

    def path(self, scene: PlannerScene, waypoint: tuple[float, float]) -> Array:
        """Return the positions (T, 2) of the chosen plan after each step, m."""
        state = (scene.pose.x, scene.pose.y, scene.pose.yaw, *scene.twist)
        return plans.path_of(self._p, state, waypoint, self._last, self._aside, self._pace)[:, :2]

    def _firsts(self, twist: tuple[float, float, float], top: float, error: float) -> Array:
        """Return (C, 3) first velocities v, w, vy that the robot reaches within the window."""
        spec, limits = self._spec, self.limits
        v, w, vy = twist
        dv, dw = limits.a_max * spec.window, limits.alpha_max * spec.window
        left, right = max(w - dw, -limits.w_max), min(w + dw, limits.w_max)
        wish = max(left, min(right, 2.0 * error))
        if limits.vy_max > 0.0:
            rates = np.array([wish])
            return candidates_aside((v, vy), dv, top, spec.speeds, error, rates)
        low = min(max(v - dv, 0.0), top)
        high = max(min(v + dv, top), low)
        found = candidates(low, high, spec.speeds, left, right, spec.yaw_rates, wish)
        return np.column_stack([found, np.zeros(len(found))])


build = PeopleMpc
