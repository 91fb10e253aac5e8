"""Routes: people's goals during a trip, and their behaviour at each goal."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.crowd.agents import LOOP, ONWARD, REMOVE, RETURN
from crowdbot.core.crowd.goal_areas import area_fraction, into_area, point_in_area
from crowdbot.core.crowd.parameters import AgentParameters
from crowdbot.core.crowd.state import (
    AT_PORTAL,
    GONE,
    People,
)
from crowdbot.core.crowd.velocity_search import counter_rng
from crowdbot.core.support.compiling.compile import kernel


@kernel
def head_for(agents: People, i: int, people: AgentParameters, key: np.uint64) -> None:
    """Set the goal of agent i to the next point of its route, or its position without one.

    Each agent has its own point in an area; members of a group go to points side by side.
    """
    traits = people.traits[i]
    row = int(traits.first) + int(agents[i].route_point)
    if row < traits.end:
        x, y = people.route[row].x, people.route[row].y
        if people.route[row].width > 0.0:
            x, y = _own_point(agents, i, row, people, key)
        agents[i].goal_x = x + agents[i].lap_x
        agents[i].goal_y = y + agents[i].lap_y
    elif traits.first == traits.end:
        agents[i].goal_x, agents[i].goal_y = agents[i].x, agents[i].y


@kernel
def _own_point(
    agents: People, i: int, row: int, people: AgentParameters, key: np.uint64
) -> tuple[float, float]:
    """Return agent i's point in the area around a goal."""
    traits, place = people.traits[i], people.route[row]
    trip, guide, radius = int(agents[i].trip), int(traits.guide), traits.radius
    u = counter_rng.uniform(key, guide, trip, counter_rng.GOAL, 0)
    v = counter_rng.uniform(key, guide, trip, counter_rng.GOAL, 1)
    x, y = point_in_area(place.x, place.y, place, radius, u, v)
    if traits.abreast == 0.0:
        return x, y
    dx = x + agents[i].lap_x - agents[i].x
    dy = y + agents[i].lap_y - agents[i].y
    distance = math.hypot(dx, dy)
    if distance == 0.0:
        return x, y
    x -= dy / distance * traits.abreast
    y += dx / distance * traits.abreast
    return into_area(x, y, place.x, place.y, place, radius)


@kernel
def goal_fraction(agents: People, i: int, x: float, y: float, people: AgentParameters) -> float:
    """Return the fraction of the way from (x, y) at which agent i reached its goal.

    Above 1 if not.
    """
    traits, x1, y1 = people.traits[i], agents[i].x, agents[i].y
    fraction = reach_fraction(x, y, x1, y1, agents[i].goal_x, agents[i].goal_y, traits.radius)
    place = people.route[int(traits.first) + int(agents[i].route_point)]
    if fraction <= 1.0 or place.width <= 0.0:
        return fraction
    cx, cy = place.x + agents[i].lap_x, place.y + agents[i].lap_y
    return area_fraction(x, y, x1, y1, cx, cy, place)


@kernel
def reach_fraction(
    x0: float, y0: float, x1: float, y1: float, gx: float, gy: float, radius: float
) -> float:
    """Return the fraction of the way from p0 to p1 at which g is within ``radius``.

    Above 1 if never.
    """
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
def end_trip(agents: People, i: int, when: float) -> None:
    """Record the arrival of agent i, which then has no trip until the next start."""
    agents[i].arrived, agents[i].last_start = when, agents[i].trip_start
    agents[i].arrivals += 1.0
    agents[i].on_trip = 0.0


@kernel
def start_trip(agents: People, i: int, when: float) -> None:
    """Start agent i's next trip; its goal must be set."""
    agents[i].trip_start, agents[i].on_trip = when, 1.0


@kernel
def arrive(agents: People, i: int, people: AgentParameters, key: np.uint64, when: float) -> None:
    """Handle agent i at its goal: it stays a while, or goes on."""
    end_trip(agents, i, when)
    row = int(people.traits[i].first) + int(agents[i].route_point)
    if people.route[row].pause == 0.0 and people.traits[i].ahead < 0.0:
        next_goal(agents, i, people, key, when)


@kernel
def stays(agents: People, i: int, people: AgentParameters, now: float) -> bool:
    """Return True if agent i, which is on no trip, stays where it is.

    In a queue, everyone but the head waits until the place in front is left.
    """
    traits = people.traits[i]
    row, end = int(traits.first) + int(agents[i].route_point), int(traits.end)
    if row >= end or now - agents[i].arrived < people.route[row].pause:
        return True
    j = int(traits.ahead)
    if j < 0 or end - row <= 2 or agents[j].waiting == GONE:
        return False
    left = int(people.traits[j].end - people.traits[j].first) - int(agents[j].route_point)
    return bool(left > end - row - 2)


@kernel
def next_goal(agents: People, i: int, people: AgentParameters, key: np.uint64, when: float) -> None:
    """Set the next goal after an arrival; at the end of the route, act as the agent's rule says."""
    traits, route = people.traits[i], people.route
    first, end, at_goal = int(traits.first), int(traits.end), traits.at_goal
    if at_goal == ONWARD:
        agents[i].goal_x += route[first + 1].x - route[first].x
        agents[i].goal_y += route[first + 1].y - route[first].y
        agents[i].trip += 1.0
        start_trip(agents, i, when)
        return
    agents[i].route_point += 1.0
    if first + int(agents[i].route_point) >= end:
        if at_goal == REMOVE:
            agents[i].waiting = GONE
            return
        if at_goal == RETURN:
            agents[i].waiting, agents[i].attempt = AT_PORTAL, 0.0
            return
        if at_goal != LOOP or _all_here(agents, i, people):
            return
        # Each lap uses the original floor, regardless of borders crossed before.
        agents[i].route_point = agents[i].lap_x = agents[i].lap_y = 0.0
    agents[i].trip += 1.0
    head_for(agents, i, people, key)
    start_trip(agents, i, when)


@kernel
def _all_here(agents: People, i: int, people: AgentParameters) -> bool:
    """Return True if agent i is at all points of its route, so that a lap would end at once."""
    traits = people.traits[i]
    for row in range(int(traits.first), int(traits.end)):
        place = people.route[row]
        if math.hypot(place.x - agents[i].x, place.y - agents[i].y) > traits.radius:
            return False
    return True
