"""Scoring of reaching the goal: success, directness and progress."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crowdbot.plugin import (
    References,
    Score,
    ScoreFactory,
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
    shortest_way,
    without_task,
)
from crowdbot.plugins.metrics.path_efficiency_build import obstacle
from crowdbot.plugins.metrics.task import (
    AGGREGATED_TIME,
    FAILURE_TO_PROGRESS,
    FINAL_DISTANCE_TO_GOAL,
    MIN_DISTANCE_TO_GOAL,
    PATH_EFFICIENCY,
    SPL,
    STL,
    SUCCESS,
    SUCCESS_NO_COLLISION,
    TIMEOUT,
    AggregatedTimeSpec,
    FailureToProgressSpec,
    FinalDistanceToGoalSpec,
    MinDistanceToGoalSpec,
    PathEfficiencySpec,
    SplSpec,
    StlSpec,
    SuccessNoCollisionSpec,
    SuccessSpec,
    TimeoutSpec,
)

#: Tolerance of progress, m, and of time windows, s, so that rounding does not decide.
TOLERANCE = 1e-9


@dataclass(frozen=True, slots=True)
class Success:
    """Scores ``success``. Needs no reference run."""

    spec: SuccessSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score 1 if there is an arrival time, else 0."""
        del refs
        if reason := without_task(run):
            return ScoreFactory(SUCCESS).all_undefined(reason)
        assert run.robot is not None
        return [ScoreFactory(SUCCESS).ok("corrected", run.robot.goal_time is not None)]


@dataclass(frozen=True, slots=True)
class SuccessNoCollision:
    """Scores ``success_no_collision``. Needs no reference run."""

    spec: SuccessNoCollisionSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score 1 for arrival without any contact in the motion, else 0."""
        del refs
        factory = ScoreFactory(SUCCESS_NO_COLLISION)
        if reason := without_task(run):
            return factory.all_undefined(reason)
        assert run.robot is not None
        free = not len(events(truncate_at_arrival(run), self.spec))
        return [factory.ok("corrected", run.robot.goal_time is not None and free)]


@dataclass(frozen=True, slots=True)
class Timeout:
    """Scores ``timeout``. Needs no reference run."""

    spec: TimeoutSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the opposite of ``success``."""
        del refs
        if reason := without_task(run):
            return ScoreFactory(TIMEOUT).all_undefined(reason)
        assert run.robot is not None
        return [ScoreFactory(TIMEOUT).ok("corrected", run.robot.goal_time is None)]


@dataclass(frozen=True, slots=True)
class Spl:
    """Scores ``spl``. Needs a goal. Anderson et al. 2018."""

    spec: SplSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score 0 without arrival, else shortest path over the longer of it and the driven path."""
        del refs
        factory = ScoreFactory(SPL)
        lengths = _shortest_and_driven(factory, run, self.spec)
        if isinstance(lengths, list):
            return lengths
        shortest, driven = lengths
        if robot_of(run).goal_time is None:
            return [factory.ok("corrected", 0.0)]
        return [factory.ratio("corrected", shortest, max(driven, shortest), self.spec.zero_tol)]


@dataclass(frozen=True, slots=True)
class PathEfficiency:
    """Scores ``path_efficiency``. Needs a goal, and an arrival."""

    spec: PathEfficiencySpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score shortest over driven path; an upper bound without arrival."""
        del refs
        factory = ScoreFactory(PATH_EFFICIENCY)
        lengths = _shortest_and_driven(factory, run, self.spec)
        if isinstance(lengths, list):
            return lengths
        ratio = factory.ratio("corrected", *lengths, self.spec.zero_tol)
        if robot_of(run).goal_time is not None:
            return [ratio]
        return [factory.censored("corrected", "goal_not_reached", lower=0.0, upper=ratio.value)]


@dataclass(frozen=True, slots=True)
class Stl:
    """Scores ``stl``. Needs ``robot_alone``."""

    spec: StlSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score 0 without arrival, else the time alone over the longer of it and the time taken."""
        factory = ScoreFactory(STL)
        if reason := without_task(run) or obstacle(run, refs):
            return factory.all_undefined(reason)
        assert refs.robot_alone is not None
        if robot_of(run).goal_time is None:
            return [factory.ok("corrected", 0.0)]
        alone, taken = (travel_time(r, robot_of(r)) for r in (refs.robot_alone, run))
        return [factory.ratio("corrected", alone, max(alone, taken), self.spec.zero_tol)]


@dataclass(frozen=True, slots=True)
class FinalDistanceToGoal:
    """Scores ``final_distance_to_goal``. Needs a goal point or zone."""

    spec: FinalDistanceToGoalSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the distance at the last known position up to the arrival."""
        del refs
        factory = ScoreFactory(FINAL_DISTANCE_TO_GOAL)
        found = goal_distance(factory, run)
        return found if isinstance(found, list) else [factory.ok("corrected", found[1][-1])]


@dataclass(frozen=True, slots=True)
class MinDistanceToGoal:
    """Scores ``min_distance_to_goal``. Needs a goal point or zone."""

    spec: MinDistanceToGoalSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the smallest distance at any sample up to the arrival."""
        del refs
        factory = ScoreFactory(MIN_DISTANCE_TO_GOAL)
        found = goal_distance(factory, run)
        return found if isinstance(found, list) else [factory.ok("corrected", found[1].min())]


@dataclass(frozen=True, slots=True)
class FailureToProgress:
    """Scores ``failure_to_progress``. Needs a goal point or zone."""

    spec: FailureToProgressSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score complete consecutive windows from the start in which the goal came no nearer."""
        del refs
        factory = ScoreFactory(FAILURE_TO_PROGRESS)
        found = goal_distance(factory, run)
        if isinstance(found, list):
            return found
        t, distance = found
        windows = int((duration(t) + TOLERANCE) / self.spec.progress_window)
        edges = t[0] + self.spec.progress_window * np.arange(windows + 1)
        nearer = -np.diff(np.interp(edges, t, distance))
        stuck = nearer < self.spec.progress_distance - TOLERANCE
        return [factory.ok("corrected", stuck.sum(), {"windows": float(windows)})]


@dataclass(frozen=True, slots=True)
class AggregatedTime:
    """Scores ``aggregated_time``. Needs no reference run."""

    spec: AggregatedTimeSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the sum; a lower bound if the robot or any person had not arrived."""
        del refs
        factory = ScoreFactory(AGGREGATED_TIME)
        if reason := without_task(run):
            return factory.all_undefined(reason)
        run = truncate_at_arrival(run)
        trips = durations(run)
        total = travel_time(run, robot_of(run)) + float(trips.seconds.sum())
        if robot_of(run).goal_time is None:
            return [factory.censored("corrected", "goal_not_reached", lower=total)]
        if not trips.reached.all():
            return [factory.censored("corrected", "unfinished_trips", lower=total)]
        return [factory.ok("corrected", total)]


def _shortest_and_driven(
    factory: ScoreFactory, run: Trajectories, spec: SplSpec | PathEfficiencySpec
) -> tuple[float, float] | list[Score]:
    """Return the straight distance from start to goal zone or disc, and the driven distance."""
    found = shortest_way(factory, run)
    if isinstance(found, list):
        return found
    run = truncate_at_arrival(run)
    return found, path_length(run.t, robot_of(run), spec.jump_speed)
