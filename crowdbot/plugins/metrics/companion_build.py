"""Scoring of tasks whose goal is a person; gaps are between surfaces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

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
from crowdbot.plugins.metrics.companion import (
    ASSISTED,
    PERSON_ANGLE_ERROR,
    PERSON_COMFORT,
    PERSON_DISTANCE_ERROR,
    TIME_IN_PLACE,
    TIME_TO_PLACE,
    AssistedSpec,
    PersonAngleErrorSpec,
    PersonComfortSpec,
    PersonDistanceErrorSpec,
    TimeInPlaceSpec,
    TimeToPlaceSpec,
)

#: Tolerance at the edges of zones, m, and of times, s: rounding does not decide.
EDGE = 1e-9


@dataclass(frozen=True, slots=True)
class Assisted:
    """Scores ``assisted``. Needs no reference run."""

    spec: AssistedSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score 1 if done, untouched, and never nearer than the task or the zone allows."""
        del refs
        factory, found = ScoreFactory(ASSISTED), person_stance(run, self.spec.jump_speed)
        if isinstance(found, str):
            return factory.all_undefined(found)
        allowed = min(self.spec.intimate, found.task.distance - found.task.tolerance)
        least = float(np.nanmin(found.gap))
        kind = not found.touched and least >= allowed - EDGE
        done = robot_of(run).goal_time is not None
        extras = {"done": float(done), "touched": float(found.touched), "least_gap": least}
        return [factory.ok("corrected", done and kind, extras)]


@dataclass(frozen=True, slots=True)
class TimeInPlace:
    """Scores ``time_in_place``. Needs no reference run."""

    spec: TimeInPlaceSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score ``corrected``: the share of all time.

        ``since``: of the time since the robot was in place for the first time; 0 if it never was.
        """
        del refs
        factory, found = ScoreFactory(TIME_IN_PLACE), person_stance(run, self.spec.jump_speed)
        if isinstance(found, str):
            return factory.all_undefined(found)
        if (whole := duration(found.t)) <= 0.0:
            return factory.all_undefined("too_few_samples")
        inside = float(time_weights(found.t) @ found.in_place)
        first = int(np.argmax(found.in_place))
        rest = whole if not found.in_place.any() else float(found.t[-1] - found.t[first])
        kept = float(time_weights(found.t[first:]) @ found.in_place[first:]) if rest > 0 else 1.0
        since = kept / rest if rest > 0 else kept
        return [
            factory.ok("corrected", min(inside / whole, 1.0), {"in_place": inside}),
            factory.ok("since", min(since, 1.0)),
        ]


@dataclass(frozen=True, slots=True)
class TimeToPlace:
    """Scores ``time_to_place``. Needs no reference run."""

    spec: TimeToPlaceSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the time of the first sample in place; a lower bound if there is none."""
        del refs
        factory, found = ScoreFactory(TIME_TO_PLACE), person_stance(run, self.spec.jump_speed)
        if isinstance(found, str):
            return factory.all_undefined(found)
        if not found.in_place.any():
            return [factory.censored("corrected", "never_in_place", lower=duration(found.t))]
        return [factory.ok("corrected", found.t[int(np.argmax(found.in_place))] - found.t[0])]


@dataclass(frozen=True, slots=True)
class PersonDistanceError:
    """Scores ``person_distance_error``. Needs no reference run."""

    spec: PersonDistanceErrorSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the mean over the time that the task asks for."""
        del refs
        factory = ScoreFactory(PERSON_DISTANCE_ERROR)
        found = person_stance(run, self.spec.jump_speed)
        if isinstance(found, str):
            return factory.all_undefined(found)
        return [_mean(factory, found, np.abs(found.gap - found.task.distance), "no_agents")]


@dataclass(frozen=True, slots=True)
class PersonAngleError:
    """Scores ``person_angle_error``. Needs no reference run."""

    spec: PersonAngleErrorSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the mean over the time that the task asks for, while the person has a front."""
        del refs
        factory = ScoreFactory(PERSON_ANGLE_ERROR)
        found = person_stance(run, self.spec.jump_speed)
        if isinstance(found, str):
            return factory.all_undefined(found)
        return [_mean(factory, found, found.aside, "no_front")]


@dataclass(frozen=True, slots=True)
class PersonComfort:
    """Scores ``person_comfort``. Needs no reference run."""

    spec: PersonComfortSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score 1 less half the mean and half the peak of the discomfort within social distance."""
        del refs
        factory, found = ScoreFactory(PERSON_COMFORT), person_stance(run, self.spec.jump_speed)
        if isinstance(found, str):
            return factory.all_undefined(found)
        near = np.isfinite(found.gap) & (found.gap < self.spec.social - EDGE)
        weights = np.where(near, time_weights(found.t), 0.0)
        if weights.sum() <= 0.0:
            return factory.all_undefined("no_neighbours")
        felt = np.where(near, self._discomfort(found), 0.0)
        mean, peak = float(weights @ felt / weights.sum()), float(felt.max())
        peak = 1.0 if found.touched else peak
        extras = {"mean": mean, "peak": peak, "time_near": float(weights.sum())}
        return [factory.ok("corrected", 1.0 - 0.5 * (mean + peak), extras)]

    def _discomfort(self, found: PersonStance) -> Array:
        """Return what is missing to the intimate zone's edge, or to the time, as a share (N,)."""
        gap = np.maximum(np.nan_to_num(found.gap, nan=np.inf), 0.0)
        edge = max(self.spec.intimate, EDGE)
        allowed = np.maximum(np.nan_to_num(found.advance), 0.0) * self.spec.rush_time
        room = np.clip(1.0 - gap / edge, 0.0, 1.0)
        time = np.clip(1.0 - gap / np.maximum(allowed, EDGE), 0.0, 1.0)
        worst: Array = np.maximum(room, time)
        return worst


def _mean(factory: ScoreFactory, found: PersonStance, values: Array, missing: str) -> Score:
    """Score a mean over time: of ``approach`` over its last ``hold`` seconds, else over all."""
    counted: Mask = np.isfinite(values)
    if found.task.kind == "approach":
        counted &= found.t >= found.t[-1] - found.task.hold - EDGE
    if not counted.any():
        return factory.undefined("corrected", missing)
    weights = np.where(counted, time_weights(found.t), 0.0)
    if weights.sum() <= 0.0:
        return factory.undefined("corrected", "too_few_samples")
    return factory.ok("corrected", float(weights @ np.where(counted, values, 0.0) / weights.sum()))
