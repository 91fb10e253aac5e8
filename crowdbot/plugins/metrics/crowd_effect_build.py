"""Scoring of the robot's effect on the time and speed of people."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

import crowdbot.plugins.metrics.crowd_effect as specs
from crowdbot.plugin import (
    Array,
    References,
    Score,
    ScoreFactory,
    Trajectories,
    duration,
    time_weights,
    truncate_at_arrival,
)
from crowdbot.plugin.for_metrics import (
    DISTANCE_TOLERANCE,
    Durations,
    MeanPace,
    durations,
    encounter,
    inf_to_nan,
    mean_pace,
    meets_robot,
    people,
    people_speeds,
    samples_of_shorter,
    truncate_to_shorter,
)
from crowdbot.plugins.metrics.declared_build import DeclaredMetric, RobotMetric, UndefinedError
from crowdbot.plugins.metrics.pairing_build import paired_samples


class EffectOnTime(DeclaredMetric[specs.EffectOnTimeSpec]):
    """Scores ``effect_on_time`` of all trips, in the common time window.

    ``literal``: of completed trips. Needs ``crowd_alone``.
    """

    def _scores(self, run: Trajectories, refs: References) -> Sequence[Score]:
        if refs.crowd_alone is None:
            raise UndefinedError("no_reference")
        alone, run = truncate_at_arrival(refs.crowd_alone), truncate_at_arrival(run)
        literal = completed_ratio(
            self.factory, durations(alone), durations(run), self.spec.zero_tol
        )
        alone, run = truncate_to_shorter(alone, run)
        a, b = durations(alone), durations(run)
        if not len(a) or not len(b):
            return [literal, *self.factory.all_undefined("no_trips", self.factory.variants[1:])]
        mean = mean_ratio(self.factory, a, b, self.spec.zero_tol)
        paces = mean_pace(alone, self.spec.jump_speed), mean_pace(run, self.spec.jump_speed)
        return [
            literal,
            mean,
            self._restricted(a, b),
            pace_ratio(self.factory, *paces, self.spec.zero_tol),
        ]

    def _restricted(self, alone: Durations, crowded: Durations) -> Score:
        """Score the ratio of both means, restricted to the time up to which both are known."""
        tau = min(alone.longest, crowded.longest)
        means = alone.restricted_mean(tau), crowded.restricted_mean(tau)
        extras = {"tau": tau, **_both(alone, crowded, means)}
        return self.factory.ratio("restricted", *means, self.spec.zero_tol, extras)


class NeighboursTimeToGoal(RobotMetric[specs.NeighboursTimeToGoalSpec]):
    """Scores ``neighbours_time_to_goal``: people who meet the robot against all people.

    Needs trips, and no reference run.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        everybody = durations(run)
        if not len(everybody):
            raise UndefinedError("no_trips")
        met = meets_robot(run, self.spec.neighbour_radius)
        if not met.any():
            raise UndefinedError("no_neighbours")
        both = everybody.select(met), everybody
        jump = self.spec.jump_speed
        paces = mean_pace(run, jump, met), mean_pace(run, jump)
        return [
            completed_ratio(self.factory, *both, self.spec.zero_tol),
            mean_ratio(self.factory, *both, self.spec.zero_tol),
            pace_ratio(self.factory, *paces, self.spec.zero_tol),
        ]


class EffectOnVelocity(DeclaredMetric[specs.EffectOnVelocitySpec]):
    """Scores ``effect_on_velocity`` over the time in the common window.

    ``literal``: over all samples of both records. Needs ``crowd_alone``.
    """

    def _scores(self, run: Trajectories, refs: References) -> Sequence[Score]:
        if refs.crowd_alone is None:
            raise UndefinedError("no_reference")
        alone, run = truncate_at_arrival(refs.crowd_alone), truncate_at_arrival(run)
        literal = self._ratio("literal", alone, run, np.ones(len(alone.t)), np.ones(len(run.t)))
        alone, run = samples_of_shorter(alone, run)
        if min(duration(alone.t), duration(run.t)) <= 0:
            return [literal, self.factory.undefined("corrected", "too_few_samples")]
        weights = time_weights(alone.t), time_weights(run.t)
        return [literal, self._ratio("corrected", alone, run, *weights)]

    def _ratio(
        self, variant: str, alone: Trajectories, run: Trajectories, w_alone: Array, w_run: Array
    ) -> Score:
        jump = self.spec.jump_speed
        v_alone = pooled_mean(people_speeds(alone, jump), w_alone)
        v_run = pooled_mean(people_speeds(run, jump), w_run)
        if v_alone is None or v_run is None:
            return self.factory.undefined(variant, "no_agents")
        both = {"alone": v_alone, "crowded": v_run}
        return self.factory.ratio(variant, v_alone, v_run, self.spec.zero_tol, both)


class NeighboursVelocity(RobotMetric[specs.NeighboursVelocitySpec]):
    """Scores ``neighbours_velocity``: speeds near the robot against all speeds."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        weights = {"literal": np.ones(len(run.t)), "corrected": time_weights(run.t)}
        return [self._ratio(v, run, w) for v, w in weights.items()]

    def _ratio(self, variant: str, run: Trajectories, weights: Array) -> Score:
        speed = people_speeds(run, self.spec.jump_speed)
        if not np.isfinite(speed).any():
            return self.factory.undefined(variant, "no_agents")
        if not weights.any():
            return self.factory.undefined(variant, "too_few_samples")
        distance = encounter(run, self.spec.jump_speed).distance
        near = distance <= self.spec.neighbour_radius + DISTANCE_TOLERANCE
        v_near = pooled_mean(np.where(near, speed, np.nan), weights)
        v_all = pooled_mean(speed, weights)
        if v_near is None or v_all is None:
            return self.factory.undefined(variant, "no_neighbours")
        both = {"neighbours": v_near, "crowd": v_all}
        return self.factory.ratio(variant, v_near, v_all, self.spec.zero_tol, both)


class CrowdDeviation(DeclaredMetric[specs.CrowdDeviationSpec]):
    """Scores ``crowd_deviation``: the mean over samples with a person present in both runs.

    Needs ``crowd_alone`` with the same people at the same times.
    """

    def _scores(self, run: Trajectories, refs: References) -> Sequence[Score]:
        if refs.crowd_alone is None or refs.crowd_alone.agents is None:
            raise UndefinedError("no_reference")
        alone, run = truncate_at_arrival(refs.crowd_alone), truncate_at_arrival(run)
        samples = paired_samples(alone.t, run.t)
        if not len(samples[0]):
            raise UndefinedError("sampling_mismatch")
        a, b = people(alone), people(run)
        columns = np.intersect1d(a.id, b.id, return_indices=True)[1:]
        at_alone, at_run = (np.ix_(r, c) for r, c in zip(samples, columns, strict=True))
        rows = (
            inf_to_nan(p)[at_alone] - inf_to_nan(q)[at_run] for p, q in ((a.x, b.x), (a.y, b.y))
        )
        apart = np.hypot(*rows)
        known = np.isfinite(apart)
        if not known.any():
            raise UndefinedError("no_agents")
        return [self.factory.ok("corrected", float(apart[known].mean()))]


# ---------------------------------------------------------------------- ratios
def completed_ratio(
    factory: ScoreFactory, above: Durations, below: Durations, zero_tol: float
) -> Score:
    """Score the ratio of mean durations of completed trips (``literal``)."""
    if not len(above) or not len(below):
        return factory.undefined("literal", "no_trips")
    means = above.completed_mean(), below.completed_mean()
    if means[0] is None or means[1] is None:
        return factory.undefined("literal", "no_completed_trips")
    extras = _both(above, below, (means[0], means[1]))
    return factory.ratio("literal", means[0], means[1], zero_tol, extras)


def mean_ratio(factory: ScoreFactory, above: Durations, below: Durations, zero_tol: float) -> Score:
    """Score the ratio of Kaplan-Meier means (``corrected``).

    A bound if the longest trip is unfinished.
    """
    means = above.restricted_mean(above.longest), below.restricted_mean(below.longest)
    extras = _both(above, below, means)
    ratio = factory.ratio("corrected", *means, zero_tol, extras)
    if not above.open_ended and not below.open_ended:
        return ratio
    bound = ratio.value
    return factory.censored(
        "corrected",
        "unfinished_trips",
        lower=bound if not below.open_ended else None,
        upper=bound if not above.open_ended else None,
        extras=extras,
    )


def pace_ratio(factory: ScoreFactory, above: MeanPace, below: MeanPace, zero_tol: float) -> Score:
    """Score the ratio of mean paces of all trips, finished or not (``pace``)."""
    if not above.trips or not below.trips:
        return factory.undefined("pace", "no_trips")
    if above.value is None or below.value is None:
        return factory.undefined("pace", "no_movement")
    extras = {
        "numerator": above.value,
        "denominator": below.value,
        "trips_numerator": float(above.trips),
        "trips_denominator": float(below.trips),
    }
    return factory.ratio("pace", above.value, below.value, zero_tol, extras)


def pooled_mean(speed: Array, weights: Array) -> float | None:
    """Return the weighted mean over all known (sample, person) pairs, or None without any."""
    known = np.isfinite(speed)
    total = float(weights @ known.sum(axis=1))
    return float(weights @ np.where(known, speed, 0.0).sum(axis=1)) / total if total else None


def _both(above: Durations, below: Durations, means: tuple[float, float]) -> Mapping[str, float]:
    return {
        "numerator": means[0],
        "denominator": means[1],
        "trips_numerator": float(len(above)),
        "trips_denominator": float(len(below)),
        "completed_numerator": float(above.reached.sum()),
        "completed_denominator": float(below.reached.sum()),
    }
