"""Dense reward."""

from __future__ import annotations

import numpy as np

from crowdbot.plugin import Array
from crowdbot.plugin.for_learning import LearningContext, StepChange
from crowdbot.plugins.rewards.progress import ProgressSpec


class ProgressReward:
    """Weighted sum of progress and costs."""

    def __init__(self, spec: ProgressSpec, context: LearningContext) -> None:
        self._spec, self._step, limits = spec, context.step, context.limits
        range_of = [limits.v_max - limits.v_min, 2.0 * limits.w_max, 2.0 * limits.vy_max]
        self._range = np.array([r if r > 0.0 else np.inf for r in range_of])

    def of(self, change: StepChange) -> Array:
        """Return the rewards (W,) of one step in W worlds."""
        spec, step = self._spec, self._step
        changed = np.abs(change.command - change.before) / self._range
        cost = spec.time + spec.contact * change.contact + spec.wall * change.wall
        found = spec.progress * change.progress - step * cost - spec.change * changed.sum(axis=1)
        found -= spec.touch * (change.contact > 0.0) + spec.forced * change.forced
        found -= spec.aside * change.aside
        return np.asarray(found + spec.arrival * change.arrived)


build = ProgressReward
