"""The crowd's whole state as one flat float64 vector, so that it can live in a Drake context.

A header is followed by one row per agent. `view` gives both as arrays without copying.
"""

from __future__ import annotations

from crowdbot.core.types.arrays import Array

# Header: ticks since the start; sums of impulses on the robot and on people (N s); the force on
# the robot in the current tick (N); counters of finished contacts and finished trips; torque on the
# robot about its base in the current tick (N m).
(
    TICK, ROBOT_JX, ROBOT_JY, PEOPLE_JX, PEOPLE_JY, ROBOT_FX, ROBOT_FY, CONTACTS, TRIPS,
    ROBOT_TORQUE,
) = range(10)  # fmt: skip
HEADER_SIZE = 10

# Agent columns: position, velocity, desired acceleration, push by people and walls (m/s^2), goal;
# trip number, where the agent is (below), attempts to re-enter, start of the trip, last arrival
# (s); contact with the robot: 1 while touching, start, end (s), impulse (N s), peak force (N),
# relative speed before (m/s), finished contacts; 1 while on a trip, start of the last finished
# trip (s), finished trips, next point of the route, jumps through portals and across the border,
# how far wraps at a periodic boundary have moved the agent (m); way walked (m) and the unit vector
# of the way faced, which sensors show; bearing of the contact as the robot sees it, at its start
# (rad); since when the agent has been aware of robots (s, below); 1 while one may come so near
# before the next decision that the agent has to stop short of it. Of those who find their way with
# `crowdbot.core.crowd.routing`: 1 + the corner aimed at, 0 for none; the point walked to (m); how
# much of its room aside of the corner is used, 0 to 1; for how long there was no headway (s); how
# often another way was looked for.
(
    X, Y, VX, VY, AX, AY, PUSH_X, PUSH_Y, GOAL_X, GOAL_Y,
    TRIP, WAITING, ATTEMPT, TRIP_START, ARRIVED,
    TOUCHING, TOUCH_START, TOUCH_END, TOUCH_IMPULSE, TOUCH_PEAK, TOUCH_SPEED, TOUCHES,
    ON_TRIP, LAST_START, ARRIVALS, WAYPOINT, JUMPS, LAP_X, LAP_Y,
    WALKED, DIR_X, DIR_Y, TOUCH_SIDE, NOTICED, BESIDE,
    AIM, AIM_X, AIM_Y, ASIDE, SLOW_FOR, DETOURS,
) = range(41)  # fmt: skip
AGENT_COLUMNS = 41

#: Values of ``WAITING``: in the world; outside, in front of the in-portal; outside, to start
#: later; gone for good.
PRESENT, AT_PORTAL, NOT_YET, GONE = 0.0, 1.0, 2.0, 3.0

#: Value of ``NOTICED`` of an agent who is not aware of any robot.
UNAWARE = -1.0


def size(agents: int) -> int:
    """Length of the flat vector."""
    return HEADER_SIZE + agents * AGENT_COLUMNS


def view(flat: Array) -> tuple[Array, Array]:
    """Header (H,) and agents (N, C) of a flat vector, sharing its memory."""
    return flat[:HEADER_SIZE], flat[HEADER_SIZE:].reshape(-1, AGENT_COLUMNS)
