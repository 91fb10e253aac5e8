"""Scoring of the planner's computing time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crowdbot.plugin import Array, References, Score, ScoreFactory, Trajectories
from crowdbot.plugins.metrics.planner_time import (
    MAX_PLANNER_TIME,
    MEAN_PLANNER_TIME,
    MaxPlannerTimeSpec,
    MeanPlannerTimeSpec,
)


@dataclass(frozen=True, slots=True)
class MeanPlannerTime:
    """Scores ``mean_planner_time``. Needs the times of the planner's steps."""

    spec: MeanPlannerTimeSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the mean over all steps of the record."""
        del refs
        factory = ScoreFactory(MEAN_PLANNER_TIME)
        steps = _steps(factory, run)
        return steps if isinstance(steps, list) else [factory.ok("corrected", steps.mean())]


@dataclass(frozen=True, slots=True)
class MaxPlannerTime:
    """Scores ``max_planner_time``. Needs the times of the planner's steps."""

    spec: MaxPlannerTimeSpec

    def score(self, run: Trajectories, refs: References) -> Sequence[Score]:
        """Score the maximum over all steps of the record."""
        del refs
        factory = ScoreFactory(MAX_PLANNER_TIME)
        steps = _steps(factory, run)
        return steps if isinstance(steps, list) else [factory.ok("corrected", steps.max())]


def _steps(factory: ScoreFactory, run: Trajectories) -> Array | list[Score]:
    """Return known step durations, s; or scores that say why there are none."""
    if run.robot is None:
        return factory.all_undefined("invalid_no_robot")
    steps = run.planner_step_time
    known = np.empty(0) if steps is None else steps[np.isfinite(steps)]
    return known if len(known) else factory.all_undefined("invalid_no_planner_time")
