"""Velocity-space policy: minimise weighted costs with the method that its spec names."""

from __future__ import annotations

from collections.abc import Sequence

from crowdbot.plugin import Agents, Array, CompiledCost, CrowdView, NumpyCost
from crowdbot.plugin.for_crowds import (
    ALONG_PREFERRED,
    PREFERRED_SPEED,
    ZERO,
    Descent,
    Optimum,
    Sampler,
    Sampling,
    VelocityCandidates,
    WeightedCosts,
    approach,
)
from crowdbot.plugins.crowd.policies.velocity_space import VelocitySpaceSpec

_BASES = ("zero", "current_velocity")
_DIRECTIONS = ("unit", "current_velocity", "preferred_velocity")
_RADII = ("preferred_speed", "maximum_speed", "maximum_acceleration")


def sampling_of(spec: VelocitySpaceSpec) -> Sampling:
    """Return the candidate velocities of a spec."""
    return Sampling(
        speeds=spec.speeds,
        angles=spec.angles,
        opening=spec.angle,
        include_base=spec.include_base,
        base=_BASES.index(spec.base),
        direction=_DIRECTIONS.index(spec.direction),
        radius=_RADII.index(spec.radius),
        random=spec.random_samples if spec.samples == "random" else 0,
    )


def candidates_of(spec: VelocitySpaceSpec) -> VelocityCandidates | None:
    """Return candidates relative to the goal direction, if they never change; else None."""
    s = sampling_of(spec)
    fixed = spec.method == "sampling" and not s.random and spec.relaxation_time > 0.0
    if not fixed or (s.base, s.direction, s.radius) != (ZERO, ALONG_PREFERRED, PREFERRED_SPEED):
        return None
    return VelocityCandidates(s.fan(), spec.relaxation_time)


class VelocitySpace:
    """Weighted cost functions for a set of agents.

    Args:
        parity, weight: see `crowdbot.core.crowd.velocity_search.weighted_costs.WeightedCosts`.
    """

    def __init__(
        self,
        spec: VelocitySpaceSpec,
        costs: Sequence[CompiledCost | NumpyCost],
        agents: Agents,
        *,
        parity: bool = False,
        weight: Array | None = None,
    ) -> None:
        self.contact_stiffness = spec.contact_stiffness
        self.relaxation_time = spec.relaxation_time
        self.velocity_candidates = None if parity else candidates_of(spec)
        self.costs = WeightedCosts(
            costs, agents, relaxation_time=spec.relaxation_time, parity=parity, weight=weight
        )
        self.minimiser: Sampler | Optimum | Descent
        if spec.method == "gradient":
            self.minimiser = Descent(self.costs)
        elif spec.method == "global":
            self.minimiser = Optimum(self.costs)
        else:
            self.minimiser = Sampler(sampling_of(spec), self.costs)
        found = self.minimiser
        self.compiled_search = found if isinstance(found, Sampler) else None

    def accelerations(self, view: CrowdView) -> Array:
        """Return accelerations to the chosen velocity or down the gradient, limited, m/s^2."""
        if isinstance(self.minimiser, Descent):
            return self._limited(self.minimiser.accelerations(view), view, descend=True)
        return self._limited(self.minimiser.choose(view), view, descend=False)

    def towards(self, velocities: Array, view: CrowdView) -> Array:
        """Return accelerations (N, 2) towards given velocities, m/s^2."""
        return self._limited(velocities.copy(), view, descend=False)

    def _limited(self, found: Array, view: CrowdView, *, descend: bool) -> Array:
        agents = view.agents
        approach(
            found, descend, view.position, view.velocity, view.goal, agents.radius,
            agents.preferred_speed, agents.max_acceleration,
            max(self.costs.relaxation_time, view.dt), view.dt,
        )  # fmt: skip
        return found


build = VelocitySpace
