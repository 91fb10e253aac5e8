"""CrowdModel: policy and bodies of a crowd, independent of a place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.build import build_cost, build_policy
from crowdbot.core.crowd.engine import PolicyFactory
from crowdbot.core.crowd.policy import CrowdPolicy, CrowdView
from crowdbot.core.crowd.steering.parameters import Steering
from crowdbot.core.registry.registry import Registry
from crowdbot.core.types.arrays import Array
from crowdbot.dsl.scenario.crowd import Crowd
from crowdbot.dsl.scenario.steering import SteeringSpec

#: Default preferred speeds, m/s: those of the recorded people.
SPEED, SPEED_DEVIATION = 1.5, 0.2
#: Default radius, m: from the gaps between the recorded people.
RADIUS = 0.2


@dataclass(frozen=True, slots=True, kw_only=True)
class CrowdModel:
    """Policy and bodies of a crowd, independent of the place; SI units.

    Attributes:
        policy: function that builds the policy.
        speed, speed_deviation: mean and deviation of the normal distribution of preferred speeds,
            m/s.
        radius, avoided_radius: radius for contact and radius kept clear, m.
        decision_rate: Hz.
    """

    policy: PolicyFactory | CrowdPolicy
    steering: Steering = field(default_factory=Steering)
    speed: float = SPEED
    speed_deviation: float = SPEED_DEVIATION
    radius: float = RADIUS
    avoided_radius: float = RADIUS
    max_speed: float = 3.0
    max_acceleration: float = 5.0
    decision_rate: float = 16.0


def model_of(
    crowd: Crowd, registry: Registry, *, named: Sequence[str] = (), rate: float = 16.0
) -> CrowdModel:
    """Return the model of a scenario's crowd: its policy, steering, speeds and bodies.

    Args:
        crowd: the validated crowd; its people's paths are ignored.
        named: fields of ``body`` that the crowd sets; `RADIUS` replaces a radius that is not set.
            Default: those that the document sets.
        rate: decisions, Hz.
    """
    costs = [build_cost(registry, cost) for cost in crowd.costs.values()]
    body = crowd.body
    stated = set(named) | (body.model_fields_set if "body" in crowd.model_fields_set else set())
    radius = body.radius if "radius" in stated else RADIUS
    speed, deviation = SPEED, SPEED_DEVIATION
    if crowd.speed is not None:
        speed, deviation = crowd.speed.mean, crowd.speed.std
    avoided = body.avoided_radius if body.avoided_radius is not None else radius
    return CrowdModel(
        policy=lambda agents: build_policy(registry, crowd.policy, costs, agents),
        steering=Steering(crowd.steering or SteeringSpec()),
        speed=speed,
        speed_deviation=deviation,
        radius=radius,
        avoided_radius=avoided,
        max_speed=body.max_speed,
        max_acceleration=body.max_acceleration,
        decision_rate=rate,
    )


class AvoidNobody:
    """People who walk to their goals without avoidance; they still push each other."""

    relaxation_time = 0.5

    def accelerations(self, view: CrowdView) -> Array:
        """Return accelerations towards the preferred velocity, m/s^2."""
        way = view.goal - view.position
        away = np.hypot(way[:, :1], way[:, 1:])
        desired = view.agents.preferred_speed[:, np.newaxis] * way / (away + 1e-9)
        return np.asarray((desired - view.velocity) / self.relaxation_time)


class Ghosts(AvoidNobody):
    """People without avoidance or pushes: straight lines through each other."""

    contact_stiffness = 0.0
    walks_through_walls = True


def avoid_nobody(agents: Agents) -> CrowdPolicy:
    """Build the policy `AvoidNobody` for some agents."""
    del agents
    return AvoidNobody()


def ghosts(agents: Agents) -> CrowdPolicy:
    """Build the policy `Ghosts` for some agents."""
    del agents
    return Ghosts()
