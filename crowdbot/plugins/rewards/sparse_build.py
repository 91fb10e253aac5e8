"""Sparse reward."""

from __future__ import annotations

import numpy as np

from crowdbot.plugin import Array
from crowdbot.plugin.for_learning import LearningContext, StepChange
from crowdbot.plugins.rewards.sparse import SparseSpec


class Sparse:
    """Reward of arrival, else of contact, else of little space."""

    def __init__(self, spec: SparseSpec) -> None:
        self._spec = spec

    def of(self, change: StepChange) -> Array:
        """Return the rewards (W,) of one step in W worlds."""
        spec, gap = self._spec, np.maximum(change.gap, 0.0)
        cost = np.where(gap < spec.near, spec.nearness + spec.slope * np.minimum(gap, spec.near), 0)
        cost = np.where(change.contact > 0.0, spec.contact, cost)
        return np.asarray(np.where(change.arrived, spec.arrival, -cost))


def build(spec: SparseSpec, context: LearningContext) -> Sparse:
    """Return the reward."""
    del context
    return Sparse(spec)
