"""Scoring of reaching the goal: success, directness and progress."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import crowdbot.plugins.metrics.task as specs
from crowdbot.plugin import (
    References,
    Score,
    Trajectories,
    duration,
    path_length,
    travel_time,
    truncate_at_arrival,
)
from crowdbot.plugin.for_metrics import durations, robot_of
from crowdbot.plugins.metrics.collision_build import events
from crowdbot.plugins.metrics.common_reference_build import (
    goal_distance,
    robot_with_task,
    shortest_way,
)
from crowdbot.plugins.metrics.declared_build import DeclaredMetric, UndefinedError
from crowdbot.plugins.metrics.path_efficiency_build import obstacle

#: Tolerance of progress, m, and of time windows, s, so that rounding does not decide.
TOLERANCE = 1e-9


class Success(DeclaredMetric[specs.SuccessSpec]):
    """Scores ``success``: 1 if there is an arrival time, else 0."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        robot = robot_with_task(run)
        return [self.factory.ok("corrected", robot.goal_time is not None)]


class SuccessNoCollision(DeclaredMetric[specs.SuccessNoCollisionSpec]):
    """Scores ``success_no_collision``: 1 for arrival without any contact in the motion, else 0."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        robot = robot_with_task(run)
        free = not len(events(truncate_at_arrival(run), self.spec))
        return [self.factory.ok("corrected", robot.goal_time is not None and free)]


class Timeout(DeclaredMetric[specs.TimeoutSpec]):
    """Scores ``timeout``: 1 if the robot did not arrive, else 0."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        robot = robot_with_task(run)
        return [self.factory.ok("corrected", robot.goal_time is None)]


class Spl(DeclaredMetric[specs.SplSpec]):
    """Scores ``spl``: shortest path over the longer of it and the driven path.

    0 without arrival. Needs a goal. Anderson et al. 2018.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        shortest, driven = _shortest_and_driven(run, self.spec)
        if robot_of(run).goal_time is None:
            return [self.factory.ok("corrected", 0.0)]
        return [
            self.factory.ratio("corrected", shortest, max(driven, shortest), self.spec.zero_tol)
        ]


class PathEfficiency(DeclaredMetric[specs.PathEfficiencySpec]):
    """Scores ``path_efficiency``: shortest over driven path; an upper bound without arrival.

    Needs a goal, and an arrival.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        lengths = _shortest_and_driven(run, self.spec)
        ratio = self.factory.ratio("corrected", *lengths, self.spec.zero_tol)
        if robot_of(run).goal_time is not None:
            return [ratio]
        return [
            self.factory.censored("corrected", "goal_not_reached", lower=0.0, upper=ratio.value)
        ]


class Stl(DeclaredMetric[specs.StlSpec]):
    """Scores ``stl``: time alone over the longer of it and the time taken; 0 without arrival.

    Needs ``robot_alone``.
    """

    def _scores(self, run: Trajectories, refs: References) -> Sequence[Score]:
        robot = robot_with_task(run)
        if reason := obstacle(run, refs):
            raise UndefinedError(reason)
        assert refs.robot_alone is not None
        if robot.goal_time is None:
            return [self.factory.ok("corrected", 0.0)]
        alone, taken = (travel_time(r, robot_of(r)) for r in (refs.robot_alone, run))
        return [self.factory.ratio("corrected", alone, max(alone, taken), self.spec.zero_tol)]


class FinalDistanceToGoal(DeclaredMetric[specs.FinalDistanceToGoalSpec]):
    """Scores ``final_distance_to_goal``: the distance at the last known position.

    Needs a goal point or zone.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        return [self.factory.ok("corrected", goal_distance(run)[1][-1])]


class MinDistanceToGoal(DeclaredMetric[specs.MinDistanceToGoalSpec]):
    """Scores ``min_distance_to_goal``: the smallest distance at any sample up to the arrival.

    Needs a goal point or zone.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        return [self.factory.ok("corrected", goal_distance(run)[1].min())]


class FailureToProgress(DeclaredMetric[specs.FailureToProgressSpec]):
    """Scores ``failure_to_progress``: number of windows in which the goal came no nearer.

    Complete, consecutive windows from the start. Needs a goal point or zone.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        t, distance = goal_distance(run)
        windows = int((duration(t) + TOLERANCE) / self.spec.progress_window)
        edges = t[0] + self.spec.progress_window * np.arange(windows + 1)
        nearer = -np.diff(np.interp(edges, t, distance))
        stuck = nearer < self.spec.progress_distance - TOLERANCE
        return [self.factory.ok("corrected", stuck.sum(), {"windows": float(windows)})]


class AggregatedTime(DeclaredMetric[specs.AggregatedTimeSpec]):
    """Scores ``aggregated_time``: sum of times; a lower bound if anyone had not arrived."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        robot_with_task(run)
        run = truncate_at_arrival(run)
        trips = durations(run)
        total = travel_time(run, robot_of(run)) + float(trips.seconds.sum())
        if robot_of(run).goal_time is None:
            return [self.factory.censored("corrected", "goal_not_reached", lower=total)]
        if not trips.reached.all():
            return [self.factory.censored("corrected", "unfinished_trips", lower=total)]
        return [self.factory.ok("corrected", total)]


def _shortest_and_driven(
    run: Trajectories, spec: specs.SplSpec | specs.PathEfficiencySpec
) -> tuple[float, float]:
    """Return the straight distance from start to goal zone or disc, and the driven one, m."""
    shortest = shortest_way(run)
    run = truncate_at_arrival(run)
    return shortest, path_length(run.t, robot_of(run), spec.jump_speed)
