"""Scoring of time to collision."""

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
from crowdbot.plugin.for_metrics import approach, as_disc
from crowdbot.plugins.metrics.risk import (
    EXPECTED_SEVERITY,
    INTEGRATED_TIME_TO_COLLISION,
    MIN_TIME_TO_COLLISION,
    RISK,
    TIME_EXPOSED,
    ExpectedSeveritySpec,
    IntegratedTimeToCollisionSpec,
    MinTimeToCollisionSpec,
    RiskSpec,
    TimeExposedSpec,
)

#: Times to contact closer than this are treated as equal, s.
TIE = 1e-9


@dataclass(frozen=True, slots=True)
class Risk:
    """Scores ``risk``. Needs no reference run."""

    spec: RiskSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score ``literal``, ``corrected``, ``exposed_time``, ``rate`` and ``disc``.

        The first three grow with the length of the run.
        """
        del refs
        factory = ScoreFactory(RISK)
        if run.robot is None:
            return factory.all_undefined("invalid_no_robot")
        run = truncate_at_arrival(run)
        tau = first_contact(run, self.spec)
        literal = factory.ok("literal", tau[np.isfinite(tau)].sum())
        if (span := duration(run.t)) <= 0:
            return [literal, *factory.all_undefined("too_few_samples", factory.variants[1:])]
        weights, horizon = time_weights(run.t), self.spec.risk_horizon
        of_disc = first_contact(as_disc(run), self.spec)
        imminence, round_one = (
            float(weights @ np.maximum(0.0, 1.0 - near / horizon)) for near in (tau, of_disc)
        )
        return [
            literal,
            factory.ok("corrected", imminence, {"mean": imminence / span}),
            factory.ok("exposed_time", weights @ (tau < horizon)),
            factory.ok("rate", min(1.0, imminence / span)),
            factory.ok("disc", min(1.0, round_one / span)),
        ]


@dataclass(frozen=True, slots=True)
class ExpectedSeverity:
    """Scores ``expected_severity``. Needs no reference run."""

    spec: ExpectedSeveritySpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score by the speed of the person touched first; of several, the fastest."""
        del refs
        factory = ScoreFactory(EXPECTED_SEVERITY)
        if run.robot is None:
            return factory.all_undefined("invalid_no_robot")
        run = truncate_at_arrival(run)
        tau, square = self._first_and_speed(run)
        ahead = np.isfinite(tau)
        literal = factory.ok("literal", square[ahead] @ tau[ahead])
        if (span := duration(run.t)) <= 0:
            return [literal, *factory.all_undefined("too_few_samples", factory.variants[1:])]
        imminence = np.maximum(0.0, 1.0 - tau / self.spec.risk_horizon)
        total = float(time_weights(run.t) @ (square * imminence))
        return [
            literal,
            factory.ok("corrected", total, {"mean": total / span}),
            factory.ok("rate", total / span),
        ]

    def _first_and_speed(self, run: Trajectories) -> tuple[Array, Array]:
        """Return the least time to contact (N,), s, and the squared relative speed there, m²/s²."""
        tau, speed = approach(
            run, self.spec.jump_speed, self.spec.contact_tol, self.spec.rel_speed_tol
        )
        first = tau.min(axis=1, initial=np.inf)
        is_first = np.isfinite(tau) & (tau <= first[:, None] + TIE) & np.isfinite(speed)
        return first, np.where(is_first, speed, 0.0).max(axis=1, initial=0.0) ** 2


@dataclass(frozen=True, slots=True)
class TimeExposed:
    """Scores ``time_exposed``, the variant ``exposed_time`` of ``risk``."""

    spec: TimeExposedSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the time, and its share, with a person nearer than the horizon."""
        del refs
        return _over_time(ScoreFactory(TIME_EXPOSED), run, self.spec, exposed=True)


@dataclass(frozen=True, slots=True)
class IntegratedTimeToCollision:
    """Scores ``integrated_time_to_collision``: ``risk`` times its horizon."""

    spec: IntegratedTimeToCollisionSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the integral and mean of horizon minus time to contact, where positive."""
        del refs
        return _over_time(ScoreFactory(INTEGRATED_TIME_TO_COLLISION), run, self.spec, exposed=False)


@dataclass(frozen=True, slots=True)
class MinTimeToCollision:
    """Scores ``min_time_to_collision``. Needs no reference run."""

    spec: MinTimeToCollisionSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the minimum: 0 after contact, undefined if no collision was ever predicted."""
        del refs
        factory = ScoreFactory(MIN_TIME_TO_COLLISION)
        if run.robot is None:
            return factory.all_undefined("invalid_no_robot")
        run = truncate_at_arrival(run)
        read = {"corrected": run, "disc": as_disc(run)}
        return [self._least(factory, variant, one) for variant, one in read.items()]

    def _least(self, factory: ScoreFactory, variant: str, run: Trajectories) -> Score:
        least = float(first_contact(run, self.spec).min())
        if not np.isfinite(least):
            return factory.undefined(variant, "no_neighbours")
        return factory.ok(variant, least)


_Spec = (
    RiskSpec
    | ExpectedSeveritySpec
    | TimeExposedSpec
    | IntegratedTimeToCollisionSpec
    | MinTimeToCollisionSpec
)


def first_contact(run: Trajectories, spec: _Spec) -> Array:
    """Return the least time to contact with any person (N,), s; inf without one."""
    tau, _ = approach(run, spec.jump_speed, spec.contact_tol, spec.rel_speed_tol)
    first: Array = tau.min(axis=1, initial=np.inf)
    return first


def _over_time(
    factory: ScoreFactory,
    run: Trajectories,
    spec: TimeExposedSpec | IntegratedTimeToCollisionSpec,
    *,
    exposed: bool,
) -> list[Score]:
    if run.robot is None:
        return factory.all_undefined("invalid_no_robot")
    run = truncate_at_arrival(run)
    if duration(run.t) <= 0:
        return factory.all_undefined("too_few_samples")
    tau = first_contact(run, spec)
    short = np.maximum(0.0, spec.risk_horizon - tau)
    values = (tau < spec.risk_horizon) if exposed else short
    total = float(time_weights(run.t) @ values)
    most = 1.0 if exposed else spec.risk_horizon
    return [
        factory.ok("corrected", total),
        factory.ok("rate", min(most, total / duration(run.t))),
    ]
