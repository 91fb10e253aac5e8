"""Scoring of tasks whose goal is a person; gaps are between surfaces."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import crowdbot.plugins.metrics.companion as specs
from crowdbot.plugin import (
    Array,
    Mask,
    References,
    Score,
    ScoreFactory,
    Trajectories,
    duration,
    time_weights,
)
from crowdbot.plugin.for_metrics import PersonStance, person_stance, robot_of
from crowdbot.plugins.metrics.declared_build import DeclaredMetric, UndefinedError

#: Tolerance at the edges of zones, m, and of times, s: rounding does not decide.
EDGE = 1e-9


def _stance(run: Trajectories, jump_speed: float) -> PersonStance:
    """Return the robot's place beside the person; raise `UndefinedError` if there is none."""
    found = person_stance(run, jump_speed)
    if isinstance(found, str):
        raise UndefinedError(found)
    return found


class Assisted(DeclaredMetric[specs.AssistedSpec]):
    """Scores ``assisted``: 1 if done, untouched, and no nearer than task and zone allow."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        found = _stance(run, self.spec.jump_speed)
        allowed = min(self.spec.intimate, found.task.distance - found.task.tolerance)
        least = float(np.nanmin(found.gap))
        kind = not found.touched and least >= allowed - EDGE
        done = robot_of(run).goal_time is not None
        extras = {"done": float(done), "touched": float(found.touched), "least_gap": least}
        return [self.factory.ok("corrected", done and kind, extras)]


class TimeInPlace(DeclaredMetric[specs.TimeInPlaceSpec]):
    """Scores ``time_in_place``: the share of all time in place.

    ``since``: of the time since the robot was in place for the first time; 0 if it never was.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        found = _stance(run, self.spec.jump_speed)
        if (whole := duration(found.t)) <= 0.0:
            raise UndefinedError("too_few_samples")
        inside = float(time_weights(found.t) @ found.in_place)
        first = int(np.argmax(found.in_place))
        rest = whole if not found.in_place.any() else float(found.t[-1] - found.t[first])
        kept = float(time_weights(found.t[first:]) @ found.in_place[first:]) if rest > 0 else 1.0
        since = kept / rest if rest > 0 else kept
        return [
            self.factory.ok("corrected", min(inside / whole, 1.0), {"in_place": inside}),
            self.factory.ok("since", min(since, 1.0)),
        ]


class TimeToPlace(DeclaredMetric[specs.TimeToPlaceSpec]):
    """Scores ``time_to_place``: time of the first sample in place; without one, a lower bound."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        found = _stance(run, self.spec.jump_speed)
        if not found.in_place.any():
            return [self.factory.censored("corrected", "never_in_place", lower=duration(found.t))]
        return [self.factory.ok("corrected", found.t[int(np.argmax(found.in_place))] - found.t[0])]


class PersonDistanceError(DeclaredMetric[specs.PersonDistanceErrorSpec]):
    """Scores ``person_distance_error``: the mean over the time that the task asks for."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        found = _stance(run, self.spec.jump_speed)
        return [_mean(self.factory, found, np.abs(found.gap - found.task.distance), "no_agents")]


class PersonAngleError(DeclaredMetric[specs.PersonAngleErrorSpec]):
    """Scores ``person_angle_error``: the mean over the time that the task asks for.

    Only time in which the person has a front counts.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        found = _stance(run, self.spec.jump_speed)
        return [_mean(self.factory, found, found.aside, "no_front")]


class PersonComfort(DeclaredMetric[specs.PersonComfortSpec]):
    """Scores ``person_comfort``: 1 less half the mean and half the peak of the discomfort.

    Only time within social distance counts.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        found = _stance(run, self.spec.jump_speed)
        near = np.isfinite(found.gap) & (found.gap < self.spec.social - EDGE)
        weights = np.where(near, time_weights(found.t), 0.0)
        if weights.sum() <= 0.0:
            raise UndefinedError("no_neighbours")
        felt = np.where(near, self._discomfort(found), 0.0)
        mean, peak = float(weights @ felt / weights.sum()), float(felt.max())
        peak = 1.0 if found.touched else peak
        extras = {"mean": mean, "peak": peak, "time_near": float(weights.sum())}
        return [self.factory.ok("corrected", 1.0 - 0.5 * (mean + peak), extras)]

    def _discomfort(self, stance: PersonStance) -> Array:
        """Return the discomfort (N,) from 0 to 1: the larger lack of room or of time to contact."""
        gap = np.maximum(np.nan_to_num(stance.gap, nan=np.inf), 0.0)
        edge = max(self.spec.intimate, EDGE)
        allowed = np.maximum(np.nan_to_num(stance.advance), 0.0) * self.spec.rush_time
        room = np.clip(1.0 - gap / edge, 0.0, 1.0)
        time = np.clip(1.0 - gap / np.maximum(allowed, EDGE), 0.0, 1.0)
        worst: Array = np.maximum(room, time)
        return worst


def _mean(factory: ScoreFactory, stance: PersonStance, values: Array, missing: str) -> Score:
    """Score a mean over time: of ``approach`` over its last ``hold`` seconds, else over all."""
    counted: Mask = np.isfinite(values)
    if stance.task.kind == "approach":
        counted &= stance.t >= stance.t[-1] - stance.task.hold - EDGE
    if not counted.any():
        return factory.undefined("corrected", missing)
    weights = np.where(counted, time_weights(stance.t), 0.0)
    if weights.sum() <= 0.0:
        return factory.undefined("corrected", "too_few_samples")
    return factory.ok("corrected", float(weights @ np.where(counted, values, 0.0) / weights.sum()))
