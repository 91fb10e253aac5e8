"""Scoring of the robot's distance to people; between centres unless stated otherwise."""

from __future__ import annotations

import math
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
    truncate_at_arrival,
)
from crowdbot.plugin.for_metrics import DISTANCE_TOLERANCE, encounter
from crowdbot.plugins.metrics.proximity import (
    LOCAL_DENSITY,
    NEIGHBOUR_COUNT,
    NORMALIZED_PROXIMITY,
    PROXIMITY,
    LocalDensitySpec,
    NeighbourCountSpec,
    NormalizedProximitySpec,
    ProximitySpec,
)


@dataclass(frozen=True, slots=True)
class Proximity:
    """Scores ``proximity``. Needs no reference run. Samples without people add nothing."""

    spec: ProximitySpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score ``literal``: sum over samples.

        ``corrected``, ``outline``: floored mean over time.
        """
        del refs
        factory = ScoreFactory(PROXIMITY)
        if run.robot is None:
            return factory.all_undefined("invalid_no_robot")
        run = truncate_at_arrival(run)
        pair = encounter(run, np.inf)
        nearest, gap = (
            np.where(np.isfinite(apart), apart, np.inf).min(axis=1, initial=np.inf)
            for apart in (pair.distance, pair.gap)
        )
        if not np.isfinite(nearest.min()):
            return factory.all_undefined("no_agents")
        means = (self._mean(v, run.t, d) for v, d in (("corrected", nearest), ("outline", gap)))
        return [self._literal(nearest), *means]

    def _literal(self, nearest: Array) -> Score:
        if nearest.min() <= self.spec.length_tol:
            return ScoreFactory(PROXIMITY).undefined("literal", "zero_distance")
        return ScoreFactory(PROXIMITY).ok("literal", (1.0 / nearest).sum())

    def _mean(self, variant: str, t: Array, nearest: Array) -> Score:
        factory = ScoreFactory(PROXIMITY)
        if (span := duration(t)) <= 0:
            return factory.undefined(variant, "too_few_samples")
        mean = (
            float(time_weights(t) @ (1.0 / np.maximum(nearest, self.spec.proximity_floor))) / span
        )
        extras = {"shortest_distance": float(nearest.min())}
        if mean > 0:
            extras["harmonic_mean_distance"] = 1.0 / mean
        return factory.ok(variant, mean, extras)


@dataclass(frozen=True, slots=True)
class NormalizedProximity:
    """Scores ``normalized_proximity``. Needs no reference run."""

    spec: NormalizedProximitySpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score ``literal``, ``corrected``: spread over mean.

        ``barycentre``: the definition in the text.
        """
        del refs
        factory = ScoreFactory(NORMALIZED_PROXIMITY)
        if run.robot is None:
            return factory.all_undefined("invalid_no_robot")
        run = truncate_at_arrival(run)
        pair = encounter(run, np.inf)
        near = pair.distance <= self.spec.neighbour_radius + DISTANCE_TOLERANCE
        count = near.sum(axis=1)
        if not count.any():
            return factory.all_undefined("no_neighbours")
        share = np.maximum(count, 1)
        mean = np.where(near, pair.distance, 0.0).sum(axis=1) / share
        off = np.where(near, pair.distance - mean[:, None], 0.0)
        spread = np.sqrt((off**2).sum(axis=1) / share)
        centre = np.hypot(*(np.where(near, p, 0.0).sum(axis=1) / share for p in (pair.px, pair.py)))
        some, several = (count >= n for n in (1, 2))
        ones, weights = np.ones(len(run.t)), time_weights(run.t)
        return [
            self._mean("literal", spread, mean, some, ones),
            self._mean("corrected", spread, mean, several, weights),
            self._mean("barycentre", centre, mean, some, weights),
        ]

    def _mean(self, variant: str, above: Array, below: Array, rows: Mask, weights: Array) -> Score:
        """Score the weighted mean of ratios over the samples that have one."""
        factory = ScoreFactory(NORMALIZED_PROXIMITY)
        if not rows.any():
            return factory.undefined(variant, "fewer_than_two_neighbours")
        usable = rows & (below > self.spec.length_tol)
        if not usable.any():
            return factory.undefined(variant, "zero_distance")
        total = float(weights[usable].sum())
        if total <= 0:
            return factory.undefined(variant, "too_few_samples")
        mean = float(weights[usable] @ (above[usable] / below[usable])) / total
        return factory.ok(variant, mean, {"coverage": total / float(weights.sum())})


@dataclass(frozen=True, slots=True)
class NeighbourCount:
    """Scores ``neighbour_count``. Needs no reference run."""

    spec: NeighbourCountSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the mean number of neighbours over time."""
        del refs
        return [_crowding(ScoreFactory(NEIGHBOUR_COUNT), run, self.spec.neighbour_radius, 1.0)]


@dataclass(frozen=True, slots=True)
class LocalDensity:
    """Scores ``local_density``. Needs no reference run."""

    spec: LocalDensitySpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the mean over time of neighbours per area of their circle."""
        del refs
        radius = self.spec.neighbour_radius
        return [_crowding(ScoreFactory(LOCAL_DENSITY), run, radius, math.pi * radius**2)]


def _crowding(factory: ScoreFactory, run: Trajectories, radius: float, area: float) -> Score:
    if run.robot is None:
        return factory.undefined("corrected", "invalid_no_robot")
    run = truncate_at_arrival(run)
    if (span := duration(run.t)) <= 0:
        return factory.undefined("corrected", "too_few_samples")
    count = (encounter(run, np.inf).distance <= radius + DISTANCE_TOLERANCE).sum(axis=1)
    return factory.ok("corrected", time_weights(run.t) @ count / span / area)
