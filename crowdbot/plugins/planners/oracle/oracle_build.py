"""Oracle: the people MPC with the truth, whose people give way in each plan."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from crowdbot.plugin import Array, Command, Indices, Observation, RobotLimits, SensorInfo, Task
from crowdbot.plugins.planners.crowd_prediction.crowd_prediction_build import CrowdPrediction
from crowdbot.plugins.planners.oracle import time_to_go_build as grid
from crowdbot.plugins.planners.oracle.foreseen_build import Foreseen
from crowdbot.plugins.planners.oracle.oracle import OracleSpec
from crowdbot.plugins.planners.oracle.rehearsal_build import Rehearsal
from crowdbot.plugins.planners.oracle.whole_forecast_build import WholeForecast
from crowdbot.plugins.planners.people_mpc import plans_build as plans
from crowdbot.plugins.planners.people_mpc.plan_world_build import STEP, UNKNOWN, TimeToGo
from crowdbot.plugins.planners.shared.distance_field_build import distance_at
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene, in_base

#: Predictions are drawn at intervals of this many steps.
_SHOWN_STEP = 6
#: Plans that are tried if one touches someone: share of its speed, and more turning, rad/s.
_OTHERS = ((0.8, 0.0), (1.0, 0.4), (1.0, -0.4), (0.5, 0.0), (0.5, 0.4), (0.5, -0.4))

#: First velocity v, w, vy; angle of the second direction; pace: see `plans_build.roll`.
Plan = tuple[tuple[float, float, float], float, float]
#: x, y, yaw, v, w, vy of the robot.
State = tuple[float, float, float, float, float, float]


class Oracle(CrowdPrediction):
    """Predicts people as if the robot was not there; plans decide what they do for it."""

    name = "oracle"

    def __init__(self, spec: OracleSpec) -> None:
        super().__init__(spec)
        self._forecast = WholeForecast(spec.crowd, spec.settle_time, spec.memory)
        self._knows = spec
        self._foreseen = Foreseen(spec.far_horizon, spec.look_again)
        self._values, self._cost, self._cell = np.zeros((0, 0, 0)), np.zeros((0, 0)), 1.0
        self._to_go, self._looked = UNKNOWN, 0.0
        self._rehearsal = Rehearsal(spec.rehearse, self._robot)
        self._planned: tuple[State, tuple[float, float]] | None = None

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Store the limits and mounts; compile kernels that are not compiled yet."""
        super().reset(task, limits, sensors, seed)
        spec = self._knows
        self._radius = None
        self._to_go = UNKNOWN
        self._rehearsal = Rehearsal(spec.rehearse, self._robot)
        if not spec.foresight:
            return
        self._foreseen = Foreseen(spec.far_horizon, spec.look_again)
        self._speed = spec.speed * limits.v_max
        self._values, self._cost, self._cell = grid.blank(spec.far_horizon, self._speed)
        self._fill(np.zeros((1, 1, 2)), np.ones((1, 2)), (0.0, 0.0), (1.0, 0.0), (9.0, 0.0))

    def step(self, obs: Observation) -> Command:
        """Return the beginning of the best plan; with rehearsals, of one that touches no one."""
        self._planned = None
        command = super().step(obs)
        if self._planned is None or command == Command(0.0, 0.0) or obs.truth is None:
            return command
        tried = [(self._last, self._aside, self._pace), *self._others()]
        paths = self._paths(tried, *self._planned)
        chosen = self._rehearsal.first_clear(obs.truth, paths, self._planned[0][:3])
        self._last, self._aside, self._pace = tried[chosen]
        obs.log("oracle/rehearsed", float(chosen))
        return Command(*self._last)

    def _others(self) -> Iterator[Plan]:
        """Yield plans like the last one: slower, or turning more to one side; then a stop."""
        (v, w, vy), most = self._last, float(self._p[plans.W_MAX])
        for share, turn in _OTHERS:
            first = share * v, max(-most, min(most, w + turn)), share * vy
            yield first, self._aside, share * self._pace
        yield (0.0, 0.0, 0.0), self._aside, 0.0

    def _paths(
        self, tried: Sequence[Plan], state: State, aim: tuple[float, float]
    ) -> Iterator[tuple[int, Array]]:
        """Yield number and path of each plan that stays clear of walls; the first and last anyway.

        The first one has been checked, and the last one is a stop.
        """
        for number, plan in enumerate(tried):
            path = plans.path_of(self._p, state, aim, *plan)
            if number in (0, len(tried) - 1) or self._off_walls(path):
                yield number, path

    def _off_walls(self, path: Array) -> bool:
        """Return True if a path stays clear of walls and other static obstacles."""
        field, radius = self._field, float(self._robot[:, 2].max()) + 0.5 * self._knows.margin
        return all(
            distance_at(field.values, field.corner, x, y) > radius
            for x, y, _ in path[: self._rehearsal.steps].tolist()
        )

    def predicted(
        self, obs: Observation, scene: PlannerScene, rows: Indices, aim: tuple[float, float]
    ) -> Array:
        """Return where people will be, (T, N, 2); draw it."""
        assert obs.truth is not None
        if self._knows.rehearse > 0.0 and obs.truth.foresee is not None:
            pose = scene.pose
            self._planned = (pose.x, pose.y, pose.yaw, *scene.twist), aim
        if not self._knows.foresight or obs.truth.foresee is None:
            return super().predicted(obs, scene, rows, aim)
        looked = self._foreseen.look(obs.t, obs.truth)
        ahead = self._foreseen.places(obs.t, obs.truth)
        if looked:
            self._look_far(obs, scene, ahead, aim)
        found = ahead[: round(self._knows.horizon / STEP), rows]
        shown = found[_SHOWN_STEP - 1 :: _SHOWN_STEP].reshape(-1, 2)
        obs.draw("predicted people", in_base(scene.pose, shown))
        return np.ascontiguousarray(found)

    def _look_far(
        self, obs: Observation, scene: PlannerScene, ahead: Array, aim: tuple[float, float]
    ) -> None:
        """Find the time to the goal from places ahead, as of now."""
        assert obs.truth is not None
        spec, count = self._knows, len(scene.people)
        notice = self.yields(obs, np.arange(count))
        costs = np.where(np.isinf(notice), spec.through, spec.into)
        people = np.column_stack([scene.people[:, 4], costs])
        x, y = scene.pose.x, scene.pose.y
        distance = math.hypot(aim[0] - x, aim[1] - y)
        if distance < 1e-6:
            self._to_go = UNKNOWN
            return
        way = (aim[0] - x) / distance, (aim[1] - y) / distance
        self._fill(np.ascontiguousarray(ahead), people, (x, y), way, aim)
        self._looked = obs.t

    def _fill(
        self,
        ahead: Array,
        people: Array,
        place: tuple[float, float],
        way: tuple[float, float],
        aim: tuple[float, float],
    ) -> None:
        corner = grid.corner_of(*place, way, self._cell)
        radius = float(self._robot[:, 2].min()) + self._knows.far_margin
        grid.fill(
            self._values, self._cost, ahead, people, (*corner, *way, self._cell), aim,
            (radius, self._speed), (self._field.values, self._field.corner),
        )  # fmt: skip
        self._to_go = TimeToGo(self._values, corner, way, self._cell, grid.LAYER * STEP, 0.0)

    def to_go(self, obs: Observation, scene: PlannerScene, aim: tuple[float, float]) -> TimeToGo:
        """Return the time to the goal from places ahead; unknown if nothing is foreseen."""
        del scene, aim
        if self._to_go is UNKNOWN or obs.truth is None or obs.truth.foresee is None:
            return UNKNOWN
        return self._to_go._replace(since=obs.t - self._looked)

    def yields(self, obs: Observation, rows: Indices) -> Array:
        """Return from which time to contact people give way, (N,) s; never if it is not known."""
        assert obs.truth is not None
        notice = obs.truth.people_notice
        return notice[rows] if len(notice) else np.zeros(len(rows))


def build(spec: OracleSpec) -> Oracle:
    """Build a planner from its spec."""
    return Oracle(spec)
