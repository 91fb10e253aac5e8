"""Surroundings of all agents at one decision, in the form that compiled loops take.

Numba needs about 3 us to unpack a named tuple from Python, and nothing for one packed in compiled
code. So the loops over agents (in `sampling`, `gradient`, `optimum`, `evaluate`) take the fields of
`Surroundings` one by one, in this order, and pack them before anything else.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from crowdbot.core.crowd.contact.geometry import is_clearly_shorter
from crowdbot.core.crowd.velocity_search.neighbour_discs import write_discs
from crowdbot.core.crowd.velocity_search.neighbours import (
    DiscRecord,
    Starts,
    sort_discs,
    strip_height,
)
from crowdbot.core.crowd.velocity_search.records import AgentRecord, NeighbourRecord, WallRecord
from crowdbot.core.support.compiling.compile import inline_kernel, kernel
from crowdbot.core.support.records import Rows, record_type
from crowdbot.core.types.arrays import Array, Indices, Mask


class DecisionTraitsRecord:
    """Traits of an agent for the search; fields as in `AgentRecord`."""

    preferred: float
    max_speed: float
    max_acceleration: float
    weight: float


class SettingsRecord:
    """Settings for all agents; fields as in `AgentRecord`.

    Attributes:
        wall_metres, wall_seconds: no wall matters beyond a centre distance of the first plus the
            second times the fastest speed of a decision.
        wall_own: 1 if that speed is combined with the agent's, see `CompiledCost.reach_with_own`.
        wall_preferred: 1 if those seconds count at the preferred speed, as
            `CompiledCost.reach_at_preferred`.
        wall_grid: the reach of the `SegmentGrid`, m.
        wall_way: 1 if gradients need only walls on the way, as `CompiledCost.walls_on_the_way`.
        wall_more: 1 if functions look for walls that are farther away, where these matter.
        floor: address of the `FloorRecord`.
    """

    time_step: float
    relaxation: float
    parity: float
    wall_metres: float
    wall_seconds: float
    wall_own: float
    wall_preferred: float
    wall_grid: float
    wall_way: float
    wall_more: float
    floor: float


TRAITS = record_type(DecisionTraitsRecord)
SETTINGS = record_type(SettingsRecord)


class Surroundings(NamedTuple):
    """All agents and their surroundings at one decision.

    Attributes:
        table: (B,) all discs, sorted into strips by `neighbours.sort_discs`.
        starts: (strips + 1, 2) from the same function.
        low, height: lower border of the first strip, and height of a strip, m.
        decides: (N,) True for agents whose velocity is chosen.
        goal: (N, 2), m.
        walls: (S, 4) both ends of segments, m.
        grid_frame, grid_first, grid_cells: their `SegmentGrid`.
        reach: largest centre distance at which a neighbour may count, m.
        traits: (N,) of the agents.
        settings: (1,) for all.
        random: (N,) states of the agents' random numbers, changed in place.
        near, found: (>= B,), (>= S,) scratch for one agent's neighbours and walls.
        deciding: (1,) scratch: the agent that decides.
    """

    table: Rows[DiscRecord]
    starts: Starts
    low: float
    height: float
    decides: Mask
    goal: Array
    walls: Array
    grid_frame: Array
    grid_first: Indices
    grid_cells: Indices
    reach: float
    traits: Rows[DecisionTraitsRecord]
    settings: Rows[SettingsRecord]
    random: Array
    near: Rows[NeighbourRecord]
    found: Rows[WallRecord]
    deciding: Rows[AgentRecord]


@kernel
def sort_surroundings(
    position: Array, velocity: Array, goal: Array, radius: Array, preferred: Array, present: Mask,
    robots: Array, pillars: Array, box: Array, diagonal: bool, reach: float,
    discs: Rows[DiscRecord], table: Rows[DiscRecord], starts: Starts, order: Indices,
) -> tuple[int, float, float, int]:  # fmt: skip
    """Write all discs to ``table``, sorted into strips.

    Args:
        position to discs: as in `neighbour_discs.write_discs`.
        table: as ``discs``.
        starts, order: as in `neighbours.sort_discs`.

    Returns:
        number of discs, the strips' height, and the result of `neighbours.sort_discs`.
    """
    count = write_discs(
        position, velocity, goal, radius, preferred, present, robots, pillars, box, diagonal, reach,
        discs,
    )  # fmt: skip
    height = strip_height(discs, count, reach)
    low, strips = sort_discs(discs, count, height, table, starts, order)
    return count, height, low, strips


@inline_kernel
def wall_distance(around: Surroundings) -> float:
    """Return the centre distance beyond which no wall matters to the agent that decides, m."""
    settings, agent = around.settings[0], around.deciding[0]
    if settings.wall_preferred != 0.0:
        return min(around.reach, settings.wall_metres + settings.wall_seconds * agent.preferred)
    speed = max(agent.fastest, agent.preferred)
    if not is_clearly_shorter(agent.vx, agent.vy, speed):
        speed = max(speed, math.hypot(agent.vx, agent.vy))
    if settings.wall_own != 0.0:
        speed = math.sqrt(speed * speed + agent.vx * agent.vx + agent.vy * agent.vy)
    return min(around.reach, settings.wall_metres + settings.wall_seconds * speed)


@inline_kernel
def describe(around: Surroundings, b: int) -> int:
    """Write the record of the agent in row b of the table; return the agent's index.

    Returns -1, and writes nothing, for a disc without a decision: it is not an agent, its choice is
    not needed, or it has arrived.
    """
    disc, settings, agent = around.table[b], around.settings[0], around.deciding[0]
    i = int(disc.index)
    if i < 0 or not around.decides[i] or (disc.wanted_x == 0.0 and disc.wanted_y == 0.0):
        return -1
    traits = around.traits[i]
    agent.px, agent.py = disc.x, disc.y
    agent.vx, agent.vy = disc.vx, disc.vy
    agent.radius, agent.preferred = disc.radius, traits.preferred
    agent.time_step, agent.relaxation = settings.time_step, settings.relaxation
    agent.gx, agent.gy = around.goal[i, 0], around.goal[i, 1]
    agent.pvx, agent.pvy = disc.wanted_x, disc.wanted_y
    agent.max_speed, agent.weight = traits.max_speed, traits.weight
    agent.max_acceleration = traits.max_acceleration
    agent.parity, agent.random = settings.parity, around.random[i]
    agent.descends, agent.floor = 0.0, settings.floor
    agent.fastest = agent.max_speed
    if not is_clearly_shorter(agent.vx, agent.vy, agent.max_speed):
        agent.fastest = max(agent.max_speed, math.hypot(agent.vx, agent.vy))
    agent.asked_x, agent.asked_y, agent.asked_radius = 0.0, 0.0, agent.fastest
    return i
