"""One tick of the crowd: contact, motion, arrival, entry; everything in place."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.agents import PORTAL
from crowdbot.core.crowd.contact import keep_off, robot_contact
from crowdbot.core.crowd.geometry import is_clearly_shorter
from crowdbot.core.crowd.portals import enter, entry_fraction, is_free, leave, try_to_re_enter
from crowdbot.core.crowd.push import push_apart
from crowdbot.core.crowd.routes import end_trip, next_goal, reach_fraction
from crowdbot.core.crowd.state import (
    ARRIVALS,
    AT_PORTAL,
    AX,
    AY,
    DIR_X,
    DIR_Y,
    GOAL_X,
    GOAL_Y,
    HEADER_SIZE,
    NOT_YET,
    ON_TRIP,
    PRESENT,
    PUSH_X,
    PUSH_Y,
    TICK,
    TRIP_START,
    TRIPS,
    VX,
    VY,
    WAITING,
    WALKED,
    Array,
    X,
    Y,
)
from crowdbot.core.crowd.torus import wrap
from crowdbot.core.kernel import kernel

Rows = NDArray[np.int64]

#: Slower people do not turn where they are pushed, m/s.
_TURNS_ABOVE = 0.1


@kernel
def tick(
    flat: Array,
    columns: int,
    robots: Array,
    outline: Array,
    dt: float,
    ids: Rows,
    in_turn: Rows,
    radius: Array,
    mass: Array,
    preferred: Array,
    max_speed: Array,
    start_time: Array,
    heeds_robot: NDArray[np.bool_],
    at_goal: Rows,
    flow: Rows,
    route: Array,
    first: Rows,
    entrance: Array,
    out: Array,
    keep_offset: bool,
    torus: Array,
    goals_wrap: bool,
    response: Array,
    stiffness: float,
    dissipation: float,
    walls: Array,
    discs: Array,
    push: Array,
    key: np.uint64,
    reaction: Array,
    placed: Array,
    order: Rows,
) -> None:
    """Advance from tick k to k + 1.

    All forces come from the state at k. Those between the robot and people act on both during the
    tick, so that impulses balance exactly.

    Args:
        flat: the crowd's state, changed in place.
        robots, outline: (R, 8), (K, 2) as in `crowdbot.core.crowd.contact`.
        in_turn: (N,) rows of agents by id: the order in which they enter.
        torus: (4,) x0, x1, y0, y1, infinite where there is no border.
        walls, discs, push, order, placed: what pushes, and how much, as in `push_apart`.
        reaction: (N, 2) scratch.

    Everything else is as in `Agents` and `CrowdWorld`.
    """
    header, agents = flat[:HEADER_SIZE], flat[HEADER_SIZE:].reshape(-1, columns)
    now = header[TICK] * dt
    push_apart(agents, radius, order, walls, discs, push, placed)
    for r in range(robots.shape[0]):
        robot_contact(
            header, agents, radius, robots[r], outline, stiffness, dissipation, now, dt, reaction
        )
    if robots.shape[0] == 0:
        reaction[:] = 0.0
    for i in range(agents.shape[0]):
        if agents[i, WAITING] != PRESENT:
            continue
        x, y, arrivals = agents[i, X], agents[i, Y], agents[i, ARRIVALS]
        ax, ay = keep_off(agents, i, radius, robots, response) if heeds_robot[i] else (0.0, 0.0)
        ax += agents[i, PUSH_X] + reaction[i, 0] / mass[i]
        ay += agents[i, PUSH_Y] + reaction[i, 1] / mass[i]
        _move(agents, i, max_speed[i], ax, ay, dt)
        if at_goal[i] == PORTAL:
            _through(agents, i, x, y, out[flow[i]], now, dt)
        elif agents[i, ON_TRIP] != 0.0:
            _along(agents, i, x, y, at_goal[i], route, first, radius[i], now, dt)
        if agents[i, WAITING] == PRESENT:
            wrap(agents, i, torus, goals_wrap)
        header[TRIPS] += agents[i, ARRIVALS] - arrivals
    for i in in_turn:
        if agents[i, WAITING] == AT_PORTAL:
            f = flow[i]
            try_to_re_enter(
                agents, i, ids, radius, preferred[i], robots, entrance[f], out[f], keep_offset,
                key, now + dt,
            )  # fmt: skip
        elif agents[i, WAITING] == NOT_YET and start_time[i] <= now + dt:
            x, y = agents[i, X], agents[i, Y]
            if is_free(agents, i, radius, robots, x, y):
                on_trip = agents[i, ON_TRIP]
                enter(agents, i, x, y, preferred[i], now + dt)
                agents[i, ON_TRIP] = on_trip
    header[TICK] += 1.0


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
    at_goal: int,
    route: Array,
    first: Rows,
    radius: float,
    now: float,
    dt: float,
) -> None:
    """Agent i, which was at (x, y), goes on to its next goal if it has reached this one."""
    fraction = reach_fraction(
        x, y, agents[i, X], agents[i, Y], agents[i, GOAL_X], agents[i, GOAL_Y], radius
    )
    if fraction <= 1.0:
        when = max(now + fraction * dt, agents[i, TRIP_START])
        end_trip(agents, i, when)
        next_goal(agents, i, at_goal, route, first, radius, when)


@kernel
def _move(agents: Array, i: int, fastest: float, ax: float, ay: float, dt: float) -> None:
    """Own will is limited to the largest speed; pushes (ax, ay) are not."""
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
