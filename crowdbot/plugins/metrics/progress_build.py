"""Scoring of how far the robot moves, or is pushed, away from its goal."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from crowdbot.plugin import References, Score, Trajectories
from crowdbot.plugins.metrics.common_reference_build import goal_distance
from crowdbot.plugins.metrics.declared_build import DeclaredMetric, UndefinedError
from crowdbot.plugins.metrics.progress import RegressSpec

#: Tolerance of the rule for a receding goal, m/s, so that rounding does not decide.
TOLERANCE = 1e-9


class Regress(DeclaredMetric[RegressSpec]):
    """Scores ``regress``: the sum of all increases of the goal distance.

    ``time_share`` is the share of time with a marked increase. Needs a goal point or zone.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        t, distance = goal_distance(run)
        if len(t) < 2:
            raise UndefinedError("too_few_samples")
        steps, dt = np.diff(distance), np.diff(t)
        away = steps / dt > self.spec.away_speed + TOLERANCE
        return [
            self.factory.ok("corrected", np.maximum(steps, 0.0).sum()),
            self.factory.ok("time_share", min(1.0, float(dt[away].sum() / dt.sum()))),
        ]
