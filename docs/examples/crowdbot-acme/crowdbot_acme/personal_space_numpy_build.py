"""Personal space as one function over all candidates."""

from __future__ import annotations

import numpy as np
from crowdbot.plugin import AgentView, Neighbours, NumpyCost
from numpy.typing import NDArray

from crowdbot_acme.personal_space import PersonalSpaceNumpySpec

Array = NDArray[np.float64]


def build(spec: PersonalSpaceNumpySpec) -> NumpyCost:
    """The function with this spec's parameters."""

    def evaluate(candidates: Array, agent: AgentView, neighbours: Neighbours) -> Array:
        """Costs (S,) of velocities (S, 2), m/s."""
        off = candidates - agent.preferred_velocity
        moved = (neighbours.velocity[None] - candidates[:, None]) * spec.ahead
        there = neighbours.offset[None] + moved
        gap = np.hypot(there[..., 0], there[..., 1]) - neighbours.radius - agent.radius
        return np.asarray(np.hypot(off[:, 0], off[:, 1]) + np.exp(-gap / spec.fade).sum(axis=1))

    return NumpyCost(
        evaluate=evaluate,
        range=spec.range.value,
        from_surface=spec.range.measure == "surface",
        weight=spec.weight,
    )
