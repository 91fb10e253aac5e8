"""Checks of explicit agents."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from crowdbot.dsl.checks.crowd import missing_speed
from crowdbot.dsl.checks.facts import Facts
from crowdbot.dsl.scenario.people_kinds import USUAL_BODIES
from crowdbot.dsl.scenario.spawning import Agent
from crowdbot.dsl.text.diagnostics import Diagnostic

Disc = tuple[float, float, float]


def check_agents(facts: Facts) -> Iterator[Diagnostic]:
    """Check each explicit agent, and all against each other and the robots."""
    first: dict[int, int] = {}
    for i, agent in enumerate(facts.crowd.agents):
        if first.setdefault(agent.id, i) != i:
            text = f"agent {agent.id} is there twice"
            also = (("first written at", facts.mark("crowd", "agents", first[agent.id], "id")),)
            mark = facts.mark("crowd", "agents", i, "id")
            yield Diagnostic("E138", text, mark, also=also)
        yield from _check_agent(facts, i, agent)
    yield from _check_overlaps(facts)


def _check_agent(facts: Facts, i: int, agent: Agent) -> Iterator[Diagnostic]:
    path, subject = ("crowd", "agents", i), f"agent {agent.id}"
    yield from facts.outside(f"the start {{at}} of {subject}", [(agent.x, agent.y)], *path, "x")
    yield from facts.outside(f"the goal {{at}} of {subject}", agent.goals, *path, "goals")
    if agent.portals is not None:
        yield from facts.portals(agent.portals, subject, *path, "portals")
    if bool(agent.goals) == (agent.portals is not None):
        text = f"{subject} has {'goals and portals' if agent.goals else 'no goal'}"
        hint = "write goals or portals; for one who stands, goals is the start itself"
        yield Diagnostic("E141", text, facts.mark(*path), hint)
    if agent.policy and agent.policy not in facts.crowd.policies:
        yield facts.unknown("policy", agent.policy, facts.crowd.policies, *path, "policy")
    if agent.speed is None and facts.crowd.speed is None:
        yield missing_speed(facts, subject, *path)


def _check_overlaps(facts: Facts) -> Iterator[Diagnostic]:
    """Check that agents entering at the same time do not overlap each other or a robot's start."""
    agents, default = facts.crowd.agents, facts.crowd.body.radius
    waves: dict[float, list[int]] = {}
    for i, agent in enumerate(agents):
        waves.setdefault(agent.start_time, []).append(i)
    looks = [USUAL_BODIES[a.look].radius if a.look else None for a in agents]
    discs = [(a.x, a.y, a.radius or look or default) for a, look in zip(agents, looks, strict=True)]
    for wave in waves.values():
        for one, other in overlapping([discs[i] for i in wave]):
            i, k = sorted((wave[one], wave[other]))
            gap = math.dist(discs[i][:2], discs[k][:2])
            text = f"agents {agents[i].id} and {agents[k].id} overlap at the start"
            hint = f"{gap:.3g} m between them, {discs[i][2] + discs[k][2]:.3g} m needed"
            also = (("the other one at", facts.mark("crowd", "agents", i)),)
            yield Diagnostic("E139", text, facts.mark("crowd", "agents", k), hint, also)
    for name, robot in facts.scenario.robots.items():
        for i in waves.get(0.0, ()):
            if math.dist(discs[i][:2], robot.task.start[:2]) < discs[i][2]:
                text = f"agent {agents[i].id} stands where robot '{name}' starts"
                yield Diagnostic("E139", text, facts.mark("crowd", "agents", i))


def overlapping(discs: Sequence[Disc]) -> Iterator[tuple[int, int]]:
    """Yield index pairs of overlapping discs (x, y, radius; m); touching discs do not count."""
    side = 2.0 * max((d[2] for d in discs), default=1.0)
    cells: dict[tuple[int, int], list[int]] = {}
    for k, (x, y, radius) in enumerate(discs):
        column, row = math.floor(x / side), math.floor(y / side)
        near = (
            i
            for c in (column - 1, column, column + 1)
            for r in (row - 1, row, row + 1)
            for i in cells.get((c, r), ())
        )
        for i in near:
            if math.dist((x, y), discs[i][:2]) < radius + discs[i][2] - 1e-9:
                yield i, k
                break
        cells.setdefault((column, row), []).append(k)
