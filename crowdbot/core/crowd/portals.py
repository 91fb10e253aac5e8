"""Portals: people who enter the out-portal re-enter the world from the in-portal."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.agents import RETURN
from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.crowd.goal_areas import point_in_area
from crowdbot.core.crowd.parameters import AgentParameters, WorldParameters
from crowdbot.core.crowd.routes import end_trip, head_for, start_trip
from crowdbot.core.crowd.state import (
    AIM,
    AIM_X,
    AIM_Y,
    ARRIVED,
    AT_PORTAL,
    ATTEMPT,
    AX,
    AY,
    GOAL_X,
    GOAL_Y,
    JUMPS,
    LAP_X,
    LAP_Y,
    ON_TRIP,
    PRESENT,
    PUSH_X,
    PUSH_Y,
    TRIP,
    VX,
    VY,
    WAITING,
    WAYPOINT,
    X,
    Y,
)
from crowdbot.core.crowd.velocity_search import counter_rng
from crowdbot.core.support.compile import kernel
from crowdbot.core.types.arrays import Array

#: Nobody re-enters closer to a robot than this, centre to centre, m.
CLEAR_OF_ROBOT = 1.0
#: Who stays farther than this from a box does not enter it by rounding, m.
_CLEAR = 1e-6


@kernel
def point_in(box: Array, margin: float, u: float, v: float) -> tuple[float, float]:
    """The point of a box (x0, x1, y0, y1), shrunk by a margin, at fractions u and v."""
    mx = min(margin, 0.5 * (box[1] - box[0]))
    my = min(margin, 0.5 * (box[3] - box[2]))
    return (
        box[0] + mx + u * (box[1] - box[0] - 2.0 * mx),
        box[2] + my + v * (box[3] - box[2] - 2.0 * my),
    )


@kernel
def entry_fraction(box: Array, x0: float, y0: float, x1: float, y1: float) -> float:
    """Fraction of the way from p0 to p1 at which a box is entered; above 1 if it is not."""
    if max(x0, x1) < box[0] - _CLEAR or min(x0, x1) > box[1] + _CLEAR:
        return 2.0  # nearly always, and divisions are expensive
    enter, leave = 0.0, 1.0
    for start, step, low, high in ((x0, x1 - x0, box[0], box[1]), (y0, y1 - y0, box[2], box[3])):
        if step == 0.0:
            if start < low or start > high:
                return 2.0
            continue
        a, b = (low - start) / step, (high - start) / step
        enter, leave = max(enter, min(a, b)), min(leave, max(a, b))
    return enter if enter <= leave else 2.0


@kernel
def draw_goal(
    agents: Array,
    i: int,
    ids: NDArray[np.int64],
    radius: Array,
    flow: int,
    world: WorldParameters,
    x: float,
    y: float,
) -> None:
    """Set the goal of agent i's current trip: a point of the out-portal, a radius inside.

    With ``world.goal_ahead`` it lies in the out-portal as (x, y), where the trip starts, lies in
    the in-portal, beyond whose sides it counts as on them; or else it is drawn.
    """
    out = world.out[flow]
    if world.goal_ahead:
        u, v = _shares(world.entrance[flow], radius[i], x, y)
    else:
        key, trip = world.goal_key, int(agents[i, TRIP])
        u = counter_rng.uniform(key, ids[i], trip, counter_rng.GOAL, 0)
        v = counter_rng.uniform(key, ids[i], trip, counter_rng.GOAL, 1)
    agents[i, GOAL_X], agents[i, GOAL_Y] = point_in(out, radius[i], u, v)


@kernel
def leave(agents: Array, i: int, when: float) -> None:
    """Take agent i out of the world at the end of its trip; its position is where it left."""
    end_trip(agents, i, when)
    agents[i, WAITING], agents[i, ATTEMPT] = AT_PORTAL, 0.0


@kernel
def _share(at: float, low: float, high: float, margin: float) -> float:
    """Where a coordinate lies between the sides of a box shrunk by a margin, 0 to 1."""
    room = high - low - 2.0 * margin
    return min(1.0, max(0.0, (at - low - margin) / room)) if room > 0.0 else 0.5


@kernel
def _shares(box: Array, margin: float, x: float, y: float) -> tuple[float, float]:
    """Where a point lies between the sides of a box shrunk by a margin, each 0 to 1."""
    return _share(x, box[0], box[1], margin), _share(y, box[2], box[3], margin)


@kernel
def is_free(agents: Array, i: int, radius: Array, robots: Array, x: float, y: float) -> bool:
    """Whether agent i could stand at a point: on nobody, and clear of robots."""
    for r in range(robots.shape[0]):
        if (robots[r, 0] - x) ** 2 + (robots[r, 1] - y) ** 2 < CLEAR_OF_ROBOT**2:
            return False
    for j in range(agents.shape[0]):
        free = radius[i] + radius[j]
        away = (agents[j, X] - x) ** 2 + (agents[j, Y] - y) ** 2
        if j != i and agents[j, WAITING] == PRESENT and away < free * free:
            return False
    return True


@kernel
def is_off_walls(radius: float, world: WorldParameters, discs: Array, x: float, y: float) -> bool:
    """Whether a body at a point touches no wall and no disc (D, 3), and is in no solid."""
    reach = radius - _CLEAR
    for wall in world.walls:
        nx, ny = nearest_on_segment(x, y, wall[0], wall[1], wall[2], wall[3])
        if (nx - x) ** 2 + (ny - y) ** 2 < reach * reach:
            return False
    for disc in discs:
        if (disc[0] - x) ** 2 + (disc[1] - y) ** 2 < (reach + disc[2]) ** 2:
            return False
    within = False
    for k in range(world.solids.shape[0]):
        side = world.solids[k]
        first = k == 0 or world.solids[k - 1, 4] != side[4]
        if first and within:
            return False
        left = (side[2] - side[0]) * (y - side[1]) - (side[3] - side[1]) * (x - side[0]) > 0.0
        within = left and (first or within)
    return not within


@kernel
def enter(agents: Array, i: int, x: float, y: float, preferred: float, now: float) -> None:
    """Put agent i into the world, on the way to its goal at preferred speed."""
    agents[i, WAITING], agents[i, X], agents[i, Y] = PRESENT, x, y
    gx, gy = agents[i, GOAL_X] - x, agents[i, GOAL_Y] - y
    if agents[i, AIM] != 0.0:  # around a corner
        gx, gy = agents[i, AIM_X] - x, agents[i, AIM_Y] - y
    distance = np.hypot(gx, gy)
    pace = preferred / distance if distance > 0.0 else 0.0
    agents[i, VX], agents[i, VY] = pace * gx, pace * gy
    for column in (AX, AY, PUSH_X, PUSH_Y):
        agents[i, column] = 0.0
    start_trip(agents, i, now)


@kernel
def try_to_re_enter(
    agents: Array,
    i: int,
    people: AgentParameters,
    world: WorldParameters,
    robots: Array,
    discs: Array,
    now: float,
) -> None:
    """Try one point of the in-portal; start a new trip there if it is free.

    The point lies in the in-portal as the agent left the out-portal (``world.keep_offset``), or
    is drawn anew in each attempt.
    """
    if people.at_goal[i] == RETURN:
        _try_to_come_back(agents, i, people, world, robots, discs, now)
        return
    flow, radius, key = people.flow[i], people.radius[i], world.goal_key
    trip, attempt = int(agents[i, TRIP]), int(agents[i, ATTEMPT])
    agents[i, ATTEMPT] += 1.0
    if world.keep_offset:
        u, v = _shares(world.out[flow], radius, agents[i, X], agents[i, Y])
    else:
        u = counter_rng.uniform(key, people.id[i], trip, counter_rng.ENTRY, 2 * attempt)
        v = counter_rng.uniform(key, people.id[i], trip, counter_rng.ENTRY, 2 * attempt + 1)
    x, y = point_in(world.entrance[flow], radius, u, v)
    if not is_free(agents, i, people.radius, robots, x, y):
        return
    agents[i, TRIP] = trip + 1.0
    agents[i, JUMPS] += 1.0
    agents[i, AIM] = 0.0
    draw_goal(agents, i, people.id, people.radius, flow, world, x, y)
    enter(agents, i, x, y, people.preferred_speed[i], now)


@kernel
def place_of_entry(
    agents: Array, i: int, people: AgentParameters, key: np.uint64
) -> tuple[float, float]:
    """A point of the area in which agent i comes in, drawn anew in each attempt."""
    trip, attempt = int(agents[i, TRIP]), int(agents[i, ATTEMPT])
    u = counter_rng.uniform(key, people.id[i], trip, counter_rng.ENTRY, 2 * attempt)
    v = counter_rng.uniform(key, people.id[i], trip, counter_rng.ENTRY, 2 * attempt + 1)
    x, y, size = people.origin[i, 0], people.origin[i, 1], people.origin[i, 2:]
    return point_in_area(x, y, size, people.radius[i], u, v)


@kernel
def _try_to_come_back(
    agents: Array, i: int, people: AgentParameters, world: WorldParameters, robots: Array,
    discs: Array, now: float,
) -> None:  # fmt: skip
    """Try one point of the origin; begin the way anew there if it is free."""
    key = world.goal_key
    x, y = place_of_entry(agents, i, people, key)
    agents[i, ATTEMPT] += 1.0
    if not is_free(agents, i, people.radius, robots, x, y):
        return
    if not is_off_walls(people.radius[i], world, discs, x, y):
        return
    agents[i, TRIP] += 1.0
    agents[i, JUMPS] += 1.0
    agents[i, WAYPOINT] = agents[i, LAP_X] = agents[i, LAP_Y] = 0.0
    agents[i, X], agents[i, Y] = x, y
    head_for(agents, i, people, key)
    enter(agents, i, x, y, people.preferred_speed[i], now)


@kernel
def try_to_start(
    agents: Array, i: int, people: AgentParameters, world: WorldParameters, robots: Array,
    discs: Array, now: float,
) -> None:  # fmt: skip
    """Put agent i into the world where it starts, if nobody stands there.

    Who has an origin tries another point of it next time.
    """
    x, y = agents[i, X], agents[i, Y]
    choice = people.origin[i, 2] > 0.0
    if choice and agents[i, ATTEMPT] > 0.0:
        x, y = place_of_entry(agents, i, people, world.goal_key)
    free = is_free(agents, i, people.radius, robots, x, y)
    if not free or (choice and not is_off_walls(people.radius[i], world, discs, x, y)):
        agents[i, ATTEMPT] += 1.0 if choice else 0.0
        return
    on_trip = agents[i, ON_TRIP]
    enter(agents, i, x, y, people.preferred_speed[i], now)
    agents[i, ON_TRIP] = on_trip
    if people.stays[i] and on_trip == 0.0:
        agents[i, ARRIVED] = now
