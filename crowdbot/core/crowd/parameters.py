"""Parameters of all ticks of a run, in the form that `crowdbot.core.crowd.step` takes.

`tick` takes the fields one by one, in this order, and packs them itself: numba needs about 3 us to
unpack a named tuple from Python.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.contact.pedestrian_contact import PLACED, PlacedRecord
from crowdbot.core.crowd.contact.solid import LONGEST_STEP
from crowdbot.core.crowd.goal_areas import PLACE, PlaceRecord
from crowdbot.core.crowd.periodic_boundary import ENDLESS
from crowdbot.core.crowd.response.parameters import TickResponse
from crowdbot.core.crowd.traits import TRAITS, TraitsRecord
from crowdbot.core.crowd.world import CrowdWorld
from crowdbot.core.geometry.segment_grid import segment_grid
from crowdbot.core.support.records import RecordType, Rows, record_type, rows_of
from crowdbot.core.types.arrays import Array, Indices, Mask


class AgentParameters(NamedTuple):
    """Traits and routes of people.

    Attributes:
        traits: (N,) of each.
        route: (W,) points of all routes.
        origin: (N,) point or area at which each enters.
        entry_order: (N,) rows of agents by id: the order in which they enter.
    """

    traits: Rows[TraitsRecord]
    route: Rows[PlaceRecord]
    origin: Rows[PlaceRecord]
    entry_order: Indices

    @classmethod
    def of(cls, agents: Agents, push: Array, limit: Array | None = None) -> AgentParameters:
        """Return the parameters of agents.

        Args:
            push: (N,) contact stiffness, 1/s^2.
            limit: (N,) smallest distance of centres from walls and pillars, m; None: no limit.
        """
        a = agents
        traits = _table(
            TRAITS, len(a), id=a.id, radius=a.radius, mass=a.mass,
            preferred_speed=a.preferred_speed, max_speed=a.max_speed, start_time=a.start_time,
            at_goal=a.at_goal, flow=a.flow, first=a.first[:-1], end=a.first[1:], push=push,
            limit=np.zeros(len(a)) if limit is None else limit,
            ahead=a.ahead, guide=a.guide, abreast=a.abreast,
            chooses_origin=a.origin[:, 2] > 0.0, stays=_may_stay(a),
        )  # fmt: skip
        route = _places(len(a.route), np.column_stack([a.route, a.goal_area, a.pause]))
        order = np.argsort(a.id, kind="stable")
        return cls(traits, route, _places(len(a), a.origin), order)


def _table(record: RecordType[Any], count: int, **columns: NDArray[Any]) -> Rows[Any]:
    rows = rows_of(count, record)
    for name, column in columns.items():
        rows[name][:] = column
    return rows


def _places(count: int, columns: Array) -> Rows[PlaceRecord]:
    """Return K records of places from columns x, y, width, height, turn and, optionally, pause."""
    return _table(PLACE, count, **dict(zip(PLACE.names, columns.T, strict=False)))


def _may_stay(agents: Agents) -> Mask:
    """Return (N,) True for people who queue, or pause on their route."""
    pauses = np.concatenate([[0.0], np.cumsum(agents.pause)])
    found: Mask = (agents.ahead >= 0) | (np.diff(pauses[agents.first]) > 0.0)
    return found


class RulesRecord:
    """Rules of portals, pillars and contacts that hold for all people, as a record.

    Attributes:
        keep_offset: 1 if people come out of the in-portal opposite to where they went in.
        goal_ahead: 1 if their goal in the out-portal is opposite to where their trip starts.
        goals_wrap: 1 if goals wrap with their agents.
        dissipation: as in `CrowdWorld`.
        pillars: number of pillars.
        body_dissipation: as in `CrowdWorld`.
    """

    keep_offset: float
    goal_ahead: float
    goals_wrap: float
    dissipation: float
    pillars: float
    body_dissipation: float


RULES = record_type(RulesRecord)


class WorldParameters(NamedTuple):
    """Fields of `CrowdWorld`; units are those of `CrowdWorld`.

    Attributes:
        walls, entrance, out: as there.
        boundary: (4,) x0, x1, y0, y1, m, infinite where the world has no border.
        rules, response: (1,) rules for all people; their response to robots in each tick.
        goal_key: key of the counter-based random numbers of goals and entries.
        solids: (M, 5) sides x0, y0, x1, y1 of convex outlines, m, and the outline's number.
        frame, first, near: `SegmentGrid` of the walls, for bodies.
    """

    walls: Array
    entrance: Array
    out: Array
    boundary: Array
    rules: Rows[RulesRecord]
    response: Rows[TickResponse]
    goal_key: np.uint64
    solids: Array
    frame: Array
    first: Indices
    near: Indices

    @classmethod
    def of(cls, world: CrowdWorld, largest: float = math.inf) -> WorldParameters:
        """Return the parameters of a world.

        Args:
            largest: radius of the largest body, m.
        """
        w, boundary = world, world.periodic_boundary
        grid = segment_grid(world.walls, largest + LONGEST_STEP)
        rules = _table(
            RULES, 1, keep_offset=np.array([w.exit_point == "offset"]),
            goal_ahead=np.array([w.goal_point == "ahead"]), goals_wrap=np.array([not w.parity]),
            dissipation=np.array([w.dissipation]), pillars=np.array([len(w.pillars)]),
            body_dissipation=np.array([w.body_dissipation]),
        )  # fmt: skip
        return cls(
            w.walls, w.entrance, w.out,
            ENDLESS if boundary is None else np.array(boundary, np.float64),
            rules, w.response.by_tick, np.uint64(w.goal_key), _sides(w.solids), *grid,
        )  # fmt: skip


def _sides(outlines: Sequence[Array]) -> Array:
    """Return the sides (M, 5) of outlines (K, 2): x0, y0, x1, y1, m, and the outline's number."""
    rows = [
        np.column_stack([outline, np.roll(outline, -1, axis=0), np.full(len(outline), k)])
        for k, outline in enumerate(outlines)
    ]
    return np.concatenate([np.zeros((0, 5)), *rows])


class Scratch(NamedTuple):
    """Scratch arrays, which ticks write before reading.

    Attributes:
        reaction: (N, 2) force of robots on each agent, N.
        placed: (N,) see `push_apart`.
        order: (N,) all agents in any order; sorted by x afterwards, which makes the next sort
            cheap.
        room: (N,) distance of each centre from the nearest wall or pillar that its body overlaps,
            m; infinite without one.
    """

    reaction: Array
    placed: Rows[PlacedRecord]
    order: Indices
    room: Array

    @classmethod
    def of(cls, people: int) -> Scratch:
        """Return scratch arrays for this number of people."""
        return cls(
            np.zeros((people, 2)), rows_of(people, PLACED), np.arange(people), np.zeros(people)
        )
