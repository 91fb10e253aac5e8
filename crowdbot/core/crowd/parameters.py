"""What stays the same in all ticks of a run, in the form that `crowdbot.core.crowd.step` takes.

`tick` takes the fields one by one, in this order, and packs them itself: numba would need some
3 us to unpack a named tuple that comes from Python.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from crowdbot.core.crowd.agents import Agents
from crowdbot.core.crowd.periodic_boundary import ENDLESS
from crowdbot.core.crowd.world import CrowdWorld
from crowdbot.core.types.arrays import Array, Indices, Mask


class AgentParameters(NamedTuple):
    """Columns of `Agents`, (N,) each; units are those of `Agents`.

    Attributes:
        id, radius, mass, preferred_speed, max_speed, start_time, at_goal, flow: as there.
        route, first: (W, 2), (N + 1,) as there.
        entry_order: rows of agents by id: the order in which they enter.
        heeds_robot: whether an agent steers away from robots.
        push: stiffness of contacts with people, walls and pillars, 1/s^2.
        goal_area, pause, ahead, origin, guide, abreast: as in `Agents`.
        stays: whether an agent may have reason to stay at a goal for a while.
    """

    id: Indices
    radius: Array
    mass: Array
    preferred_speed: Array
    max_speed: Array
    start_time: Array
    at_goal: Indices
    flow: Indices
    route: Array
    first: Indices
    entry_order: Indices
    heeds_robot: Mask
    push: Array
    goal_area: Array
    pause: Array
    ahead: Indices
    origin: Array
    guide: Indices
    abreast: Array
    stays: Mask

    @classmethod
    def of(cls, agents: Agents, push: Array) -> AgentParameters:
        """Those of agents who push each other with the stiffness ``push`` (N,)."""
        a = agents
        return cls(
            a.id, a.radius, a.mass, a.preferred_speed, a.max_speed, a.start_time, a.at_goal,
            a.flow, a.route, a.first, np.argsort(a.id, kind="stable"), ~a.ignores_robot, push,
            a.goal_area, a.pause, a.ahead, a.origin, a.guide, a.abreast, _may_stay(a),
        )  # fmt: skip


def _may_stay(agents: Agents) -> Mask:
    """(N,) who is in a queue or pauses somewhere."""
    pauses = np.concatenate([[0.0], np.cumsum(agents.pause)])
    found: Mask = (agents.ahead >= 0) | (np.diff(pauses[agents.first]) > 0.0)
    return found


class WorldParameters(NamedTuple):
    """Fields of `CrowdWorld`; units are those of `CrowdWorld`.

    Attributes:
        walls, entrance, out, dissipation: as there.
        keep_offset: whether people come out of the in-portal opposite to where they went in.
        goal_ahead: whether their goal in the out-portal is opposite to where their trip starts.
        boundary: (4,) x0, x1, y0, y1, m, infinite where the world has no border.
        goals_wrap: whether goals wrap with their agents.
        response: what people do about robots tick by tick, see
            `crowdbot.core.crowd.response.parameters`.
        goal_key: key of the counter-based random numbers of goals and entries.
        solids: (M, 5) sides x0, y0, x1, y1 of convex outlines, m, and the outline's number.
    """

    walls: Array
    entrance: Array
    out: Array
    keep_offset: bool
    goal_ahead: bool
    boundary: Array
    goals_wrap: bool
    response: Array
    dissipation: float
    goal_key: np.uint64
    solids: Array

    @classmethod
    def of(cls, world: CrowdWorld) -> WorldParameters:
        """Those of a world."""
        w, boundary = world, world.periodic_boundary
        return cls(
            w.walls, w.entrance, w.out, w.exit_point == "offset", w.goal_point == "ahead",
            ENDLESS if boundary is None else np.array(boundary, np.float64), not w.parity,
            w.response.by_tick, w.dissipation, np.uint64(w.goal_key),
            _sides(w.solids),
        )  # fmt: skip


def _sides(outlines: Sequence[Array]) -> Array:
    """Sides of outlines (K, 2), (M, 5), and to which outline each belongs."""
    rows = [
        np.column_stack([outline, np.roll(outline, -1, axis=0), np.full(len(outline), k)])
        for k, outline in enumerate(outlines)
    ]
    return np.concatenate([np.zeros((0, 5)), *rows])


class Scratch(NamedTuple):
    """Arrays that ticks write to and do not read from before.

    Attributes:
        reaction: (N, 2) force of robots on each agent, N.
        placed: (N, `PLACED_COLUMNS`) see `push_apart`.
        order: (N,) all agents in any order; sorted by x afterwards, which makes the next sort
            cheap.
    """

    reaction: Array
    placed: Array
    order: Indices
