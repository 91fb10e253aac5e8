"""Scoring of the robot's distance to people; between centres unless stated otherwise."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

import crowdbot.plugins.metrics.proximity as specs
from crowdbot.plugin import Array, Mask, References, Score, Trajectories, duration, time_weights
from crowdbot.plugin.for_metrics import DISTANCE_TOLERANCE, encounter
from crowdbot.plugins.metrics.declared_build import RobotMetric, UndefinedError


class Proximity(RobotMetric[specs.ProximitySpec]):
    """Scores ``proximity``: the mean over time of the reciprocal distance, which has a floor.

    ``literal``: the sum over samples. Samples without people add nothing.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        pair = encounter(run, np.inf)
        nearest, gap = (
            np.where(np.isfinite(apart), apart, np.inf).min(axis=1, initial=np.inf)
            for apart in (pair.distance, pair.gap)
        )
        if not np.isfinite(nearest.min()):
            raise UndefinedError("no_agents")
        means = (self._mean(v, run.t, d) for v, d in (("corrected", nearest), ("outline", gap)))
        return [self._literal(nearest), *means]

    def _literal(self, nearest: Array) -> Score:
        if nearest.min() <= self.spec.length_tol:
            return self.factory.undefined("literal", "zero_distance")
        return self.factory.ok("literal", (1.0 / nearest).sum())

    def _mean(self, variant: str, t: Array, nearest: Array) -> Score:
        if (span := duration(t)) <= 0:
            return self.factory.undefined(variant, "too_few_samples")
        mean = (
            float(time_weights(t) @ (1.0 / np.maximum(nearest, self.spec.proximity_floor))) / span
        )
        extras = {"shortest_distance": float(nearest.min())}
        if mean > 0:
            extras["harmonic_mean_distance"] = 1.0 / mean
        return self.factory.ok(variant, mean, extras)


class NormalizedProximity(RobotMetric[specs.NormalizedProximitySpec]):
    """Scores ``normalized_proximity``: spread of distances over their mean.

    ``barycentre``: the definition in the text of the source.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        pair = encounter(run, np.inf)
        near = pair.distance <= self.spec.neighbour_radius + DISTANCE_TOLERANCE
        count = near.sum(axis=1)
        if not count.any():
            raise UndefinedError("no_neighbours")
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
        if not rows.any():
            return self.factory.undefined(variant, "fewer_than_two_neighbours")
        usable = rows & (below > self.spec.length_tol)
        if not usable.any():
            return self.factory.undefined(variant, "zero_distance")
        total = float(weights[usable].sum())
        if total <= 0:
            return self.factory.undefined(variant, "too_few_samples")
        mean = float(weights[usable] @ (above[usable] / below[usable])) / total
        return self.factory.ok(variant, mean, {"coverage": total / float(weights.sum())})


class NeighbourCount(RobotMetric[specs.NeighbourCountSpec]):
    """Scores ``neighbour_count``: the mean number of neighbours over time."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        return [self.factory.ok("corrected", _neighbours(run, self.spec.neighbour_radius))]


class LocalDensity(RobotMetric[specs.LocalDensitySpec]):
    """Scores ``local_density``: the mean over time of neighbours per area of their circle."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        radius = self.spec.neighbour_radius
        return [self.factory.ok("corrected", _neighbours(run, radius) / (math.pi * radius**2))]


def _neighbours(run: Trajectories, radius: float) -> float:
    """Return the mean number over time of people whose centre is within a radius, m."""
    if (span := duration(run.t)) <= 0:
        raise UndefinedError("too_few_samples")
    count = (encounter(run, np.inf).distance <= radius + DISTANCE_TOLERANCE).sum(axis=1)
    return float(time_weights(run.t) @ count / span)
