"""One tick of the crowd: contact, motion, arrival, re-entry; everything in place."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from crowdbot.core.crowd.contact import keep_off, robot_contact
from crowdbot.core.crowd.portals import entry_fraction, leave, try_to_enter
from crowdbot.core.crowd.state import (
    AX,
    AY,
    DIR_X,
    DIR_Y,
    HEADER_SIZE,
    PUSH_X,
    PUSH_Y,
    TICK,
    TRIPS,
    VX,
    VY,
    WAITING,
    WALKED,
    Array,
    X,
    Y,
)

#: Slower people do not turn where they are pushed, m/s.
_TURNS_ABOVE = 0.1


@njit(cache=True, error_model="numpy")
def tick(
    flat: Array,
    columns: int,
    robots: Array,
    ids: NDArray[np.int64],
    radius: Array,
    mass: Array,
    preferred: Array,
    max_speed: Array,
    entrance: Array,
    out: Array,
    response: Array,
    stiffness: float,
    dissipation: float,
    key: np.uint64,
    dt: float,
    reaction: Array,
) -> None:
    """Advance from tick k to k + 1.

    Forces between the robot and people come from the state at k; they act on both during the
    tick, so that impulses balance exactly.

    Args:
        flat: the crowd's state, changed in place.
        robots: (R, 6) as in `crowdbot.core.crowd.contact`.
        entrance, out: (4,) boxes x0, x1, y0, y1.
        reaction: (N, 2) scratch.
    """
    header, agents = flat[:HEADER_SIZE], flat[HEADER_SIZE:].reshape(-1, columns)
    now = header[TICK] * dt
    for r in range(robots.shape[0]):
        robot_contact(header, agents, radius, robots[r], stiffness, dissipation, now, dt, reaction)
    if robots.shape[0] == 0:
        reaction[:] = 0.0
    for i in range(agents.shape[0]):
        if agents[i, WAITING] != 0.0:
            continue
        x, y = agents[i, X], agents[i, Y]
        ax, ay = keep_off(agents, i, radius, robots, response)
        ax += agents[i, PUSH_X] + reaction[i, 0] / mass[i]
        ay += agents[i, PUSH_Y] + reaction[i, 1] / mass[i]
        _move(agents, i, max_speed[i], ax, ay, dt)
        fraction = entry_fraction(out, x, y, agents[i, X], agents[i, Y])
        if fraction <= 1.0:
            leave(agents, i, now + fraction * dt)
            header[TRIPS] += 1.0
    for i in range(agents.shape[0]):
        if agents[i, WAITING] != 0.0:
            try_to_enter(agents, i, ids, radius, preferred, robots, entrance, out, key, now + dt)
    header[TICK] += 1.0


@njit(cache=True, error_model="numpy")
def _move(agents: Array, i: int, fastest: float, ax: float, ay: float, dt: float) -> None:
    """Own will is limited to the largest speed; pushes (ax, ay) are not."""
    vx = agents[i, VX] + agents[i, AX] * dt
    vy = agents[i, VY] + agents[i, AY] * dt
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
