"""Build a crowd engine from a scenario."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd import Agents, CrowdEngine, CrowdWorld
from crowdbot.core.crowd.agents import LOOP, ONWARD, PORTAL, REMOVE, RETURN, STOP
from crowdbot.core.crowd.build import build_cost, build_policy
from crowdbot.core.crowd.engine import PolicyFactory
from crowdbot.core.crowd.response.from_spec import response_of
from crowdbot.core.crowd.routing.from_spec import routing_of
from crowdbot.core.crowd.steering.parameters import Steering
from crowdbot.core.population.realisation import Realisation
from crowdbot.core.registry.registry import Registry
from crowdbot.core.types.appearance import Appearance
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.dsl.scenario.crowd import Crowd, NamedPolicy
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.scenario.seeds import stream_seed
from crowdbot.dsl.scenario.steering import SteeringSpec

#: Names of a stream's portals, from and to.
Flow = tuple[str, str]

_AT_GOAL = {
    "portal": PORTAL, "stop": STOP, "remove": REMOVE, "loop": LOOP, "return": RETURN,
    "onward": ONWARD,
}  # fmt: skip


def build_crowd(
    scenario: Scenario,
    realisation: Realisation,
    parts: EnvironmentParts,
    registry: Registry,
) -> CrowdEngine | None:
    """Return the engine for a scenario's crowd, or None if it has no crowd."""
    crowd = scenario.crowd
    if crowd is None:
        return None
    flows, policies = _flows(realisation), _policies(crowd, realisation)
    return CrowdEngine(
        _agents(crowd, realisation, flows, list(policies)),
        _world(scenario, crowd, realisation, parts, _boxes(flows, parts)),
        [_factory(group, registry) for group in policies.values()],
    )


def in_series(body: float, skin: float) -> float:
    """Return the stiffness of two springs in series, N/m."""
    return body if math.isinf(skin) else body * skin / (body + skin)


def _factory(group: Crowd | NamedPolicy, registry: Registry) -> PolicyFactory:
    costs = [build_cost(registry, cost) for cost in group.costs.values()]
    return lambda agents: build_policy(registry, group.policy, costs, agents)


def _flows(drawn: Realisation) -> list[Flow]:
    """Return the streams between portals, in the order of the agents."""
    return list(dict.fromkeys(pair for pair in drawn.portals if any(pair)))


def _boxes(flows: Sequence[Flow], parts: EnvironmentParts) -> NDArray[np.float64]:
    """Return (F, 2, 4) entrance and exit of each stream, x0, x1, y0, y1, m."""
    boxes = [[parts.portals[name] for name in flow] for flow in flows]
    return np.array(boxes, dtype=np.float64).reshape(-1, 2, 4)


def _policies(crowd: Crowd, drawn: Realisation) -> dict[str, Crowd | NamedPolicy]:
    """Return the policies in use, by name; the crowd's own comes first, without a name."""
    used = {name: crowd.policies[name] for name in sorted(set(drawn.policy) - {""})}
    return {"": crowd, **used}


def _agents(
    crowd: Crowd, drawn: Realisation, flows: Sequence[Flow], policies: Sequence[str]
) -> Agents:
    response = crowd.robot_response  # the least attentive ignore robots, the next notice them late
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
        at_goal=[_AT_GOAL[word] for word in drawn.at_goal],
        flow=[flows.index(pair) if any(pair) else 0 for pair in drawn.portals],
        policy=[policies.index(name) for name in drawn.policy],
        routes=drawn.goals,
        ignores_robot=drawn.attention < response.ignoring,
        group=drawn.group,
        late=drawn.attention < response.ignoring + (1.0 - response.ignoring) * response.late,
        attention=np.maximum(0.0, drawn.attention - response.ignoring)
        / max(1.0 - response.ignoring, 1e-9),
        goal_areas=drawn.goal_areas,
        pauses=drawn.pauses,
        ahead=_ahead(drawn.queue),
        origins=drawn.origin,
        heading=drawn.heading,
        looks=_looks(drawn),
        avoided_radius=np.asarray(drawn.radius) * _avoided(crowd),
    )


def _ahead(queue: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return (N,) the row of the previous person in the same queue, or -1."""
    last: dict[int, int] = {}
    ahead = np.full(len(queue), -1, np.int64)
    for i, number in enumerate(queue.tolist()):
        if number >= 0:
            ahead[i] = last.get(number, -1)
            last[number] = i
    return ahead


def _looks(drawn: Realisation) -> Appearance | None:
    """Return the appearance of each person for sensors; None if all are alike."""
    if not (any(drawn.look) or np.any(drawn.height) or np.any(drawn.phase)):
        return None
    return Appearance(
        height=drawn.height, leg_length=drawn.leg_length, phase=drawn.phase, look=drawn.look
    )


def _avoided(crowd: Crowd) -> float:
    """Return the margin of avoidance around each person's body."""
    avoided = crowd.body.avoided_radius
    return 1.0 if avoided is None else avoided / crowd.body.radius


def _world(
    scenario: Scenario,
    crowd: Crowd,
    drawn: Realisation,
    parts: EnvironmentParts,
    boxes: NDArray[np.float64],
) -> CrowdWorld:
    response = crowd.robot_response
    walls, pillars, solids = parts.in_the_way(crowd.body.height)
    return CrowdWorld(
        walls=walls,
        pillars=pillars,
        solids=solids,
        periodic_boundary=parts.periodic_boundary,
        entrance=boxes[:, 0],
        out=boxes[:, 1],
        exit_point=crowd.exit_point,
        goal_point=crowd.goal_point,
        response=response_of(response),
        cohesion=crowd.groups,
        steering=Steering(
            crowd.steering or SteeringSpec(),
            key=stream_seed(crowd.seed.root, crowd.seed.key, "crowd.wander"),
        ),
        firm=crowd.solids == "firm",
        robot_visible=response.velocity == "visible",
        stiffness=scenario.contact.stiffness,
        dissipation=scenario.contact.dissipation,
        body_dissipation=crowd.contact_dissipation,
        goal_key=drawn.goal_key,
        decision_rate=scenario.rates.crowd,
        routing=routing_of(crowd),
    )
