"""Scoring of the planner's computing time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from crowdbot.plugin import Array, References, Score, Trajectories
from crowdbot.plugins.metrics.declared_build import DeclaredMetric, UndefinedError
from crowdbot.plugins.metrics.planner_time import MaxPlannerTimeSpec, MeanPlannerTimeSpec


class MeanPlannerTime(DeclaredMetric[MeanPlannerTimeSpec]):
    """Scores ``mean_planner_time``: the mean over all steps of the record.

    Needs the times of the planner's steps.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        return [self.factory.ok("corrected", _steps(run).mean())]


class MaxPlannerTime(DeclaredMetric[MaxPlannerTimeSpec]):
    """Scores ``max_planner_time``: the maximum over all steps of the record.

    Needs the times of the planner's steps.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        return [self.factory.ok("corrected", _steps(run).max())]


def _steps(run: Trajectories) -> Array:
    """Return known durations of steps, s; raise `UndefinedError` if there are none."""
    if run.robot is None:
        raise UndefinedError("invalid_no_robot")
    steps = run.planner_step_time
    known = np.empty(0) if steps is None else steps[np.isfinite(steps)]
    if not len(known):
        raise UndefinedError("invalid_no_planner_time")
    return known
