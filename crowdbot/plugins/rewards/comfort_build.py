"""Reward of comfort."""

from __future__ import annotations

from crowdbot.plugin import Array
from crowdbot.plugin.for_learning import LearningContext, StepChange
from crowdbot.plugins.rewards.comfort import ComfortSpec
from crowdbot.plugins.rewards.progress_build import ProgressReward


class Comfort:
    """Progress, less the distance driven towards people with little space."""

    def __init__(self, spec: ComfortSpec, context: LearningContext) -> None:
        self._advance, self._progress = spec.advance, ProgressReward(spec, context)

    def of(self, change: StepChange) -> Array:
        """Return the rewards (W,) of one step in W worlds."""
        return self._progress.of(change) - self._advance * change.advance


build = Comfort
