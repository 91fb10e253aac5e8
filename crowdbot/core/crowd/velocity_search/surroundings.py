"""What surrounds everybody at one decision, in the form that compiled loops take.

Numba needs some 3 us to unpack a named tuple that comes from Python, and none for one that
compiled code packs. So the loops over agents (in `sampling`, `gradient`, `optimum`, `evaluate`)
take the fields of `Surroundings` one by one, in this order, and pack them before anything else.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from crowdbot.core.crowd.contact.geometry import is_clearly_shorter
from crowdbot.core.crowd.velocity_search.cost import (
    ASKED_RADIUS,
    ASKED_X,
    ASKED_Y,
    DESCENDS,
    FASTEST,
    GX,
    GY,
    MAX_ACCELERATION,
    MAX_SPEED,
    PARITY,
    PREFERRED,
    PVX,
    PVY,
    PX,
    PY,
    RADIUS,
    RANDOM,
    RELAXATION,
    TIME_STEP,
    VX,
    VY,
    WEIGHT,
)
from crowdbot.core.crowd.velocity_search.neighbour_discs import write_discs
from crowdbot.core.crowd.velocity_search.neighbours import (
    DISC_RADIUS,
    INDEX,
    WANTED_X,
    WANTED_Y,
    Starts,
    X,
    Y,
    sort_discs,
    strip_height,
)
from crowdbot.core.crowd.velocity_search.neighbours import VX as DISC_VX
from crowdbot.core.crowd.velocity_search.neighbours import VY as DISC_VY
from crowdbot.core.support.compile import array_kernel, inline_kernel
from crowdbot.core.types.arrays import Array, Mask

# Columns of `Surroundings.traits`; entries of `Surroundings.settings`.
T_PREFERRED, T_MAX_SPEED, T_MAX_ACCELERATION, T_WEIGHT = range(4)
S_DT, S_RELAXATION, S_PARITY = range(3)


class Surroundings(NamedTuple):
    """Everybody and everything at one decision.

    Attributes:
        table: (B, `DISC_COLUMNS`) all discs, as `neighbours.sort_discs` sorts them into strips.
        starts: (strips + 1, 2) of the same function.
        low, height: lower border of the first strip, and height of a strip, m.
        who: (N,) whose choice is wanted.
        goal: (N, 2), m.
        walls: (S, 4) both ends of segments, m.
        reach: largest centre distance at which a neighbour may count, m.
        traits: (N, 4) preferred speed, largest speed and acceleration, weight; see ``T_...``.
        settings: (3,) time between decisions and relaxation time (s), 1 for parity; ``S_...``.
        random: (N,) states of the agents' random numbers, changed in place.
        near, found: (>= B, `NEAR_COLUMNS`), (>= S, `WALL_COLUMNS`) scratch for one agent's
            neighbours.
        agent: (`AGENT_SIZE`,) scratch: the agent that is decided for.
    """

    table: Array
    starts: Starts
    low: float
    height: float
    who: Mask
    goal: Array
    walls: Array
    reach: float
    traits: Array
    settings: Array
    random: Array
    near: Array
    found: Array
    agent: Array


@array_kernel
def sort_surroundings(
    position: Array, velocity: Array, goal: Array, radius: Array, preferred: Array, present: Mask,
    robots: Array, pillars: Array, box: Array, diagonal: bool, reach: float,
    discs: Array, table: Array,
) -> tuple[int, float, float, Starts]:  # fmt: skip
    """Write all discs to ``table``, sorted into strips.

    Args:
        position to discs: as of `neighbour_discs.write_discs`.
        table: as ``discs``.

    Returns:
        how many discs there are, the strips' height, and what `neighbours.sort_discs` returns.
    """
    count = write_discs(
        position, velocity, goal, radius, preferred, present, robots, pillars, box, diagonal, reach,
        discs,
    )  # fmt: skip
    height = strip_height(discs, count, reach)
    low, starts = sort_discs(discs, count, height, table)
    return count, height, low, starts


@inline_kernel
def describe(around: Surroundings, b: int) -> int:
    """Write the ``agent`` vector of whoever is in row b of the table; return the agent's number.

    Returns -1, and writes nothing, for a disc that decides nothing: it is not an agent, its choice
    is not wanted, or it has arrived.
    """
    table, traits, settings, agent = around.table, around.traits, around.settings, around.agent
    i = int(table[b, INDEX])
    if i < 0 or not around.who[i] or (table[b, WANTED_X] == 0.0 and table[b, WANTED_Y] == 0.0):
        return -1
    agent[PX], agent[PY] = table[b, X], table[b, Y]
    agent[VX], agent[VY] = table[b, DISC_VX], table[b, DISC_VY]
    agent[RADIUS], agent[PREFERRED] = table[b, DISC_RADIUS], traits[i, T_PREFERRED]
    agent[TIME_STEP], agent[RELAXATION] = settings[S_DT], settings[S_RELAXATION]
    agent[GX], agent[GY] = around.goal[i, 0], around.goal[i, 1]
    agent[PVX], agent[PVY] = table[b, WANTED_X], table[b, WANTED_Y]
    agent[MAX_SPEED], agent[WEIGHT] = traits[i, T_MAX_SPEED], traits[i, T_WEIGHT]
    agent[MAX_ACCELERATION] = traits[i, T_MAX_ACCELERATION]
    agent[PARITY], agent[RANDOM] = settings[S_PARITY], around.random[i]
    agent[DESCENDS] = 0.0
    agent[FASTEST] = agent[MAX_SPEED]
    if not is_clearly_shorter(agent[VX], agent[VY], agent[MAX_SPEED]):
        agent[FASTEST] = max(agent[MAX_SPEED], math.hypot(agent[VX], agent[VY]))
    agent[ASKED_X], agent[ASKED_Y], agent[ASKED_RADIUS] = 0.0, 0.0, agent[FASTEST]
    return i
