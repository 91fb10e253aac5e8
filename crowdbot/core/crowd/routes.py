"""Routes: the goals of a trip, what happens when one is reached."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from crowdbot.core.crowd.agents import LOOP, ONWARD, REMOVE, RETURN
from crowdbot.core.crowd.goal_areas import area_fraction, into_area, point_in_area
from crowdbot.core.crowd.parameters import AgentParameters
from crowdbot.core.crowd.state import (
    ARRIVALS,
    ARRIVED,
    AT_PORTAL,
    ATTEMPT,
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
from crowdbot.core.crowd.velocity_search import counter_rng
from crowdbot.core.support.compile import kernel
from crowdbot.core.types.arrays import Array

Rows = NDArray[np.int64]


@kernel
def head_for(agents: Array, i: int, people: AgentParameters, key: np.uint64) -> None:
    """Set the goal of agent i to the next point of its route; to where it is without one.

    In an area every agent has a point of its own; members of a group go to points beside each
    other.
    """
    route, first = people.route, people.first
    row = first[i] + int(agents[i, WAYPOINT])
    if row < first[i + 1]:
        x, y = route[row, 0], route[row, 1]
        if people.goal_area[row, 0] > 0.0:
            x, y = _own_point(agents, i, row, people, key)
        agents[i, GOAL_X] = x + agents[i, LAP_X]
        agents[i, GOAL_Y] = y + agents[i, LAP_Y]
    elif first[i] == first[i + 1]:
        agents[i, GOAL_X], agents[i, GOAL_Y] = agents[i, X], agents[i, Y]


@kernel
def _own_point(
    agents: Array, i: int, row: int, people: AgentParameters, key: np.uint64
) -> tuple[float, float]:
    """The point of the area around a goal that agent i goes to."""
    trip, guide, radius = int(agents[i, TRIP]), people.guide[i], people.radius[i]
    u = counter_rng.uniform(key, guide, trip, counter_rng.GOAL, 0)
    v = counter_rng.uniform(key, guide, trip, counter_rng.GOAL, 1)
    cx, cy = people.route[row, 0], people.route[row, 1]
    size = people.goal_area[row]
    x, y = point_in_area(cx, cy, size, radius, u, v)
    if people.abreast[i] == 0.0:
        return x, y
    dx = x + agents[i, LAP_X] - agents[i, X]
    dy = y + agents[i, LAP_Y] - agents[i, Y]
    distance = math.hypot(dx, dy)
    if distance == 0.0:
        return x, y
    x -= dy / distance * people.abreast[i]
    y += dx / distance * people.abreast[i]
    return into_area(x, y, cx, cy, size, radius)


@kernel
def goal_fraction(agents: Array, i: int, x: float, y: float, people: AgentParameters) -> float:
    """Fraction of the way from (x, y) at which agent i has reached its goal; above 1 if not."""
    x1, y1 = agents[i, X], agents[i, Y]
    fraction = reach_fraction(x, y, x1, y1, agents[i, GOAL_X], agents[i, GOAL_Y], people.radius[i])
    row = people.first[i] + int(agents[i, WAYPOINT])
    if fraction <= 1.0 or people.goal_area[row, 0] <= 0.0:
        return fraction
    cx, cy = people.route[row, 0] + agents[i, LAP_X], people.route[row, 1] + agents[i, LAP_Y]
    size = people.goal_area[row]
    return area_fraction(x, y, x1, y1, cx, cy, size)


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
def arrive(agents: Array, i: int, people: AgentParameters, key: np.uint64, when: float) -> None:
    """Agent i has reached its goal: it stays a while, or goes on."""
    end_trip(agents, i, when)
    row = people.first[i] + int(agents[i, WAYPOINT])
    if people.pause[row] == 0.0 and people.ahead[i] < 0:
        next_goal(agents, i, people, key, when)


@kernel
def stays(agents: Array, i: int, people: AgentParameters, now: float) -> bool:
    """Whether agent i, which is on no trip, has reason to stay where it is.

    In a queue, who is not at its head stays until the place before it is left.
    """
    row, end = people.first[i] + int(agents[i, WAYPOINT]), people.first[i + 1]
    if row >= end or now - agents[i, ARRIVED] < people.pause[row]:
        return True
    j = people.ahead[i]
    if j < 0 or end - row <= 2 or agents[j, WAITING] == GONE:
        return False
    left = people.first[j + 1] - people.first[j] - int(agents[j, WAYPOINT])
    return bool(left > end - row - 2)


@kernel
def next_goal(agents: Array, i: int, people: AgentParameters, key: np.uint64, when: float) -> None:
    """After an arrival: on to the next point, or what the agent does at the end of its route."""
    route, first, at_goal = people.route, people.first, people.at_goal[i]
    if at_goal == ONWARD:
        agents[i, GOAL_X] += route[first[i] + 1, 0] - route[first[i], 0]
        agents[i, GOAL_Y] += route[first[i] + 1, 1] - route[first[i], 1]
        agents[i, TRIP] += 1.0
        start_trip(agents, i, when)
        return
    agents[i, WAYPOINT] += 1.0
    if first[i] + int(agents[i, WAYPOINT]) >= first[i + 1]:
        if at_goal == REMOVE:
            agents[i, WAITING] = GONE
            return
        if at_goal == RETURN:
            agents[i, WAITING], agents[i, ATTEMPT] = AT_PORTAL, 0.0
            return
        if at_goal != LOOP or _all_here(agents, i, route, first, people.radius[i]):
            return
        # Each lap is walked on the floor as it is drawn, whatever borders were crossed before.
        agents[i, WAYPOINT] = agents[i, LAP_X] = agents[i, LAP_Y] = 0.0
    agents[i, TRIP] += 1.0
    head_for(agents, i, people, key)
    start_trip(agents, i, when)


@kernel
def _all_here(agents: Array, i: int, route: Array, first: Rows, radius: float) -> bool:
    """Whether a lap would be over before it begins."""
    for row in range(first[i], first[i + 1]):
        if math.hypot(route[row, 0] - agents[i, X], route[row, 1] - agents[i, Y]) > radius:
            return False
    return True
