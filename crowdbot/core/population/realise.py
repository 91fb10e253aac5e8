"""Sample a scenario's crowd: starts, speeds and goals.

Explicit agents come first, then the flow, then streams and spawns by name: each avoids those
before.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np

from crowdbot.core.population.bodies import Bodies, draw_bodies
from crowdbot.core.population.draws import (
    Streams,
    draw_attention,
    draw_speeds,
    heading_to,
    stream_heading,
)
from crowdbot.core.population.ground import Ground
from crowdbot.core.population.occupancy import Occupancy
from crowdbot.core.population.placement import ATTEMPTS
from crowdbot.core.population.realisation import Realisation
from crowdbot.core.population.spawns import SpawnSampler
from crowdbot.core.population.stream_sampler import StreamSampler
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.dsl.scenario.crowd import Crowd, Flow
from crowdbot.dsl.scenario.people_kinds import USUAL_BODIES
from crowdbot.dsl.scenario.scenario import Scenario
from crowdbot.dsl.scenario.spawning import Agent
from crowdbot.dsl.spec.assets import Asset
from crowdbot.errors import InputError

Row = dict[str, Any]


def realise(scenario: Scenario, parts: EnvironmentParts | None = None) -> Realisation:
    """Sample the crowd from its named streams; return an empty table without a crowd.

    Args:
        parts: its environment: people are not placed in walls or sent to unreachable goals; None
            ignores walls.

    Raises:
        InputError: the people do not fit into their zone, or a goal cannot be reached.
    """
    crowd = scenario.crowd
    if crowd is None:
        return Realisation.nobody()
    streams = Streams(crowd.seed.root, crowd.seed.key)
    return _table(_people(scenario, crowd, parts, streams), streams)


def from_source(scenario: Scenario, parts: EnvironmentParts | None, source: str) -> list[int]:
    """Return the ids of people of one spawn or stream, in order.

    Args:
        scenario, parts: as for `realise`.
        source: such as ``spawn hall`` or ``stream north``.

    Raises:
        InputError: as `realise`.
    """
    crowd = scenario.crowd
    if crowd is None:
        return []
    streams = Streams(crowd.seed.root, crowd.seed.key)
    rows = _people(scenario, crowd, parts, streams)
    return sorted(row["id"] for row in rows if row.get("source") == source)


def _people(
    scenario: Scenario, crowd: Crowd, parts: EnvironmentParts | None, streams: Streams
) -> list[Row]:
    """Return rows of all people without ``goal_key``; those of drawn people name their source."""
    ground = Ground(parts, crowd)
    occupancy = Occupancy([robot.task.start[:2] for robot in scenario.robots.values()], ground)
    if crowd.names_nobody and crowd.policy.record is not None:
        return list(_recorded(crowd, crowd.policy.record, streams))
    explicit = [_agent_row(a, scenario, crowd, streams) for a in crowd.agents]
    for row in explicit:
        start = row["x"], row["y"]
        ground.check_route(f"agent {row['id']}", start, row["goals"], row["radius"])
        occupancy.add(*start, row["radius"])
    drawn = (
        [] if crowd.flow is None else _flow_rows(crowd.flow, scenario, crowd, streams, occupancy)
    )
    group = max((agent.group for agent in crowd.agents), default=-1) + 1
    samplers: dict[str, StreamSampler | SpawnSampler] = {
        **{
            f"stream {n}": StreamSampler(n, s, scenario, crowd, streams)
            for n, s in sorted(crowd.streams.items())
        },
        **{
            f"spawn {n}": SpawnSampler(n, s, scenario, crowd, streams)
            for n, s in sorted(crowd.spawns.items())
        },
    }
    for source, sampler in samplers.items():
        rows = sampler.rows(occupancy, group)
        group = max([group, *(max(row["group"], row.get("queue", -1)) + 1 for row in rows)])
        drawn += [row | {"source": source} for row in rows]
    return [*explicit, *_numbered(drawn, {agent.id for agent in crowd.agents})]


def _table(rows: Iterable[Row], streams: Streams) -> Realisation:
    """Return the table of complete rows without the key of goals, in the order of ids."""
    key = {"goal_key": streams.seed("crowd.goal")}
    return Realisation.from_rows(sorted((row | key for row in rows), key=lambda row: row["id"]))


def _recorded(crowd: Crowd, record: Asset, streams: Streams) -> Iterator[Row]:
    """Yield the people of a record: each enters at its recorded start and goes to its end."""
    from crowdbot.core.crowd.recorded import read_record  # slow import of the engine

    people = read_record(record.file).agents()
    for i, person in enumerate(people.id.tolist()):
        start = float(people.x[i]), float(people.y[i])
        goal = float(people.route[i, 0]), float(people.route[i, 1])  # one point each
        yield {
            **crowd.body.model_dump(include={"radius", "mass", "max_speed", "max_acceleration"}),
            "id": person,
            "x": start[0],
            "y": start[1],
            "heading": heading_to(*start, goal),
            "speed": float(people.preferred_speed[i]),
            "start_time": float(people.start_time[i]),
            "attention": draw_attention(streams, "crowd.attention", person),
            "group": -1,
            "policy": "",
            "at_goal": "remove",
            "portals": ("", ""),
            "goals": (goal,),
        }


def _numbered(rows: Sequence[Row], taken: set[int]) -> Iterator[Row]:
    """Yield rows with the smallest ids that no explicit agent has, in order."""
    free = (n for n in itertools.count() if n not in taken)
    return (row | {"id": n} for row, n in zip(rows, free, strict=False))


def _flow_rows(
    flow: Flow, scenario: Scenario, crowd: Crowd, streams: Streams, occupancy: Occupancy
) -> list[Row]:
    """Return the people of the flow, spread over its zone."""
    zone = scenario.environment.zones[flow.area]
    people = round(flow.density * zone.area)
    rng, body = streams.rng("crowd.spawn"), crowd.body
    bodies = _flow_bodies(crowd, people, streams)
    points: list[tuple[float, float]] = []
    for i, radius in enumerate(bodies.radius.tolist()):
        low = np.array([zone.x[0] + radius, zone.y[0] + radius])
        high = np.array([zone.x[1] - radius, zone.y[1] - radius])
        for _ in range(ATTEMPTS):
            x, y = (low + (high - low) * rng.random(2)).tolist()
            if occupancy.is_free(x, y, radius):
                break
        else:
            raise InputError(f"only {i} of {people} people fit into the crowd's zone")
        occupancy.add(x, y, radius)
        points.append((x, y))
    assert crowd.speed is not None  # checked on validation
    speeds = bodies.walk_at(draw_speeds(streams.rng("crowd.speed"), people, crowd.speed))
    common: Row = {
        "max_speed": body.max_speed,
        "max_acceleration": body.max_acceleration,
        "start_time": 0.0,
        "group": -1,
        "policy": "",
        "at_goal": "portal",
        "goals": (),
    }
    ways = itertools.cycle(_ways(flow, scenario))
    return [
        common
        | bodies.row(i)
        | way
        | {"x": x, "y": y, "speed": speed}
        | {"attention": draw_attention(streams, "crowd.attention", i)}
        for i, ((x, y), speed, way) in enumerate(zip(points, speeds, ways, strict=False))
    ]


def _flow_bodies(crowd: Crowd, people: int, streams: Streams) -> Bodies:
    usual = np.full(people, crowd.body.radius), np.full(people, crowd.body.mass)
    return draw_bodies(
        crowd.people, (), usual, lambda purpose, i: streams.rng(f"crowd.people.{purpose}", i)
    )


def _ways(flow: Flow, scenario: Scenario) -> list[Row]:
    """Return portals and headings that the people of a flow take in turn.

    They do not depend on places, so equal seeds give equal positions for all directions of a flow.
    """
    there, back = flow.portals, flow.portals[::-1]
    taken = {"in": [there], "counter": [back], "both": [there, back]}[flow.direction]
    boxes = scenario.environment.portals
    return [{"portals": way, "heading": stream_heading(way, boxes)} for way in taken]


def _look_of(agent: Agent) -> Row:
    """Return an explicit agent's body: its own numbers, else those that are usual for its look."""
    assert agent.look is not None
    look = USUAL_BODIES[agent.look]
    usual = {"radius": look.radius, "mass": look.mass[0] if look.mass else None}
    own = {name: getattr(agent, name) for name in usual if getattr(agent, name) is not None}
    return usual | own | {"height": agent.height or look.height[0]}


def _agent_row(agent: Agent, scenario: Scenario, crowd: Crowd, streams: Streams) -> Row:
    """Return an explicit agent, with the crowd's values for missing ones."""
    row = agent.model_dump()
    if agent.look is not None:
        row |= _look_of(agent)
    for name in ("radius", "mass", "max_speed", "max_acceleration"):
        if row[name] is None:
            row[name] = getattr(crowd.body, name)
    if agent.speed is None:
        assert crowd.speed is not None  # checked on validation
        rng = streams.rng("crowd.agents.speed", agent.id)
        row["speed"] = draw_speeds(rng, 1, crowd.speed)[0]
    if agent.attention is None:
        row["attention"] = draw_attention(streams, "crowd.agents.attention", agent.id)
    if agent.heading is None:
        row["heading"] = (
            stream_heading(agent.portals, scenario.environment.portals)
            if agent.portals
            else heading_to(agent.x, agent.y, agent.goals[0])
        )
    row["at_goal"] = "portal" if agent.portals else agent.at_goal or "stop"
    row["portals"] = agent.portals or ("", "")
    return row
