"""Risk, computed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from crowdbot.core.encounter import (
    disc_problem,
    encounter,
    people,
    relative_velocity,
    time_to_contact,
)
from crowdbot.core.interfaces import References
from crowdbot.core.preprocess import cropped, duration, time_weights
from crowdbot.core.score import Score
from crowdbot.core.score_label import ScoreLabel
from crowdbot.core.trajectory import Array, Trajectories
from crowdbot.plugins.metrics.risk import RiskSpec

LABEL = ScoreLabel(metric="risk", symbol="R", category="collision", unit="s", better="lower")
#: Not monotone: an imminent crash adds less than a remote one.
LITERAL = replace(LABEL, better="none")


@dataclass(frozen=True, slots=True)
class Risk:
    """Needs no reference run."""

    spec: RiskSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """``literal``, ``corrected`` (with its ``mean`` over time) and ``exposed_time``."""
        del refs
        if problem := disc_problem(run):
            return [
                LITERAL.undefined("literal", problem),
                LABEL.undefined("corrected", problem),
                LABEL.undefined("exposed_time", problem),
            ]
        run = cropped(run)
        tau = self._time_to_first_contact(run)
        literal = LITERAL.ok("literal", tau[np.isfinite(tau)].sum())
        return [literal, *self._over_time(run.t, tau)]

    def _over_time(self, t: Array, tau: Array) -> list[Score]:
        span = duration(t)
        if span <= 0:
            return [LABEL.undefined(v, "too_few_samples") for v in ("corrected", "exposed_time")]
        weights, horizon = time_weights(t), self.spec.risk_horizon
        imminence = float(weights @ np.maximum(0.0, 1.0 - tau / horizon))
        exposed = float(weights @ (tau < horizon))
        return [
            LABEL.ok("corrected", imminence, {"mean": imminence / span}),
            LABEL.ok("exposed_time", exposed),
        ]

    def _time_to_first_contact(self, run: Trajectories) -> Array:
        """Least time to contact with anybody (N,), s; inf where there is none to come."""
        assert run.robot is not None
        bodies = run.t, run.robot, people(run), self.spec.jump_speed
        tau = time_to_contact(
            encounter(*bodies),
            relative_velocity(*bodies),
            contact_tol=self.spec.contact_tol,
            rel_speed_tol=self.spec.rel_speed_tol,
        )
        first: Array = tau.min(axis=1, initial=np.inf)
        return first


def build(spec: RiskSpec) -> Risk:
    """The metric of a spec."""
    return Risk(spec)
