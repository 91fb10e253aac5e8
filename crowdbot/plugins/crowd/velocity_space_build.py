"""Velocity-space policy: choose a velocity by sampling, approach it within the relaxation time."""

from __future__ import annotations

import math
from collections.abc import Sequence

from numba import njit

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
        acceleration = self._sampler.choose(view)
        _accelerate(
            acceleration, view.position, view.velocity, view.goal, view.agents.radius,
            view.agents.max_acceleration, max(self._relaxation, view.dt), view.dt,
        )  # fmt: skip
        return acceleration


@njit(cache=True, error_model="numpy")
def _accelerate(
    chosen: Array,
    position: Array,
    velocity: Array,
    goal: Array,
    radius: Array,
    limit: Array,
    relaxation: float,
    dt: float,
) -> None:
    """Turn chosen velocities into accelerations, in place; who has arrived stops at once."""
    for i in range(chosen.shape[0]):
        to_goal = math.hypot(goal[i, 0] - position[i, 0], goal[i, 1] - position[i, 1])
        time = dt if to_goal <= radius[i] else relaxation
        ax = (chosen[i, 0] - velocity[i, 0]) / time
        ay = (chosen[i, 1] - velocity[i, 1]) / time
        norm = math.hypot(ax, ay)
        scale = limit[i] / norm if norm > limit[i] else 1.0
        chosen[i, 0], chosen[i, 1] = ax * scale, ay * scale


def build(spec: VelocitySpaceSpec, costs: Sequence[CompiledCost], agents: Agents) -> VelocitySpace:
    """The policy for one set of agents."""
    return VelocitySpace(spec, costs, agents)
