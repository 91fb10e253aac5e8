"""Scoring of how far the robot moves, or is pushed, away from its goal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crowdbot.plugin import References, Score, ScoreFactory, Trajectories
from crowdbot.plugins.metrics.common_reference_build import goal_distance
from crowdbot.plugins.metrics.progress import REGRESS, RegressSpec

#: Tolerance of the rule for a receding goal, m/s, so that rounding does not decide.
TOLERANCE = 1e-9


@dataclass(frozen=True, slots=True)
class Regress:
    """Scores ``regress``. Needs a goal point or zone."""

    spec: RegressSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the sum of all increases of the goal distance.

        And the share of time with a marked one.
        """
        del refs
        factory = ScoreFactory(REGRESS)
        found = goal_distance(factory, run)
        if isinstance(found, list):
            return found
        t, distance = found
        if len(t) < 2:
            return factory.all_undefined("too_few_samples")
        steps, dt = np.diff(distance), np.diff(t)
        away = steps / dt > self.spec.away_speed + TOLERANCE
        return [
            factory.ok("corrected", np.maximum(steps, 0.0).sum()),
            factory.ok("time_share", min(1.0, float(dt[away].sum() / dt.sum()))),
        ]
