"""Velocity-space policy: choose a velocity by sampling, approach it within the relaxation time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from crowdbot.core.crowd.cost import Array, CompiledCost
from crowdbot.core.crowd.policy import Agents, CrowdView
from crowdbot.core.crowd.sampling import Sampler, fan
from crowdbot.plugins.crowd.velocity_space import VelocitySpaceSpec


class VelocitySpace:
    """A mix of cost functions, minimised over regular samples."""

    def __init__(
        self, spec: VelocitySpaceSpec, costs: Sequence[CompiledCost], agents: Agents
    ) -> None:
        self._sampler = Sampler(fan(spec.speeds, spec.angles, spec.angle), costs, agents)
        self._relaxation = spec.relaxation_time
        self.contact_stiffness = spec.contact_stiffness

    def accelerations(self, view: CrowdView) -> Array:
        """Towards the chosen velocity, limited by each agent's largest acceleration."""
        difference = self._sampler.choose(view) - view.velocity
        towards_goal = view.goal - view.position
        arrived = np.hypot(towards_goal[:, 0], towards_goal[:, 1]) <= view.agents.radius
        time = np.where(arrived, view.dt, max(self._relaxation, view.dt))
        acceleration = difference / time[:, np.newaxis]
        norm = np.hypot(acceleration[:, 0], acceleration[:, 1])
        limit = view.agents.max_acceleration
        scale = np.where(norm > limit, limit / np.maximum(norm, 1e-12), 1.0)
        return acceleration * scale[:, np.newaxis]


def build(spec: VelocitySpaceSpec, costs: Sequence[CompiledCost], agents: Agents) -> VelocitySpace:
    """The policy for one set of agents."""
    return VelocitySpace(spec, costs, agents)
