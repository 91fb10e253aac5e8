"""One tick of the crowd: contact, motion, arrival, entry; everything in place."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from crowdbot.core.crowd.agents import PORTAL
from crowdbot.core.crowd.contact.geometry import is_clearly_shorter
from crowdbot.core.crowd.contact.pedestrian_contact import push_apart
from crowdbot.core.crowd.contact.robot_contact import robot_contacts
from crowdbot.core.crowd.parameters import AgentParameters, WorldParameters
from crowdbot.core.crowd.periodic_boundary import wrap
from crowdbot.core.crowd.portals import entry_fraction, leave, try_to_re_enter, try_to_start
from crowdbot.core.crowd.response.standing import stop_short
from crowdbot.core.crowd.routes import arrive, goal_fraction, next_goal, stays
from crowdbot.core.crowd.state import (
    AGENT_COLUMNS,
    ARRIVALS,
    AT_PORTAL,
    AX,
    AY,
    BESIDE,
    DIR_X,
    DIR_Y,
    FELT_SIZE,
    HEADER_SIZE,
    NOT_YET,
    ON_TRIP,
    PRESENT,
    PUSH_X,
    PUSH_Y,
    ROBOTS,
    TICK,
    TOUCH_COLUMNS,
    TRIP_START,
    TRIPS,
    VX,
    VY,
    WAITING,
    WALKED,
    X,
    Y,
)
from crowdbot.core.support.compile import inline_kernel, kernel
from crowdbot.core.types.arrays import Array, Indices, Mask

#: Slower people do not turn where they are pushed, m/s.
_TURNS_ABOVE = 0.1


@kernel
def tick(
    flat: Array, robots: Array, outlines: Array, numbers: Indices, stiffnesses: Array, discs: Array,
    dt: float,
    ids: Indices, radius: Array, mass: Array, preferred_speed: Array, max_speed: Array,
    start_time: Array, at_goal: Indices, flow: Indices, route: Array, first: Indices,
    entry_order: Indices, heeds_robot: Mask, push: Array, goal_area: Array, pause: Array,
    ahead: Indices, origin: Array, guide: Indices, abreast: Array, stays_at: Mask,
    walls: Array, entrance: Array, out: Array, keep_offset: bool, goal_ahead: bool,
    boundary: Array, goals_wrap: bool, response: Array, dissipation: float,
    goal_key: np.uint64, solids: Array,
    reaction: Array, placed: Array, order: Indices,
) -> None:  # fmt: skip
    """Advance from tick k to k + 1.

    All forces come from the state at k. Those between the robot and people act on both during the
    tick, so that impulses balance exactly.

    Args:
        flat: the crowd's state, changed in place.
        robots, outlines: (R, 8), (R, K, 2) as in `crowdbot.core.crowd.contact.robot_contact`.
        numbers, stiffnesses: of the robots, as in `robot_contacts`.
        discs: (D, 3) x, y, radius of fixed discs that push, m.
        dt: length of the tick, s.
        ids to stays_at: fields of `AgentParameters`.
        walls to solids: fields of `WorldParameters`.
        reaction, placed, order: fields of `Scratch`.
    """
    people = AgentParameters(
        ids, radius, mass, preferred_speed, max_speed, start_time, at_goal, flow, route, first,
        entry_order, heeds_robot, push, goal_area, pause, ahead, origin, guide, abreast, stays_at,
    )  # fmt: skip
    world = WorldParameters(
        walls, entrance, out, keep_offset, goal_ahead, boundary, goals_wrap, response, dissipation,
        goal_key, solids,
    )  # fmt: skip
    count = radius.shape[0]
    end = HEADER_SIZE + count * AGENT_COLUMNS
    header, agents = flat[:HEADER_SIZE], flat[HEADER_SIZE:end].reshape(count, AGENT_COLUMNS)
    contacts = flat[end:].reshape(int(header[ROBOTS]), FELT_SIZE + count * TOUCH_COLUMNS)
    now = header[TICK] * dt
    push_apart(agents, radius, order, walls, discs, push, placed)
    robot_contacts(
        contacts, agents, radius, robots, outlines, numbers, stiffnesses, dissipation, now, dt,
        reaction,
    )  # fmt: skip
    for i in range(agents.shape[0]):
        if agents[i, WAITING] == PRESENT:
            _advance(header, agents, i, people, world, robots, outlines, reaction, now, dt)
    for i in entry_order:
        if agents[i, WAITING] == AT_PORTAL:
            try_to_re_enter(agents, i, people, world, robots, discs, now + dt)
        elif agents[i, WAITING] == NOT_YET and start_time[i] <= now + dt:
            try_to_start(agents, i, people, world, robots, discs, now + dt)
    header[TICK] += 1.0


@inline_kernel
def _advance(
    header: Array,
    agents: Array,
    i: int,
    people: AgentParameters,
    world: WorldParameters,
    robots: Array,
    outlines: Array,
    reaction: Array,
    now: float,
    dt: float,
) -> None:
    """Move agent i, and let it arrive, leave or wrap."""
    x, y, arrivals = agents[i, X], agents[i, Y], agents[i, ARRIVALS]
    ax, ay = 0.0, 0.0
    if agents[i, BESIDE] != 0.0:
        ax, ay = stop_short(agents, i, people.radius, robots, outlines, world.response)
    ax += agents[i, PUSH_X] + reaction[i, 0] / people.mass[i]
    ay += agents[i, PUSH_Y] + reaction[i, 1] / people.mass[i]
    _move(agents, i, people.max_speed[i], ax, ay, dt)
    if people.at_goal[i] == PORTAL:
        _through(agents, i, x, y, world.out[people.flow[i]], now, dt)
    elif agents[i, ON_TRIP] != 0.0:
        _along(agents, i, x, y, people, world.goal_key, now, dt)
    elif people.stays[i] and not stays(agents, i, people, now):
        next_goal(agents, i, people, world.goal_key, now)
    if agents[i, WAITING] == PRESENT:
        wrap(agents, i, world.boundary, world.goals_wrap)
    header[TRIPS] += agents[i, ARRIVALS] - arrivals


@kernel
def ticks_without_robots(count: int, flat: Array, *rest: Any) -> int:
    """Several times `tick`; ends early after one in which somebody's trip ends.

    Args:
        count: how many ticks at most.
        flat, rest: as of `tick`, without robots.

    Returns:
        how many ticks it were.
    """
    trips = flat[TRIPS]
    for done in range(count):
        tick(flat, *rest)
        if flat[TRIPS] != trips:
            return done + 1
    return count


@kernel
def _through(agents: Array, i: int, x: float, y: float, out: Array, now: float, dt: float) -> None:
    """Agent i, which was at (x, y), leaves if it has entered its out-portal."""
    fraction = entry_fraction(out, x, y, agents[i, X], agents[i, Y])
    if fraction <= 1.0:
        leave(agents, i, now + fraction * dt)


@kernel
def _along(
    agents: Array,
    i: int,
    x: float,
    y: float,
    people: AgentParameters,
    key: np.uint64,
    now: float,
    dt: float,
) -> None:
    """Agent i, which was at (x, y), goes on to its next goal if it has reached this one."""
    fraction = goal_fraction(agents, i, x, y, people)
    if fraction <= 1.0:
        arrive(agents, i, people, key, max(now + fraction * dt, agents[i, TRIP_START]))


@kernel
def _move(agents: Array, i: int, fastest: float, ax: float, ay: float, dt: float) -> None:
    """The desired acceleration reaches at most the largest speed; pushes (ax, ay) may exceed it."""
    vx = agents[i, VX] + agents[i, AX] * dt
    vy = agents[i, VY] + agents[i, AY] * dt
    if not is_clearly_shorter(vx, vy, fastest):
        speed = math.hypot(vx, vy)
        if speed > fastest:
            vx, vy = vx / speed * fastest, vy / speed * fastest
    agents[i, VX], agents[i, VY] = vx + ax * dt, vy + ay * dt
    agents[i, X] += agents[i, VX] * dt
    agents[i, Y] += agents[i, VY] * dt
    speed = math.hypot(agents[i, VX], agents[i, VY])
    agents[i, WALKED] += speed * dt
    if speed > _TURNS_ABOVE:
        agents[i, DIR_X], agents[i, DIR_Y] = agents[i, VX] / speed, agents[i, VY] / speed
