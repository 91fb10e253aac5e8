from __future__ import annotations

import numpy as np

from crowdbot.plugin import AgentView, Array, Neighbours, NumpyCost
from my_costs import ElbowRoomSpec

AHEAD = 0.5  # s


def evaluate(candidates: Array, agent: AgentView, neighbours: Neighbours) -> Array:
    aside = candidates - agent.preferred_velocity
    cost = np.hypot(aside[:, 0], aside[:, 1])
    motion = neighbours.velocity[np.newaxis] - candidates[:, np.newaxis]
    then = neighbours.offset + AHEAD * motion
    gap = np.hypot(then[..., 0], then[..., 1]) - neighbours.radius - agent.radius
    return np.asarray(cost + np.exp(-np.maximum(gap, 0.0)).sum(axis=1))


def build(spec: ElbowRoomSpec) -> NumpyCost:
    return NumpyCost(evaluate=evaluate, range=spec.range, weight=spec.weight)
