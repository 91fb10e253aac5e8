"""One tick of the crowd: contact, motion, arrival, entry; all in place."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from crowdbot.core.crowd.agents import PORTAL
from crowdbot.core.crowd.contact.geometry import is_clearly_shorter
from crowdbot.core.crowd.contact.pedestrian_contact import PLACED, push_apart
from crowdbot.core.crowd.contact.robot_contact import ROBOT, RobotRecord, robot_contacts
from crowdbot.core.crowd.contact.solid import keep_out
from crowdbot.core.crowd.goal_areas import PLACE
from crowdbot.core.crowd.parameters import (
    RULES,
    AgentParameters,
    WorldParameters,
)
from crowdbot.core.crowd.periodic_boundary import wrap
from crowdbot.core.crowd.portals import entry_fraction, leave, try_to_re_enter, try_to_start
from crowdbot.core.crowd.response.parameters import TICK_RESPONSE
from crowdbot.core.crowd.response.standing import stop_short
from crowdbot.core.crowd.routes import arrive, goal_fraction, next_goal, stays
from crowdbot.core.crowd.state import (
    AGENT_COLUMNS,
    AT_PORTAL,
    HEADER,
    HEADER_SIZE,
    NOT_YET,
    PERSON,
    PRESENT,
    HeaderRecord,
    People,
)
from crowdbot.core.crowd.traits import TRAITS
from crowdbot.core.support.compiling.compile import inline_kernel, kernel
from crowdbot.core.support.records import Rows, as_record, as_rows
from crowdbot.core.types.arrays import Array, Indices

#: Slower people do not turn when pushed, m/s.
_TURNS_ABOVE = 0.1


@kernel
def tick(
    flat: Array, robots: Array, outlines: Array, numbers: Indices, stiffnesses: Array, discs: Array,
    dt: float,
    traits: Array, route: Array, origin: Array, entry_order: Indices,
    walls: Array, entrance: Array, out: Array, boundary: Array, rules: Array, response: Array,
    goal_key: np.uint64, solids: Array, frame: Array, first: Indices, near: Indices,
    reaction: Array, placed: Array, order: Indices, room: Array,
) -> None:  # fmt: skip
    """Advance from tick k to k + 1.

    All forces depend on the state at k. Forces between robot and people act on both during the
    tick, so that impulses are exactly equal and opposite.

    Args:
        flat: the crowd's state, changed in place.
        robots, outlines: (R, 8), (R, K, 2) as in `crowdbot.core.crowd.contact.robot_contact`.
        numbers, stiffnesses: data of the robots, as in `robot_contacts`.
        discs: (D, 3) x, y, radius of fixed discs that push, m.
        dt: length of the tick, s.
        traits to entry_order: fields of `AgentParameters`, as numbers.
        walls to near: fields of `WorldParameters`, as numbers.
        reaction to room: fields of `Scratch`, as numbers.
    """
    people = AgentParameters(
        as_rows(traits, TRAITS), as_rows(route, PLACE), as_rows(origin, PLACE), entry_order
    )
    world = WorldParameters(
        walls, entrance, out, boundary, as_rows(rules, RULES), as_rows(response, TICK_RESPONSE),
        goal_key, solids, frame, first, near,
    )  # fmt: skip
    count = people.traits.shape[0]
    end = HEADER_SIZE + count * AGENT_COLUMNS
    header, agents = as_record(flat, HEADER), as_rows(flat[HEADER_SIZE:end], PERSON)
    machines = as_rows(robots, ROBOT)
    now = header.tick * dt
    push_apart(
        agents, people.traits, order, walls, frame, first, near, discs,
        int(world.rules[0].pillars), world.rules[0].body_dissipation, as_rows(placed, PLACED), room,
    )  # fmt: skip
    robot_contacts(
        flat[end:], agents, people.traits, machines, outlines, numbers, stiffnesses,
        world.rules[0].dissipation, now, dt, reaction,
    )  # fmt: skip
    for i in range(agents.shape[0]):
        if agents[i].waiting == PRESENT:
            _advance(
                header, agents, i, people, world, machines, outlines, reaction, discs, room[i],
                now, dt,
            )  # fmt: skip
    for i in entry_order:
        if agents[i].waiting == AT_PORTAL:
            try_to_re_enter(agents, i, people, world, machines, discs, now + dt)
        elif agents[i].waiting == NOT_YET and people.traits[i].start_time <= now + dt:
            try_to_start(agents, i, people, world, machines, discs, now + dt)
    header.tick += 1.0


@inline_kernel
def _advance(
    header: HeaderRecord,
    agents: People,
    i: int,
    people: AgentParameters,
    world: WorldParameters,
    robots: Rows[RobotRecord],
    outlines: Array,
    reaction: Array,
    discs: Array,
    room: float,
    now: float,
    dt: float,
) -> None:
    """Move agent i, and let it arrive, leave or wrap.

    Args:
        room: distance of its centre from what is solid, at least its radius if it touches nothing.
    """
    x, y, arrivals = agents[i].x, agents[i].y, agents[i].arrivals
    traits, ax, ay = people.traits[i], 0.0, 0.0
    if agents[i].beside != 0.0:
        ax, ay = stop_short(agents, i, traits.radius, robots, outlines, world.response[0])
    ax += agents[i].push_x + reaction[i, 0] / traits.mass
    ay += agents[i].push_y + reaction[i, 1] / traits.mass
    speed = _move(agents, i, traits.max_speed, ax, ay, dt)
    if min(room, traits.radius) < traits.limit + speed * dt and traits.limit > 0.0:
        keep_out(
            agents, i, x, y, traits.limit, world.walls, world.frame, world.first, world.near,
            discs, int(world.rules[0].pillars),
        )  # fmt: skip
        speed = math.hypot(agents[i].vx, agents[i].vy)
    _look_ahead(agents, i, speed, dt)
    if traits.at_goal == PORTAL:
        _through(agents, i, x, y, world.out[int(traits.flow)], now, dt)
    elif agents[i].on_trip != 0.0:
        _along(agents, i, x, y, people, world.goal_key, now, dt)
    elif traits.stays != 0.0 and not stays(agents, i, people, now):
        next_goal(agents, i, people, world.goal_key, now)
    if agents[i].waiting == PRESENT:
        wrap(agents, i, world.boundary, world.rules[0].goals_wrap != 0.0)
    header.trips += agents[i].arrivals - arrivals


@kernel
def ticks_without_robots(count: int, flat: Array, *rest: Any) -> int:
    """Call `tick` several times; stop early after one in which a trip ends.

    Args:
        count: largest number of ticks.
        flat, rest: as in `tick`, without robots.

    Returns:
        number of ticks advanced.
    """
    header = as_record(flat, HEADER)
    trips = header.trips
    for done in range(count):
        tick(flat, *rest)
        if header.trips != trips:
            return done + 1
    return count


@kernel
def _through(agents: People, i: int, x: float, y: float, out: Array, now: float, dt: float) -> None:
    """Let agent i, which was at (x, y), leave if it has entered its out-portal."""
    fraction = entry_fraction(out, x, y, agents[i].x, agents[i].y)
    if fraction <= 1.0:
        leave(agents, i, now + fraction * dt)


@kernel
def _along(
    agents: People,
    i: int,
    x: float,
    y: float,
    people: AgentParameters,
    key: np.uint64,
    now: float,
    dt: float,
) -> None:
    """Let agent i, which was at (x, y), go to its next goal if it has reached this one."""
    fraction = goal_fraction(agents, i, x, y, people)
    if fraction <= 1.0:
        arrive(agents, i, people, key, max(now + fraction * dt, agents[i].trip_start))


@kernel
def _move(agents: People, i: int, fastest: float, ax: float, ay: float, dt: float) -> float:
    """Apply the desired acceleration up to the largest speed; pushes (ax, ay) may exceed it.

    Returns:
        speed, m/s.
    """
    vx = agents[i].vx + agents[i].ax * dt
    vy = agents[i].vy + agents[i].ay * dt
    if not is_clearly_shorter(vx, vy, fastest):
        speed = math.hypot(vx, vy)
        if speed > fastest:
            vx, vy = vx / speed * fastest, vy / speed * fastest
    agents[i].vx, agents[i].vy = vx + ax * dt, vy + ay * dt
    agents[i].x += agents[i].vx * dt
    agents[i].y += agents[i].vy * dt
    return math.hypot(agents[i].vx, agents[i].vy)


@kernel
def _look_ahead(agents: People, i: int, speed: float, dt: float) -> None:
    """Update the distance that agent i has walked, and its facing direction unless it is slow."""
    agents[i].walked += speed * dt
    if speed > _TURNS_ABOVE:
        agents[i].dir_x, agents[i].dir_y = agents[i].vx / speed, agents[i].vy / speed
