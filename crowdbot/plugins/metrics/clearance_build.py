"""Scoring of the gaps between the surfaces of robot and people."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import crowdbot.plugins.metrics.clearance as specs
from crowdbot.plugin import (
    Array,
    References,
    Score,
    ScoreFactory,
    Trajectories,
    duration,
    time_weights,
)
from crowdbot.plugin.for_metrics import as_disc, encounter
from crowdbot.plugins.metrics.declared_build import RobotMetric, UndefinedError

#: Tolerance at the edges of zones, m: a person on an edge is outside, despite rounding.
EDGE = 1e-9


class MinClearance(RobotMetric[specs.MinClearanceSpec]):
    """Scores ``min_clearance``: the smallest gap, for the outline and for the disc around it.

    Negative where bodies overlap.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        gap, of_disc = nearest_gap(run), nearest_gap(as_disc(run))
        return [self.factory.ok("corrected", gap.min()), self.factory.ok("disc", of_disc.min())]


class AvgClearance(RobotMetric[specs.AvgClearanceSpec]):
    """Scores ``avg_clearance``: the mean gap over the time at which a person is present."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        gap = nearest_gap(run)
        t, some = run.t, np.isfinite(gap)
        weights = time_weights(t)[some]
        if weights.sum() <= 0:
            raise UndefinedError("too_few_samples")
        coverage = float(weights.sum()) / duration(t)
        mean = float(weights @ gap[some] / weights.sum())
        return [self.factory.ok("corrected", mean, {"coverage": coverage})]


class IntimateTimeFraction(RobotMetric[specs.IntimateTimeFractionSpec]):
    """Scores ``intimate_time_fraction``: the share of time inside the intimate zone."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        return time_within(self.factory, run, -np.inf, self.spec.intimate)


class PersonalTimeFraction(RobotMetric[specs.PersonalTimeFractionSpec]):
    """Scores ``personal_time_fraction``: the share of time in the personal zone."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        zone = self.spec.intimate, self.spec.personal
        return time_within(self.factory, run, *zone)


class SocialTimeFraction(RobotMetric[specs.SocialTimeFractionSpec]):
    """Scores ``social_time_fraction``: the share of time in the social zone."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        return time_within(self.factory, run, self.spec.personal, self.spec.social)


class SpaceCompliance(RobotMetric[specs.SpaceComplianceSpec]):
    """Scores ``space_compliance``: the share of time beyond the required gap.

    Time without people counts as compliant.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        # The comparison is strict, so the edge plus its tolerance is the smallest gap that
        # complies.
        return time_within(self.factory, run, self.spec.compliance + 2.0 * EDGE, None)


def nearest_gap(run: Trajectories) -> Array:
    """Return the gap to the nearest person (N,), m; inf while there is none.

    Raises:
        UndefinedError: there is none at any time.
    """
    gap = encounter(run, np.inf).gap
    nearest: Array = np.where(np.isfinite(gap), gap, np.inf).min(axis=1, initial=np.inf)
    if not np.isfinite(nearest).any():
        raise UndefinedError("no_agents")
    return nearest


def time_within(
    factory: ScoreFactory, run: Trajectories, low: float, high: float | None
) -> list[Score]:
    """Score the share of time with the nearest gap in [low, high), m; None: no upper limit."""
    gap = nearest_gap(run)
    t = run.t
    if duration(t) <= 0:
        raise UndefinedError("too_few_samples")
    inside = gap >= low - EDGE
    if high is not None:
        inside &= gap < high - EDGE
    return [factory.ok("corrected", time_weights(t) @ inside / duration(t))]
