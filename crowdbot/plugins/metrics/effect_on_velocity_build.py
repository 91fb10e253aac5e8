"""Effect on velocity, computed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crowdbot.core.encounter import people
from crowdbot.core.interfaces import References
from crowdbot.core.preprocess import (
    agent_velocities,
    common_window,
    cropped,
    duration,
    time_weights,
)
from crowdbot.core.score import Score
from crowdbot.core.score_label import ScoreLabel
from crowdbot.core.trajectory import Array, Trajectories
from crowdbot.plugins.metrics.effect_on_velocity import EffectOnVelocitySpec

LABEL = ScoreLabel(
    metric="effect_on_velocity",
    symbol="E_v",
    category="effect on crowd",
    unit="1",
    better="lower",
)


@dataclass(frozen=True, slots=True)
class EffectOnVelocity:
    """Needs ``crowd_alone``."""

    spec: EffectOnVelocitySpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """``literal``: every sample of either record; ``corrected``: time, in the common window."""
        if refs.crowd_alone is None:
            return [LABEL.undefined(v, "no_reference") for v in ("literal", "corrected")]
        run, alone = cropped(run), refs.crowd_alone
        literal = self._ratio("literal", alone, run, np.ones(len(alone.t)), np.ones(len(run.t)))
        alone, run = common_window(alone, run)
        if min(duration(alone.t), duration(run.t)) <= 0:
            return [literal, LABEL.undefined("corrected", "too_few_samples")]
        weights = time_weights(alone.t), time_weights(run.t)
        return [literal, self._ratio("corrected", alone, run, *weights)]

    def _ratio(
        self, variant: str, alone: Trajectories, run: Trajectories, w_alone: Array, w_run: Array
    ) -> Score:
        v_alone, v_run = self._mean_speed(alone, w_alone), self._mean_speed(run, w_run)
        if v_alone is None or v_run is None:
            return LABEL.undefined(variant, "no_agents")
        both = {"alone": v_alone, "crowded": v_run}
        return LABEL.ratio(variant, v_alone, v_run, self.spec.zero_tol, both)

    def _mean_speed(self, run: Trajectories, weights: Array) -> float | None:
        """Mean over all (sample, person) pairs, m/s; None if no speed is known."""
        speed = np.hypot(*agent_velocities(run.t, people(run), self.spec.jump_speed))
        known = np.isfinite(speed)
        total = float(weights @ known.sum(axis=1))
        return float(weights @ np.where(known, speed, 0.0).sum(axis=1)) / total if total else None


def build(spec: EffectOnVelocitySpec) -> EffectOnVelocity:
    """The metric of a spec."""
    return EffectOnVelocity(spec)
