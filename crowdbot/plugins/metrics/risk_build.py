"""Scoring of time to collision."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import crowdbot.plugins.metrics.risk as specs
from crowdbot.plugin import (
    Array,
    References,
    Score,
    ScoreFactory,
    Trajectories,
    duration,
    time_weights,
)
from crowdbot.plugin.for_metrics import approach, as_disc
from crowdbot.plugins.metrics.declared_build import RobotMetric, UndefinedError

#: Times to contact closer than this are treated as equal, s.
TIE = 1e-9


class Risk(RobotMetric[specs.RiskSpec]):
    """Scores ``risk``: the imminence of collisions, integrated over time.

    ``literal``, ``corrected`` and ``exposed_time`` grow with the length of the run; ``rate`` and
    ``disc`` do not.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        tau = first_contact(run, self.spec)
        literal = self.factory.ok("literal", tau[np.isfinite(tau)].sum())
        if (span := duration(run.t)) <= 0:
            return [
                literal,
                *self.factory.all_undefined("too_few_samples", self.factory.variants[1:]),
            ]
        weights, horizon = time_weights(run.t), self.spec.risk_horizon
        of_disc = first_contact(as_disc(run), self.spec)
        imminence, round_one = (
            float(weights @ np.maximum(0.0, 1.0 - near / horizon)) for near in (tau, of_disc)
        )
        return [
            literal,
            self.factory.ok("corrected", imminence, {"mean": imminence / span}),
            self.factory.ok("exposed_time", weights @ (tau < horizon)),
            self.factory.ok("rate", min(1.0, imminence / span)),
            self.factory.ok("disc", min(1.0, round_one / span)),
        ]


class ExpectedSeverity(RobotMetric[specs.ExpectedSeveritySpec]):
    """Scores ``expected_severity`` by the speed of the person touched first, or the fastest."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        tau, square = self._first_and_speed(run)
        ahead = np.isfinite(tau)
        literal = self.factory.ok("literal", square[ahead] @ tau[ahead])
        if (span := duration(run.t)) <= 0:
            return [
                literal,
                *self.factory.all_undefined("too_few_samples", self.factory.variants[1:]),
            ]
        imminence = np.maximum(0.0, 1.0 - tau / self.spec.risk_horizon)
        total = float(time_weights(run.t) @ (square * imminence))
        return [
            literal,
            self.factory.ok("corrected", total, {"mean": total / span}),
            self.factory.ok("rate", total / span),
        ]

    def _first_and_speed(self, run: Trajectories) -> tuple[Array, Array]:
        """Return the least time to contact (N,), s, and the squared relative speed there, m²/s²."""
        tau, speed = approach(
            run, self.spec.jump_speed, self.spec.contact_tol, self.spec.rel_speed_tol
        )
        first = tau.min(axis=1, initial=np.inf)
        is_first = np.isfinite(tau) & (tau <= first[:, None] + TIE) & np.isfinite(speed)
        return first, np.where(is_first, speed, 0.0).max(axis=1, initial=0.0) ** 2


class TimeExposed(RobotMetric[specs.TimeExposedSpec]):
    """Scores ``time_exposed``: the time, and its share, with a collision within the horizon.

    The same as the variant ``exposed_time`` of ``risk``.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        return _over_time(self.factory, run, self.spec, exposed=True)


class IntegratedTimeToCollision(RobotMetric[specs.IntegratedTimeToCollisionSpec]):
    """Scores ``integrated_time_to_collision``: horizon minus time to contact, where positive.

    Its integral, which is ``risk`` times the horizon, and its mean.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        return _over_time(self.factory, run, self.spec, exposed=False)


class MinTimeToCollision(RobotMetric[specs.MinTimeToCollisionSpec]):
    """Scores ``min_time_to_collision``: 0 after contact, undefined if none was predicted."""

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        read = {"corrected": run, "disc": as_disc(run)}
        return [self._least(variant, one) for variant, one in read.items()]

    def _least(self, variant: str, run: Trajectories) -> Score:
        least = float(first_contact(run, self.spec).min())
        if not np.isfinite(least):
            return self.factory.undefined(variant, "no_neighbours")
        return self.factory.ok(variant, least)


_Spec = (
    specs.RiskSpec
    | specs.ExpectedSeveritySpec
    | specs.TimeExposedSpec
    | specs.IntegratedTimeToCollisionSpec
    | specs.MinTimeToCollisionSpec
)


def first_contact(run: Trajectories, spec: _Spec) -> Array:
    """Return the least time to contact with any person (N,), s; inf without one."""
    tau, _ = approach(run, spec.jump_speed, spec.contact_tol, spec.rel_speed_tol)
    first: Array = tau.min(axis=1, initial=np.inf)
    return first


def _over_time(
    factory: ScoreFactory,
    run: Trajectories,
    spec: specs.TimeExposedSpec | specs.IntegratedTimeToCollisionSpec,
    *,
    exposed: bool,
) -> list[Score]:
    if duration(run.t) <= 0:
        raise UndefinedError("too_few_samples")
    tau = first_contact(run, spec)
    short = np.maximum(0.0, spec.risk_horizon - tau)
    values = (tau < spec.risk_horizon) if exposed else short
    total = float(time_weights(run.t) @ values)
    most = 1.0 if exposed else spec.risk_horizon
    return [
        factory.ok("corrected", total),
        factory.ok("rate", min(most, total / duration(run.t))),
    ]
