"""Addresses of the arrays of a crowd's engine, for compiled code."""

from __future__ import annotations

from typing import Any

import numpy as np

from crowdbot.core.batch.array_tables import ArrayTable, ScratchPool
from crowdbot.core.crowd.decision_groups import DecisionGroup
from crowdbot.core.crowd.engine import CrowdEngine
from crowdbot.core.crowd.velocity_search.agent_costs import WORK
from crowdbot.core.crowd.velocity_search.sampling import Sampler
from crowdbot.core.crowd.velocity_search.weighted_costs import WeightedCosts, layers
from crowdbot.core.support.ticks import TICK
from crowdbot.core.types.arrays import Array

#: Arrays of a crowd, in the order of the columns below.
CROWD_FIELDS = (
    "flat", "counts", "traits", "route", "origin", "entry_order", "walls", "entrance", "out",
    "boundary", "rules", "response", "solids", "grid_frame", "grid_first", "grid_near", "reaction",
    "placed", "order", "room", "discs", "numbers", "stiffnesses", "outlines", "robots", "seen",
    "radius", "avoided", "preferred", "fastest_change", "heeds", "late", "attention", "evades",
    "position", "velocity", "goal", "present", "pressed",
)  # fmt: skip
(
    FLAT, COUNTS, TRAITS, ROUTE, ORIGIN, ENTRY_ORDER, WALLS, ENTRANCE, OUT,
    BOUNDARY, RULES, RESPONSE, SOLIDS, GRID_FRAME, GRID_FIRST, GRID_NEAR, REACTION,
    PLACED, ORDER, ROOM, DISCS, NUMBERS, STIFFNESSES, OUTLINES, ROBOTS, SEEN,
    RADIUS, AVOIDED, PREFERRED, FASTEST_CHANGE, HEEDS, LATE, ATTENTION, EVADES,
    POSITION, VELOCITY, GOAL, PRESENT, PRESSED,
) = range(len(CROWD_FIELDS))  # fmt: skip

#: Entries of ``counts``: ticks between decisions; key of goals; 1 if robots' motion is seen.
EVERY, GOAL_KEY, MOTION_SEEN = range(3)

#: Arrays of a group of people who decide alike.
GROUP_FIELDS = (
    "members", "choices", "numbers", "traits", "settings", "random", "near", "found", "deciding",
    "discs", "table", "functions", "weights", "candidates", "regular", "ranked", "indices", "first",
    "frame", "world", "active", "tried", "grid_frame", "grid_first", "grid_near", "chosen",
    "decides", "shown", "starts", "order", "box",
)  # fmt: skip
(
    G_MEMBERS, G_CHOICES, G_NUMBERS, G_TRAITS, G_SETTINGS, G_RANDOM, G_NEAR, G_FOUND, G_DECIDING,
    G_DISCS, G_TABLE, G_FUNCTIONS, G_WEIGHTS, G_CANDIDATES, G_REGULAR, G_RANKED, G_INDICES, G_FIRST,
    G_FRAME, G_WORLD, G_ACTIVE, G_TRIED, G_GRID_FRAME, G_GRID_FIRST, G_GRID_NEAR, G_CHOSEN,
    G_DECIDES, G_SHOWN, G_STARTS, G_ORDER, G_BOX,
) = range(len(GROUP_FIELDS))  # fmt: skip

#: Entries of a group's ``choices``, integers, and of its ``numbers``.
BASE, DIRECTION, SCALE, DRAWN, ORDERED, TABULATED, SEES_ROBOT = range(7)
HALF, REACH, RELAXATION, STEP = range(4)


def is_compiled(engine: CrowdEngine) -> bool:
    """Return True if compiled code alone makes all decisions of a crowd.

    Otherwise `CrowdEngine` makes them, world by world, with the same results.
    """
    return engine.decides_by_policies_alone and all(searches(g) for g in engine.groups)


def searches(group: DecisionGroup) -> bool:
    """True if people sample velocities with compiled cost functions."""
    search = getattr(group.policy, "compiled_search", None)
    return isinstance(search, Sampler) and not search.costs.vectorised


def crowd_table(
    engine: CrowdEngine,
    flat: Array,
    robots: Array,
    outlines: Array,
    stiffnesses: Array,
    pool: ScratchPool,
) -> ArrayTable:
    """Return a table with the addresses of a crowd's arrays.

    Args:
        flat: its state, changed in place.
        robots, outlines, stiffnesses: rows (R, 8) of the robots, changed in place from outside;
            their outlines (R, K, 2); stiffness of contact with each (R,), N/m.
    """
    people, own = len(engine.agents), ArrayTable(CROWD_FIELDS)
    a, w, (*fixed, room) = engine.agents, engine.world, engine.parameters
    own.put(**dict(zip(_TICK_FIELDS, (*fixed[:10], *fixed[11:], room), strict=True)))
    key = np.array([int(fixed[10])], np.uint64).view(np.int64)
    own.put(
        flat=flat,
        counts=np.array([engine.ticks_per_decision, key[0], w.robot_visible], np.int64),
        discs=_owned(w.pillars),
        numbers=np.arange(len(robots)),
        stiffnesses=stiffnesses,
        outlines=outlines,
        robots=robots,
        radius=_owned(a.radius),
        avoided=_owned(a.avoided_radius),
        preferred=_owned(a.preferred_speed),
        fastest_change=_owned(a.max_acceleration),
        heeds=np.ascontiguousarray(engine.heeds_robots),
        late=np.ascontiguousarray(a.late),
        attention=_owned(engine.room),
        evades=engine.evades,
        pressed=np.zeros((len(robots), people)),
    )
    pool.put(
        own,
        seen=np.zeros_like(robots),
        position=np.zeros((people, 2)),
        velocity=np.zeros((people, 2)),
        goal=np.zeros((people, 2)),
        present=np.zeros(people, np.bool_),
        **{name: own.arrays[name] for name in ("reaction", "placed", "room")},
    )
    return own


#: What `tick` takes of people, world and scratch, without the key of goals.
_TICK_FIELDS = (
    "traits", "route", "origin", "entry_order", "walls", "entrance", "out", "boundary", "rules",
    "response", "solids", "grid_frame", "grid_first", "grid_near", "reaction", "placed", "order",
    "room",
)  # fmt: skip


def _owned(array: Array) -> Array:
    return np.ascontiguousarray(array, np.float64)


def group_tables(engine: CrowdEngine, robots: Array, pool: ScratchPool) -> list[ArrayTable]:
    """Return the arrays of each group of a crowd that decides in compiled code alone.

    Args:
        robots: (R, 8) as in `crowd_table`.
    """
    return [_group_table(engine, group, robots, pool) for group in engine.groups]


def _group_table(
    engine: CrowdEngine, group: DecisionGroup, robots: Array, pool: ScratchPool
) -> ArrayTable:
    policy: Any = group.policy
    sampler, dt = policy.compiled_search, engine.ticks_per_decision * TICK
    costs = sampler.costs
    people, walls, pillars = len(engine.agents), engine.world.walls, engine.world.pillars
    shown = len(robots) if group.sees_robot else 0
    seen = np.concatenate([[costs.largest], pillars[:, 2], robots[:shown, 5]])
    reach = costs.reach_of(float(np.max(seen)))
    tables = costs.tables(people + len(pillars) + shown, len(walls), dt)
    search, grid = sampler.arguments(dt), costs.wall_grid(walls, float(np.max(seen)))
    options, own = search.options, ArrayTable(GROUP_FIELDS)
    scratch = tables._asdict()
    own.put(settings=scratch.pop("settings"))
    functions = costs.functions.copy()
    functions[:, WORK] = layers(pool("work", costs.work))
    own.put(
        members=np.ascontiguousarray(group.members),
        choices=np.array(
            [
                options.base, options.direction, options.radius, options.drawn, search.ordered,
                search.tabulated, group.sees_robot,
            ],
            np.int64,
        ),
        numbers=np.array([options.half, reach, max(costs.relaxation_time, dt), dt]),
        traits=costs.traits, random=costs.random,
        functions=functions, weights=costs.weights,
        candidates=search.candidates, regular=search.regular,
        ranked=search.ranked, indices=search.indices, first=search.first,
        grid_frame=grid.frame, grid_first=grid.first, grid_near=grid.near, box=np.zeros(4),
    )  # fmt: skip
    pool.put(
        own, **scratch, frame=search.frame, world=search.world, active=search.active,
        tried=search.tried, chosen=np.zeros((people, 2)), decides=np.zeros(people, np.bool_),
        shown=np.zeros((shown, 5)),
    )  # fmt: skip
    return own


def random_states(engine: CrowdEngine) -> list[Array]:
    """Return the random generators' states (N,) of each policy, which random candidates change."""
    costs = (getattr(policy, "costs", None) for policy in engine.policies)
    return [c.random for c in costs if isinstance(c, WeightedCosts)]
