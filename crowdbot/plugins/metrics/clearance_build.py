"""Scoring of the gaps between the surfaces of robot and people."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

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
from crowdbot.plugin.for_metrics import as_disc, encounter
from crowdbot.plugins.metrics.clearance import (
    AVG_CLEARANCE,
    INTIMATE_TIME_FRACTION,
    MIN_CLEARANCE,
    PERSONAL_TIME_FRACTION,
    SOCIAL_TIME_FRACTION,
    SPACE_COMPLIANCE,
    AvgClearanceSpec,
    IntimateTimeFractionSpec,
    MinClearanceSpec,
    PersonalTimeFractionSpec,
    SocialTimeFractionSpec,
    SpaceComplianceSpec,
)

#: Tolerance at the edges of zones, m: a person on an edge is outside, despite rounding.
EDGE = 1e-9


@dataclass(frozen=True, slots=True)
class MinClearance:
    """Scores ``min_clearance``. Needs no reference run; negative where bodies overlap."""

    spec: MinClearanceSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the smallest gap over all samples, for the outline and for the disc around it."""
        del refs
        factory = ScoreFactory(MIN_CLEARANCE)
        gap, of_disc = nearest_gap(factory, run), nearest_gap(factory, as_disc(run))
        if isinstance(gap, list):
            return gap
        assert not isinstance(of_disc, list), "the same people, the same time"
        return [factory.ok("corrected", gap.min()), factory.ok("disc", of_disc.min())]


@dataclass(frozen=True, slots=True)
class AvgClearance:
    """Scores ``avg_clearance``. Needs no reference run."""

    spec: AvgClearanceSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the mean gap over the time at which a person is present."""
        del refs
        factory = ScoreFactory(AVG_CLEARANCE)
        gap = nearest_gap(factory, run)
        if isinstance(gap, list):
            return gap
        t, some = truncate_at_arrival(run).t, np.isfinite(gap)
        weights = time_weights(t)[some]
        if weights.sum() <= 0:
            return factory.all_undefined("too_few_samples")
        coverage = float(weights.sum()) / duration(t)
        mean = float(weights @ gap[some] / weights.sum())
        return [factory.ok("corrected", mean, {"coverage": coverage})]


@dataclass(frozen=True, slots=True)
class IntimateTimeFraction:
    """Scores ``intimate_time_fraction``. Needs no reference run."""

    spec: IntimateTimeFractionSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the share of time inside the intimate zone."""
        del refs
        return time_within(ScoreFactory(INTIMATE_TIME_FRACTION), run, -np.inf, self.spec.intimate)


@dataclass(frozen=True, slots=True)
class PersonalTimeFraction:
    """Scores ``personal_time_fraction``. Needs no reference run."""

    spec: PersonalTimeFractionSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the share of time between the edges of the intimate and the personal zone."""
        del refs
        zone = self.spec.intimate, self.spec.personal
        return time_within(ScoreFactory(PERSONAL_TIME_FRACTION), run, *zone)


@dataclass(frozen=True, slots=True)
class SocialTimeFraction:
    """Scores ``social_time_fraction``. Needs no reference run."""

    spec: SocialTimeFractionSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the share of time between the edges of the personal and the social zone."""
        del refs
        return time_within(
            ScoreFactory(SOCIAL_TIME_FRACTION), run, self.spec.personal, self.spec.social
        )


@dataclass(frozen=True, slots=True)
class SpaceCompliance:
    """Scores ``space_compliance``. Needs no reference run."""

    spec: SpaceComplianceSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the share of time beyond the required gap.

        Time without people counts as compliant.
        """
        del refs
        # The comparison is strict, so the edge plus its tolerance is the smallest gap that
        # complies.
        return time_within(
            ScoreFactory(SPACE_COMPLIANCE), run, self.spec.compliance + 2.0 * EDGE, None
        )


def nearest_gap(factory: ScoreFactory, run: Trajectories) -> Array | list[Score]:
    """Return the gap to the nearest person (N,), m; or scores that say why not.

    Inf without people.
    """
    if run.robot is None:
        return factory.all_undefined("invalid_no_robot")
    gap = encounter(truncate_at_arrival(run), np.inf).gap
    nearest: Array = np.where(np.isfinite(gap), gap, np.inf).min(axis=1, initial=np.inf)
    return nearest if np.isfinite(nearest).any() else factory.all_undefined("no_agents")


def time_within(
    factory: ScoreFactory, run: Trajectories, low: float, high: float | None
) -> list[Score]:
    """Score the share of time with the nearest gap in [low, high), m.

    Without ``high``: no limit.
    """
    gap = nearest_gap(factory, run)
    if isinstance(gap, list):
        return gap
    t = truncate_at_arrival(run).t
    if duration(t) <= 0:
        return factory.all_undefined("too_few_samples")
    inside = gap >= low - EDGE
    if high is not None:
        inside &= gap < high - EDGE
    return [factory.ok("corrected", time_weights(t) @ inside / duration(t))]
