"""Whether, how directly and how steadily the robot reaches its goal, computed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crowdbot.core.encounter import robot_of
from crowdbot.core.footprint import Footprint
from crowdbot.core.interfaces import References
from crowdbot.core.preprocess import cropped, duration, path_length, present, travel_time
from crowdbot.core.score import Score
from crowdbot.core.score_label import ScoreLabel
from crowdbot.core.trajectory import Array, Trajectories
from crowdbot.core.trips import durations
from crowdbot.plugins.metrics.collision_build import events
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

#: Slack of progress, m, and of windows of time, s: rounding decides nothing.
TOLERANCE = 1e-9


@dataclass(frozen=True, slots=True)
class Success:
    """Needs no reference run."""

    spec: SuccessSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Whether there is a time of arrival."""
        del refs
        if run.robot is None:
            return SUCCESS.label.all_undefined("invalid_no_robot")
        return [SUCCESS.label.ok("corrected", run.robot.goal_time is not None)]


@dataclass(frozen=True, slots=True)
class SuccessNoCollision:
    """Needs no reference run."""

    spec: SuccessNoCollisionSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Arrival without a contact of the motion with anybody."""
        del refs
        label = SUCCESS_NO_COLLISION.label
        if run.robot is None:
            return label.all_undefined("invalid_no_robot")
        free = not len(events(cropped(run), self.spec).time)
        return [label.ok("corrected", run.robot.goal_time is not None and free)]


@dataclass(frozen=True, slots=True)
class Timeout:
    """Needs no reference run."""

    spec: TimeoutSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """The opposite of ``success``."""
        del refs
        if run.robot is None:
            return TIMEOUT.label.all_undefined("invalid_no_robot")
        return [TIMEOUT.label.ok("corrected", run.robot.goal_time is None)]


@dataclass(frozen=True, slots=True)
class Spl:
    """Needs a goal. Anderson et al. 2018."""

    spec: SplSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """0 without arrival; else the shortest path over the longer of it and the driven one."""
        del refs
        label = SPL.label
        lengths = _shortest_and_driven(label, run, self.spec)
        if isinstance(lengths, list):
            return lengths
        shortest, driven = lengths
        if robot_of(run).goal_time is None:
            return [label.ok("corrected", 0.0)]
        return [label.ratio("corrected", shortest, max(driven, shortest), self.spec.zero_tol)]


@dataclass(frozen=True, slots=True)
class PathEfficiency:
    """Needs a goal, and an arrival."""

    spec: PathEfficiencySpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Shortest path over driven path; known from above without arrival."""
        del refs
        label = PATH_EFFICIENCY.label
        lengths = _shortest_and_driven(label, run, self.spec)
        if isinstance(lengths, list):
            return lengths
        ratio = label.ratio("corrected", *lengths, self.spec.zero_tol)
        if robot_of(run).goal_time is not None:
            return [ratio]
        return [label.censored("corrected", "goal_not_reached", upper=ratio.value)]


@dataclass(frozen=True, slots=True)
class Stl:
    """Needs ``robot_alone``."""

    spec: StlSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """0 without arrival; else the time alone over the longer of it and the time taken."""
        label = STL.label
        if reason := obstacle(run, refs):
            return label.all_undefined(reason)
        assert refs.robot_alone is not None
        if robot_of(run).goal_time is None:
            return [label.ok("corrected", 0.0)]
        alone, taken = (travel_time(r, robot_of(r)) for r in (refs.robot_alone, run))
        return [label.ratio("corrected", alone, max(alone, taken), self.spec.zero_tol)]


@dataclass(frozen=True, slots=True)
class FinalDistanceToGoal:
    """Needs a goal point or zone."""

    spec: FinalDistanceToGoalSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """At the last known position up to the arrival."""
        del refs
        label = FINAL_DISTANCE_TO_GOAL.label
        found = goal_distance(label, run)
        return found if isinstance(found, list) else [label.ok("corrected", found[1][-1])]


@dataclass(frozen=True, slots=True)
class MinDistanceToGoal:
    """Needs a goal point or zone."""

    spec: MinDistanceToGoalSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """At any sample up to the arrival."""
        del refs
        label = MIN_DISTANCE_TO_GOAL.label
        found = goal_distance(label, run)
        return found if isinstance(found, list) else [label.ok("corrected", found[1].min())]


@dataclass(frozen=True, slots=True)
class FailureToProgress:
    """Needs a goal point or zone."""

    spec: FailureToProgressSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Whole windows, one after the other from the start, in which the goal came no nearer."""
        del refs
        label = FAILURE_TO_PROGRESS.label
        found = goal_distance(label, run)
        if isinstance(found, list):
            return found
        t, distance = found
        windows = int((duration(t) + TOLERANCE) / self.spec.progress_window)
        edges = t[0] + self.spec.progress_window * np.arange(windows + 1)
        nearer = -np.diff(np.interp(edges, t, distance))
        stuck = nearer < self.spec.progress_distance - TOLERANCE
        return [label.ok("corrected", stuck.sum(), {"windows": float(windows)})]


@dataclass(frozen=True, slots=True)
class AggregatedTime:
    """Needs no reference run."""

    spec: AggregatedTimeSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Known from below where the robot, or somebody, had not arrived."""
        del refs
        label = AGGREGATED_TIME.label
        if run.robot is None:
            return label.all_undefined("invalid_no_robot")
        run = cropped(run)
        trips = durations(run)
        total = travel_time(run, robot_of(run)) + float(trips.seconds.sum())
        if robot_of(run).goal_time is None:
            return [label.censored("corrected", "goal_not_reached", lower=total)]
        if not trips.reached.all():
            return [label.censored("corrected", "unfinished_trips", lower=total)]
        return [label.ok("corrected", total)]


def goal_distance(label: ScoreLabel, run: Trajectories) -> tuple[Array, Array] | list[Score]:
    """Times and distances (K,), (K,) of the robot's centre from its goal, s and m; or why not.

    From the goal point; from the zone where only that is known.
    """
    if run.robot is None:
        return label.all_undefined("invalid_no_robot")
    run = cropped(run)
    robot = robot_of(run)
    known = present(robot.x, robot.y)
    if not known.any():
        return label.all_undefined("too_few_samples")
    x, y = robot.x[known], robot.y[known]
    if robot.goal is not None:
        return run.t[known], np.hypot(x - robot.goal[0], y - robot.goal[1])
    if run.goal_zone is not None:
        return run.t[known], np.maximum(Footprint(run.goal_zone, 0.0).gap(x, y), 0.0)
    return label.all_undefined("invalid_no_goal")


def _shortest_and_driven(
    label: ScoreLabel, run: Trajectories, spec: SplSpec | PathEfficiencySpec
) -> tuple[float, float] | list[Score]:
    """Straight from the start to the goal zone, or to the disc of the goal; and what was driven."""
    found = goal_distance(label, run)
    if isinstance(found, list):
        return found
    run = cropped(run)
    robot = robot_of(run)
    if run.goal_zone is not None:
        known = present(robot.x, robot.y)
        start = robot.x[known][:1], robot.y[known][:1]
        shortest = float(Footprint(run.goal_zone, 0.0).gap(*start)[0])
    else:
        shortest = float(found[1][0]) - robot.goal_radius
    return max(0.0, shortest), path_length(run.t, robot, spec.jump_speed)
