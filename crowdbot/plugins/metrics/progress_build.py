"""How far the robot is driven back, or drives away, from its goal, computed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crowdbot.plugin import References, Score, ScoreFactory, Trajectories
from crowdbot.plugins.metrics.common_reference_build import goal_distance
from crowdbot.plugins.metrics.progress import REGRESS, RegressSpec

#: Slack of the rule when the goal recedes, m/s: rounding decides nothing.
TOLERANCE = 1e-9


@dataclass(frozen=True, slots=True)
class Regress:
    """Needs a goal point or zone."""

    spec: RegressSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Sum of all increases of the distance, and the share of time with a marked one."""
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
