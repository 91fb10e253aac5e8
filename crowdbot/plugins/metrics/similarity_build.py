"""Scoring of similarity between the robot's motion and that of people around it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import crowdbot.plugins.metrics.similarity as specs
from crowdbot.plugin import (
    Array,
    References,
    Score,
    ScoreFactory,
    Trajectories,
    path_length,
    time_weights,
    travel_time,
)
from crowdbot.plugin.for_metrics import (
    DISTANCE_TOLERANCE,
    displacement,
    durations,
    encounter,
    heading_changes,
    people,
    people_speeds,
    people_velocities,
    robot_of,
    robot_velocities,
    valid_agent_steps,
    walked_distances,
    wrap,
)
from crowdbot.plugins.metrics.common_reference_build import missed_goal
from crowdbot.plugins.metrics.declared_build import RobotMetric, UndefinedError

#: Tolerance for which bodies have a heading, m/s.
SPEED_TOLERANCE = 1e-9


class TimeToGoalSimilarity(RobotMetric[specs.TimeToGoalSimilaritySpec]):
    """Scores ``time_to_goal_similarity``: the robot's time to goal over that of people.

    ``corrected``: each per straight distance. Needs trips, and no reference run.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        trips = durations(run)
        if not len(trips):
            raise UndefinedError("no_trips")
        time, zero_tol = travel_time(run, robot_of(run)), self.spec.zero_tol
        straight = walked_distances(run, self.spec.jump_speed)[1]
        return [
            _against_mean(self.factory, run, time, trips.seconds, zero_tol),
            _per_distance(
                self.factory, run, (time, float(trips.seconds.sum())), straight, self.spec
            ),
        ]


class PathLengthSimilarity(RobotMetric[specs.PathLengthSimilaritySpec]):
    """Scores ``path_length_similarity``: the robot's path length over that of people.

    ``corrected``: each per straight distance. Needs trips, and no reference run.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        jump = self.spec.jump_speed
        if not len(durations(run)):
            raise UndefinedError("no_trips")
        length, zero_tol = path_length(run.t, robot_of(run), jump), self.spec.zero_tol
        lengths, straight = walked_distances(run, jump)
        return [
            _against_mean(self.factory, run, length, lengths, zero_tol),
            _per_distance(self.factory, run, (length, float(lengths.sum())), straight, self.spec),
        ]


class HeadingSimilarity(RobotMetric[specs.HeadingSimilaritySpec]):
    """Scores ``heading_similarity``: the ratio of mean absolute turning rates.

    ``literal``: the mean ratio of signed rates.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        if len(run.t) < 2:
            raise UndefinedError("too_few_samples")
        dt = np.diff(run.t)
        robot = heading_changes(run.t, robot_of(run), self.spec.jump_speed) / dt
        rates = self._rates(run)
        known = np.isfinite(rates)
        count = known.sum(axis=1)
        some = (count > 0) & np.isfinite(robot)
        if not some.any():
            raise UndefinedError("no_heading" if people(run).x.size else "no_agents")
        rates, count = np.where(known, rates, 0.0)[some], count[some]
        signed, absolute = rates.sum(axis=1) / count, np.abs(rates).sum(axis=1) / count
        robot, dt = robot[some], dt[some]
        literal = mean_ratio(self.factory, robot, signed, len(run.t) - 1, self.spec.zero_tol)
        means = float(dt @ np.abs(robot)), float(dt @ absolute)
        corrected = self.factory.ratio("corrected", *means, self.spec.zero_tol)
        return [literal, of_arrival(self.factory, run, corrected)]

    def _rates(self, run: Trajectories) -> Array:
        """Return the turning rates of people (N-1, M), rad/s; NaN unless walking at both ends."""
        jump = self.spec.jump_speed
        vx, vy = people_velocities(run, jump)
        walks = people_speeds(run, jump) > self.spec.heading_min_speed + SPEED_TOLERANCE
        valid = valid_agent_steps(run.t, people(run), jump) & walks[1:] & walks[:-1]
        turn = wrap(np.diff(np.arctan2(vy, vx), axis=0))
        return np.where(valid, turn, np.nan) / np.diff(run.t)[:, None]


class VelocitySimilarity(RobotMetric[specs.VelocitySimilaritySpec]):
    """Scores ``velocity_similarity``: the robot's speed over the mean speed of all people."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        speeds = people_speeds(run, self.spec.jump_speed)
        return _speed_scores(self.factory, run, speeds, self.spec, "no_agents")


class NeighbourVelocitySimilarity(RobotMetric[specs.NeighbourVelocitySimilaritySpec]):
    """Scores ``neighbour_velocity_similarity``: speed over the mean speed of people near it."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        speeds, distance = (
            people_speeds(run, self.spec.jump_speed),
            encounter(run, self.spec.jump_speed).distance,
        )
        near = distance <= self.spec.neighbour_radius + DISTANCE_TOLERANCE
        nobody = "no_neighbours" if np.isfinite(speeds).any() else "no_agents"
        return _speed_scores(self.factory, run, np.where(near, speeds, np.nan), self.spec, nobody)


def of_arrival(factory: ScoreFactory, run: Trajectories, score: Score) -> Score:
    """Return the score, marked as partial if the robot missed its goal.

    Similarity of an unfinished run is unknown: it may have stopped in front of the crowd.
    """
    if not missed_goal(run) or score.value is None:
        return score
    so_far = {**score.extras, "so_far": score.value}
    return factory.censored(score.variant, "goal_not_reached", extras=so_far)


# ------------------------------------------------------------------- trip ratios
def _against_mean(
    factory: ScoreFactory, run: Trajectories, robot: float, each: Array, zero_tol: float
) -> Score:
    """Score the robot against the mean of completed trips; a lower bound without arrival."""
    assert run.trips is not None
    if not run.trips.reached.any():
        return factory.undefined("literal", "no_completed_trips")
    mean = float(each[run.trips.reached].mean())
    both = {"robot": robot, "agents": mean}
    ratio = factory.ratio("literal", robot, mean, zero_tol, both)
    if robot_of(run).goal_time is not None or ratio.value is None:
        return ratio
    return factory.censored("literal", "goal_not_reached", lower=ratio.value, extras=both)


def _per_distance(
    factory: ScoreFactory,
    run: Trajectories,
    amounts: tuple[float, float],
    straight: Array,
    spec: specs.TimeToGoalSimilaritySpec | specs.PathLengthSimilaritySpec,
) -> Score:
    """Score amounts of the robot and of all people, each per straight distance."""
    robot = robot_of(run)
    own, others = displacement(robot.x, robot.y), float(straight.sum())
    if min(own, others) <= spec.zero_tol:
        return factory.undefined("corrected", "zero_denominator")
    both = {"robot": amounts[0] / own, "agents": amounts[1] / others}
    ratio = factory.ratio("corrected", both["robot"], both["agents"], spec.zero_tol, both)
    return of_arrival(factory, run, ratio)


# ------------------------------------------------------------------ rates, speeds
def mean_ratio(
    factory: ScoreFactory, above: Array, below: Array, samples: int, zero_tol: float
) -> Score:
    """Score ``literal``: the unweighted mean of the ratios that exist, and their share."""
    usable = np.abs(below) > zero_tol
    if not usable.any():
        return factory.undefined("literal", "zero_denominator")
    mean = float((above[usable] / below[usable]).mean())
    return factory.ok("literal", mean, {"coverage": float(usable.sum()) / samples})


def _speed_scores(
    factory: ScoreFactory,
    run: Trajectories,
    speeds: Array,
    spec: specs.VelocitySimilaritySpec | specs.NeighbourVelocitySimilaritySpec,
    nobody: str,
) -> list[Score]:
    """Score mean of ratios and ratio of means over the samples at which anyone moves."""
    known = np.isfinite(speeds)
    count = known.sum(axis=1)
    robot = np.hypot(*robot_velocities(run, spec.jump_speed))
    some = (count > 0) & np.isfinite(robot)
    if not some.any():
        raise UndefinedError(nobody)
    mean = np.where(known, speeds, 0.0)[some].sum(axis=1) / count[some]
    robot, weights = robot[some], time_weights(run.t)[some]
    literal = mean_ratio(factory, robot, mean, len(run.t), spec.zero_tol)
    moving = mean > spec.zero_tol
    span = float(weights[moving].sum())
    if moving.any() and span <= 0:
        return [literal, factory.undefined("corrected", "too_few_samples")]
    means = float(weights[moving] @ robot[moving]), float(weights[moving] @ mean[moving])
    extras = {"coverage": float(moving.sum()) / len(run.t)}
    return [literal, of_arrival(factory, run, factory.ratio("corrected", *means, 0.0, extras))]
