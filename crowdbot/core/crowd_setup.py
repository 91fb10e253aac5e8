"""From a scenario's words to a crowd engine."""

from __future__ import annotations

import numpy as np

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdWorld
from crowdbot.core.crowd.draws import chosen
from crowdbot.core.interfaces import EnvironmentParts
from crowdbot.core.realisation import Realisation
from crowdbot.core.registry import Registry
from crowdbot.dsl.scenario import Crowd, Scenario
from crowdbot.dsl.seeds import stream_seed


def build_crowd(
    scenario: Scenario, realisation: Realisation, parts: EnvironmentParts, registry: Registry
) -> CrowdEngine | None:
    """The engine for a scenario's crowd, or None when it has none."""
    crowd = scenario.crowd
    if crowd is None:
        return None
    costs = [registry.build(c) for c in crowd.costs.values()]
    return CrowdEngine(
        _agents(realisation, crowd),
        _world(scenario, crowd, realisation, parts),
        lambda agents: registry.build(crowd.policy, costs, agents),
    )


def _agents(drawn: Realisation, crowd: Crowd) -> Agents:
    return Agents.of(
        id=drawn.id,
        x=drawn.x,
        y=drawn.y,
        preferred_speed=drawn.speed,
        radius=drawn.radius,
        max_speed=drawn.max_speed,
        max_acceleration=drawn.max_acceleration,
        mass=drawn.mass,
        start_time=drawn.start_time,
        ignores_robot=chosen(
            stream_seed(crowd.seed.root, crowd.seed.key, "crowd.reaction"),
            drawn.id,
            crowd.robot_response.ignoring,
        ),
    )


def _world(
    scenario: Scenario, crowd: Crowd, drawn: Realisation, parts: EnvironmentParts
) -> CrowdWorld:
    names = crowd.flow.portals if crowd.flow.direction == "in" else crowd.flow.portals[::-1]
    response = crowd.robot_response
    return CrowdWorld(
        walls=parts.walls[parts.stops_crowd],
        pillars=parts.pillars,
        torus=parts.torus,
        entrance=np.array([parts.portals[names[0]]]),
        out=np.array([parts.portals[names[1]]]),
        response=np.array(
            [response.stiffness_moving, response.stiffness_stopped, response.slow_speed]
        ),
        robot_visible=response.velocity == "visible",
        stiffness=scenario.contact.stiffness,
        dissipation=scenario.contact.dissipation,
        goal_key=drawn.goal_key,
        decision_rate=scenario.rates.crowd,
    )
