"""Routes: the goals of a trip, what happens when one is reached."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.agents import LOOP, REMOVE
from crowdbot.core.crowd.state import (
    ARRIVALS,
    ARRIVED,
    GOAL_X,
    GOAL_Y,
    GONE,
    LAP_X,
    LAP_Y,
    LAST_START,
    ON_TRIP,
    TRIP,
    TRIP_START,
    WAITING,
    WAYPOINT,
    X,
    Y,
)
from crowdbot.core.support.compile import kernel
from crowdbot.core.types.arrays import Array

Rows = NDArray[np.int64]


@kernel
def head_for(agents: Array, i: int, route: Array, first: Rows) -> None:
    """Set the goal of agent i to the next point of its route; to where it is without one."""
    row = first[i] + int(agents[i, WAYPOINT])
    if row < first[i + 1]:
        agents[i, GOAL_X] = route[row, 0] + agents[i, LAP_X]
        agents[i, GOAL_Y] = route[row, 1] + agents[i, LAP_Y]
    elif first[i] == first[i + 1]:
        agents[i, GOAL_X], agents[i, GOAL_Y] = agents[i, X], agents[i, Y]


@kernel
def reach_fraction(
    x0: float, y0: float, x1: float, y1: float, gx: float, gy: float, radius: float
) -> float:
    """Fraction of the way from p0 to p1 at which g is within ``radius``; above 1 if it is not."""
    px, py, dx, dy = x0 - gx, y0 - gy, x1 - x0, y1 - y0
    c = px * px + py * py - radius * radius
    if c <= 0.0:
        return 0.0
    a, b = dx * dx + dy * dy, px * dx + py * dy
    root = b * b - a * c
    if b >= 0.0 or root < 0.0:
        return 2.0
    return float(c / (math.sqrt(root) - b))


@kernel
def end_trip(agents: Array, i: int, when: float) -> None:
    """Record the arrival of agent i; it is on no trip until it starts another."""
    agents[i, ARRIVED], agents[i, LAST_START] = when, agents[i, TRIP_START]
    agents[i, ARRIVALS] += 1.0
    agents[i, ON_TRIP] = 0.0


@kernel
def start_trip(agents: Array, i: int, when: float) -> None:
    """Let agent i's next trip begin; its goal must be set."""
    agents[i, TRIP_START], agents[i, ON_TRIP] = when, 1.0


@kernel
def next_goal(
    agents: Array, i: int, at_goal: int, route: Array, first: Rows, radius: float, when: float
) -> None:
    """After an arrival: on to the next point, or what the agent does at the end of its route."""
    agents[i, WAYPOINT] += 1.0
    if first[i] + int(agents[i, WAYPOINT]) >= first[i + 1]:
        if at_goal == REMOVE:
            agents[i, WAITING] = GONE
            return
        if at_goal != LOOP or _all_here(agents, i, route, first, radius):
            return
        # Each lap is walked on the floor as it is drawn, whatever borders were crossed before.
        agents[i, WAYPOINT] = agents[i, LAP_X] = agents[i, LAP_Y] = 0.0
    agents[i, TRIP] += 1.0
    head_for(agents, i, route, first)
    start_trip(agents, i, when)


@kernel
def _all_here(agents: Array, i: int, route: Array, first: Rows, radius: float) -> bool:
    """Whether a lap would be over before it begins."""
    for row in range(first[i], first[i + 1]):
        if math.hypot(route[row, 0] - agents[i, X], route[row, 1] - agents[i, Y]) > radius:
            return False
    return True
