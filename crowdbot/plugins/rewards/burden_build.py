"""Reward of burden."""

from __future__ import annotations

from crowdbot.plugin import Array
from crowdbot.plugin.for_learning import LearningContext, StepChange
from crowdbot.plugins.rewards.burden import BurdenSpec
from crowdbot.plugins.rewards.progress_build import ProgressReward


class Burden:
    """Progress, less the work demanded of people."""

    def __init__(self, spec: BurdenSpec, context: LearningContext) -> None:
        self._work, self._progress = spec.work, ProgressReward(spec, context)

    def of(self, change: StepChange) -> Array:
        """Return the rewards (W,) of one step in W worlds."""
        return self._progress.of(change) - self._work * change.work


build = Burden
