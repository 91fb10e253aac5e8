"""Portals: people who reach the out-portal enter the world again at the in-portal."""

from __future__ import annotations

import numpy as np

from crowdbot.core.crowd.agents import RETURN
from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.crowd.contact.robot_contact import RobotRecord
from crowdbot.core.crowd.goal_areas import point_in_area
from crowdbot.core.crowd.parameters import AgentParameters, WorldParameters
from crowdbot.core.crowd.routes import end_trip, head_for, start_trip
from crowdbot.core.crowd.state import (
    AT_PORTAL,
    PRESENT,
    People,
)
from crowdbot.core.crowd.velocity_search import counter_rng
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import Rows
from crowdbot.core.types.arrays import Array

#: No person re-enters closer to a robot than this, centre to centre, m.
CLEAR_OF_ROBOT = 1.0
#: A person farther than this from a box does not enter it by rounding, m.
_CLEAR = 1e-6


@kernel
def point_in(box: Array, margin: float, u: float, v: float) -> tuple[float, float]:
    """Return the point of a shrunk box (x0, x1, y0, y1) at fractions u and v."""
    mx = min(margin, 0.5 * (box[1] - box[0]))
    my = min(margin, 0.5 * (box[3] - box[2]))
    return (
        box[0] + mx + u * (box[1] - box[0] - 2.0 * mx),
        box[2] + my + v * (box[3] - box[2] - 2.0 * my),
    )


@kernel
def entry_fraction(box: Array, x0: float, y0: float, x1: float, y1: float) -> float:
    """Return the fraction of the way from p0 to p1 at which a box is entered; above 1 if never."""
    if max(x0, x1) < box[0] - _CLEAR or min(x0, x1) > box[1] + _CLEAR:
        return 2.0  # the usual case; divisions are expensive
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
    agents: People,
    i: int,
    people: AgentParameters,
    world: WorldParameters,
    x: float,
    y: float,
) -> None:
    """Set agent i's goal for the current trip: a point of the out-portal, one radius inside.

    With `RulesRecord.goal_ahead` it has the same relative position in the out-portal as the start
    (x, y) in the in-portal, clamped to its sides; otherwise it is drawn.
    """
    traits = people.traits[i]
    flow, radius = int(traits.flow), traits.radius
    out = world.out[flow]
    if world.rules[0].goal_ahead != 0.0:
        u, v = _shares(world.entrance[flow], radius, x, y)
    else:
        key, number, trip = world.goal_key, int(traits.id), int(agents[i].trip)
        u = counter_rng.uniform(key, number, trip, counter_rng.GOAL, 0)
        v = counter_rng.uniform(key, number, trip, counter_rng.GOAL, 1)
    agents[i].goal_x, agents[i].goal_y = point_in(out, radius, u, v)


@kernel
def leave(agents: People, i: int, when: float) -> None:
    """Remove agent i from the world at the end of its trip, keeping its last position."""
    end_trip(agents, i, when)
    agents[i].waiting, agents[i].attempt = AT_PORTAL, 0.0


@kernel
def _share(at: float, low: float, high: float, margin: float) -> float:
    """Return the place of a coordinate between the sides of a box shrunk by a margin, 0 to 1."""
    room = high - low - 2.0 * margin
    return min(1.0, max(0.0, (at - low - margin) / room)) if room > 0.0 else 0.5


@kernel
def _shares(box: Array, margin: float, x: float, y: float) -> tuple[float, float]:
    """Return the place of a point between the sides of a box shrunk by a margin, each 0 to 1."""
    return _share(x, box[0], box[1], margin), _share(y, box[2], box[3], margin)


@kernel
def is_free(
    agents: People,
    i: int,
    people: AgentParameters,
    robots: Rows[RobotRecord],
    x: float,
    y: float,
) -> bool:
    """Return True if agent i would overlap no other agent and no robot at a point."""
    for r in range(robots.shape[0]):
        if (robots[r].x - x) ** 2 + (robots[r].y - y) ** 2 < CLEAR_OF_ROBOT**2:
            return False
    for j in range(agents.shape[0]):
        free = people.traits[i].radius + people.traits[j].radius
        away = (agents[j].x - x) ** 2 + (agents[j].y - y) ** 2
        if j != i and agents[j].waiting == PRESENT and away < free * free:
            return False
    return True


@kernel
def is_off_walls(radius: float, world: WorldParameters, discs: Array, x: float, y: float) -> bool:
    """Return True if a body at a point touches no wall and no disc (D, 3), and is in no solid."""
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
def enter(agents: People, i: int, x: float, y: float, preferred: float, now: float) -> None:
    """Put agent i into the world, walking to its goal at preferred speed."""
    agents[i].waiting, agents[i].x, agents[i].y = PRESENT, x, y
    gx, gy = agents[i].goal_x - x, agents[i].goal_y - y
    if agents[i].corner != 0.0:  # around a corner
        gx, gy = agents[i].waypoint_x - x, agents[i].waypoint_y - y
    distance = np.hypot(gx, gy)
    pace = preferred / distance if distance > 0.0 else 0.0
    agents[i].vx, agents[i].vy = pace * gx, pace * gy
    agents[i].ax = agents[i].ay = agents[i].push_x = agents[i].push_y = 0.0
    start_trip(agents, i, now)


@kernel
def try_to_re_enter(
    agents: People,
    i: int,
    people: AgentParameters,
    world: WorldParameters,
    robots: Rows[RobotRecord],
    discs: Array,
    now: float,
) -> None:
    """Try one point of the in-portal; start a new trip there if it is free.

    With `RulesRecord.keep_offset` it has the same relative position as where the agent left the
    out-portal, unless something solid stands there; otherwise it is drawn again in each attempt.
    """
    traits = people.traits[i]
    if traits.at_goal == RETURN:
        _try_to_come_back(agents, i, people, world, robots, discs, now)
        return
    flow, radius, key, number = int(traits.flow), traits.radius, world.goal_key, int(traits.id)
    trip, attempt = int(agents[i].trip), int(agents[i].attempt)
    agents[i].attempt += 1.0
    pillars = discs[: int(world.rules[0].pillars)]
    u = counter_rng.uniform(key, number, trip, counter_rng.ENTRY, 2 * attempt)
    v = counter_rng.uniform(key, number, trip, counter_rng.ENTRY, 2 * attempt + 1)
    x, y = point_in(world.entrance[flow], radius, u, v)
    if world.rules[0].keep_offset != 0.0:
        u, v = _shares(world.out[flow], radius, agents[i].x, agents[i].y)
        ox, oy = point_in(world.entrance[flow], radius, u, v)
        if traits.limit == 0.0 or is_off_walls(traits.limit, world, pillars, ox, oy):
            x, y = ox, oy
    if not is_free(agents, i, people, robots, x, y):
        return
    if traits.limit > 0.0 and not is_off_walls(traits.limit, world, pillars, x, y):
        return
    agents[i].trip = trip + 1.0
    agents[i].jumps += 1.0
    agents[i].corner = 0.0
    draw_goal(agents, i, people, world, x, y)
    enter(agents, i, x, y, traits.preferred_speed, now)


@kernel
def place_of_entry(
    agents: People, i: int, people: AgentParameters, key: np.uint64
) -> tuple[float, float]:
    """Return a point of the area in which agent i enters, drawn again in each attempt."""
    trip, attempt = int(agents[i].trip), int(agents[i].attempt)
    traits, origin = people.traits[i], people.origin[i]
    u = counter_rng.uniform(key, int(traits.id), trip, counter_rng.ENTRY, 2 * attempt)
    v = counter_rng.uniform(key, int(traits.id), trip, counter_rng.ENTRY, 2 * attempt + 1)
    return point_in_area(origin.x, origin.y, origin, traits.radius, u, v)


@kernel
def _try_to_come_back(
    agents: People, i: int, people: AgentParameters, world: WorldParameters,
    robots: Rows[RobotRecord],
    discs: Array, now: float,
) -> None:  # fmt: skip
    """Try one point of the origin; restart the route there if it is free."""
    key = world.goal_key
    x, y = place_of_entry(agents, i, people, key)
    agents[i].attempt += 1.0
    if not is_free(agents, i, people, robots, x, y):
        return
    if not is_off_walls(people.traits[i].radius, world, discs, x, y):
        return
    agents[i].trip += 1.0
    agents[i].jumps += 1.0
    agents[i].route_point = agents[i].lap_x = agents[i].lap_y = 0.0
    agents[i].x, agents[i].y = x, y
    head_for(agents, i, people, key)
    enter(agents, i, x, y, people.traits[i].preferred_speed, now)


@kernel
def try_to_start(
    agents: People, i: int, people: AgentParameters, world: WorldParameters,
    robots: Rows[RobotRecord],
    discs: Array, now: float,
) -> None:  # fmt: skip
    """Put agent i into the world at its start, if it is free.

    An agent with an entrance area tries another point of it next time.
    """
    x, y = agents[i].x, agents[i].y
    choice = people.traits[i].chooses_origin != 0.0
    if choice and agents[i].attempt > 0.0:
        x, y = place_of_entry(agents, i, people, world.goal_key)
    free = is_free(agents, i, people, robots, x, y)
    if not free or (choice and not is_off_walls(people.traits[i].radius, world, discs, x, y)):
        agents[i].attempt += 1.0 if choice else 0.0
        return
    on_trip = agents[i].on_trip
    enter(agents, i, x, y, people.traits[i].preferred_speed, now)
    agents[i].on_trip = on_trip
    if people.traits[i].stays != 0.0 and on_trip == 0.0:
        agents[i].arrived = now
