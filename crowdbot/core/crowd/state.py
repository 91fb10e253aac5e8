"""The crowd's whole state as one flat float64 vector, so that it can live in a Drake context.

A header, one row per agent, then for each robot what it and people feel of each other: one row of
sums, and one row per agent. `view` and `contact_with` give these parts as arrays without copying.
"""

from __future__ import annotations

import numpy as np

from crowdbot.core.types.arrays import Array

# Header: number of robots that there is room for; ticks since the start; finished trips.
ROBOTS, TICK, TRIPS = range(3)
HEADER_SIZE = 3

# Agent columns: position, velocity, desired acceleration, push by people and walls (m/s^2), goal;
# trip number, where the agent is (below), attempts to re-enter, start of the trip, last arrival
# (s); 1 while on a trip, start of the last finished trip (s), finished trips, next point of the
# route, jumps through portals and across the border, how far wraps at a periodic boundary have
# moved the agent (m); way walked (m) and the unit vector of the way faced, which sensors show;
# since when the agent has been aware of robots (s, below); 1 while one may come so near before the
# next decision that the agent has to stop short of it. Of those who find their way with
# `crowdbot.core.crowd.routing`: 1 + the corner aimed at, 0 for none; the point walked to (m); how
# much of its room aside of the corner is used, 0 to 1; for how long there was no headway (s); how
# often another way was looked for.
(
    X, Y, VX, VY, AX, AY, PUSH_X, PUSH_Y, GOAL_X, GOAL_Y,
    TRIP, WAITING, ATTEMPT, TRIP_START, ARRIVED,
    ON_TRIP, LAST_START, ARRIVALS, WAYPOINT, JUMPS, LAP_X, LAP_Y,
    WALKED, DIR_X, DIR_Y, NOTICED, BESIDE,
    AIM, AIM_X, AIM_Y, ASIDE, SLOW_FOR, DETOURS,
) = range(33)  # fmt: skip
AGENT_COLUMNS = 33

# What one robot feels of people: sums of impulses on the robot and on people (N s); the force (N)
# on the robot, and its torque about the base (N m), in the current tick; finished contacts.
(
    ROBOT_JX, ROBOT_JY, PEOPLE_JX, PEOPLE_JY, ROBOT_FX, ROBOT_FY, ROBOT_TORQUE, CONTACTS,
) = range(8)  # fmt: skip
FELT_SIZE = 8

# Columns of an agent's contact with one robot: 1 while touching, start, end (s), impulse (N s),
# peak force (N), relative speed before (m/s), finished contacts, bearing as the robot sees it at
# the start (rad).
(
    TOUCHING, TOUCH_START, TOUCH_END, TOUCH_IMPULSE, TOUCH_PEAK, TOUCH_SPEED, TOUCHES, TOUCH_SIDE,
) = range(8)  # fmt: skip
TOUCH_COLUMNS = 8

#: Values of ``WAITING``: in the world; outside, in front of the in-portal; outside, to start
#: later; gone for good.
PRESENT, AT_PORTAL, NOT_YET, GONE = 0.0, 1.0, 2.0, 3.0

#: Value of ``NOTICED`` of an agent who is not aware of any robot.
UNAWARE = -1.0


def blank(agents: int, robots: int = 1) -> Array:
    """A flat vector of zeros with room for agents and robots."""
    size = HEADER_SIZE + agents * AGENT_COLUMNS
    flat = np.zeros(size + robots * (FELT_SIZE + agents * TOUCH_COLUMNS))
    flat[ROBOTS] = robots
    return flat


def view(flat: Array) -> tuple[Array, Array]:
    """Header (H,) and agents (N, C) of a flat vector, sharing its memory."""
    return flat[:HEADER_SIZE], flat[HEADER_SIZE : _contacts_start(flat)].reshape(-1, AGENT_COLUMNS)


def contact_with(flat: Array, robot: int = 0) -> tuple[Array, Array]:
    """What a robot feels (F,), and its contact with each agent (N, T), sharing the memory."""
    start = _contacts_start(flat)
    size = (len(flat) - start) // int(flat[ROBOTS])
    own = flat[start + robot * size : start + (robot + 1) * size]
    return own[:FELT_SIZE], own[FELT_SIZE:].reshape(-1, TOUCH_COLUMNS)


def felt_at(flat: Array, robot: int, entry: int) -> int:
    """Where an entry of what a robot feels lies in the flat vector."""
    start = _contacts_start(flat)
    return start + robot * ((len(flat) - start) // int(flat[ROBOTS])) + entry


def _contacts_start(flat: Array) -> int:
    robots = int(flat[ROBOTS])
    rows = len(flat) - HEADER_SIZE - robots * FELT_SIZE
    return HEADER_SIZE + rows // (AGENT_COLUMNS + robots * TOUCH_COLUMNS) * AGENT_COLUMNS
