"""Oracle: the people MPC with the ground truth; people give way in each plan."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from crowdbot.plugin import (
    Array,
    Command,
    Indices,
    Observation,
    RobotLimits,
    SensorInfo,
    Task,
    Truth,
)
from crowdbot.plugins.planners.crowd_prediction.crowd_prediction_build import CrowdPrediction
from crowdbot.plugins.planners.oracle.oracle import OracleSpec
from crowdbot.plugins.planners.oracle.rehearsal_build import Rehearsal, TriedPath
from crowdbot.plugins.planners.oracle.whole_forecast_build import WholeForecast
from crowdbot.plugins.planners.people_mpc import plans_build as plans
from crowdbot.plugins.planners.people_mpc.people_mpc import PeopleMpcSpec
from crowdbot.plugins.planners.people_mpc.people_mpc_build import PeopleMpc
from crowdbot.plugins.planners.shared.distance_field_build import distance_at
from crowdbot.plugins.planners.shared.surroundings_build import PlannerScene

#: Plans that are tried if one touches someone: share of its speed, and more turning, rad/s.
_OTHERS = (
    *((1.0, 0.4), (1.0, -0.4), (0.8, 0.0), (1.0, 0.8), (1.0, -0.8), (0.7, 0.4), (0.7, -0.4)),
    *((0.5, 0.0), (0.5, 0.8), (0.5, -0.8), (0.2, 0.0)),
)

#: Parameters of plans that keep the robot clear of people who may do something else.
_CLEARANCES = [plans.MARGIN, plans.COMFORT, plans.HURRY]

#: First velocity v, w, vy; angle of the second direction; pace: see `plans_build.roll`.
Plan = tuple[tuple[float, float, float], float, float]
#: x, y, yaw, v, w, vy of the robot.
State = tuple[float, float, float, float, float, float]


class Oracle(CrowdPrediction):
    """Predicts people as if the robot was not there; in each plan they then give way to it."""

    name = "oracle"

    def __init__(self, spec: OracleSpec) -> None:
        super().__init__(spec)
        self._forecast = WholeForecast(spec.crowd, spec.settle_time, spec.memory)
        self._knows = spec
        self._rehearsal = Rehearsal(spec.rehearse, self._robot)
        self._planned: tuple[State, tuple[float, float]] | None = None
        self._bold = self._careful = self._p

    def reset(
        self, task: Task, limits: RobotLimits, sensors: Mapping[str, SensorInfo], seed: int
    ) -> None:
        """Store the limits and mounts; compile kernels that are not compiled yet."""
        super().reset(task, limits, sensors, seed)
        self._radius = None
        self._rehearsal = Rehearsal(self._knows.rehearse, self._robot)
        self._bold, self._careful = self._p, self._p.copy()
        usual = PeopleMpc(PeopleMpcSpec()).parameters(limits)
        self._careful[_CLEARANCES] = usual[_CLEARANCES]

    def step(self, obs: Observation) -> Command:
        """Return the first command of the best plan.

        If the crowd can be simulated ahead, return that of a plan that touches no one there.
        """
        self._planned = None
        self._p = self._bold if self._rehearses(obs.truth) else self._careful
        command = super().step(obs)
        if self._planned is None or command == Command(0.0, 0.0) or obs.truth is None:
            return command
        tried = [(self._last, self._aside, self._pace), *self._others()]
        paths = self._paths(tried, *self._planned)
        chosen = self._rehearsal.first_clear(obs.truth, paths, self._planned[0][:3])
        self._last, self._aside, self._pace = tried[chosen]
        obs.log("oracle/rehearsed", float(chosen))
        return Command(*self._last)

    def _rehearses(self, truth: Truth | None) -> bool:
        return self._knows.rehearse > 0.0 and truth is not None and truth.foresee is not None

    def _others(self) -> Iterator[Plan]:
        """Yield plans like the last one: slower, or turning more to one side; then a stop."""
        (v, w, vy), most = self._last, float(self._p[plans.W_MAX])
        for share, turn in _OTHERS:
            first = share * v, max(-most, min(most, w + turn)), share * vy
            yield first, self._aside, share * self._pace
        yield (0.0, 0.0, 0.0), self._aside, 0.0

    def _paths(
        self, tried: Sequence[Plan], state: State, waypoint: tuple[float, float]
    ) -> Iterator[TriedPath]:
        """Yield the paths of plans that stay clear of walls, each also with a stop at once.

        The first one has been checked, and the last one is a stop.
        """
        for number, (first, aside, pace) in enumerate(tried):
            path = plans.path_of(self._p, state, waypoint, first, aside, pace)
            if number in (0, len(tried) - 1) or self._off_walls(path):
                yield TriedPath(number, path, stops=False)
                if pace > 0.0:
                    path = plans.path_of(self._p, state, waypoint, first, aside, 0.0)
                    yield TriedPath(number, path, stops=True)

    def _off_walls(self, path: Array) -> bool:
        """Return True if a path stays clear of walls and other static obstacles."""
        field, radius = self._field, float(self._robot[:, 2].max()) + 0.5 * self._knows.margin
        return all(
            distance_at(field.values, field.corner, x, y) > radius
            for x, y, _ in path[: self._rehearsal.steps].tolist()
        )

    def predicted(
        self, obs: Observation, scene: PlannerScene, rows: Indices, waypoint: tuple[float, float]
    ) -> Array:
        """Return where people will be, (T, N, 2); draw it."""
        assert obs.truth is not None
        if self._rehearses(obs.truth):
            pose = scene.pose
            self._rehearsal.see(obs.t, obs.truth)
            self._planned = (pose.x, pose.y, pose.yaw, *scene.twist), waypoint
        return super().predicted(obs, scene, rows, waypoint)

    def yields(self, obs: Observation, rows: Indices) -> Array:
        """Return from which time to contact people give way, (N,) s; never if it is not known."""
        assert obs.truth is not None
        notice = obs.truth.people_notice
        return notice[rows] if len(notice) else np.zeros(len(rows))


build = Oracle
