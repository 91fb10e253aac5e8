"""The crowd's whole state as one flat float64 vector, so that it can be in a Drake context.

A header, one row per agent, then, for each robot, its contacts with people: one row of sums, and
one row per agent. `view` and `contact_with` give these parts as arrays without copying.
"""

from __future__ import annotations

import numpy as np

from crowdbot.core.support.records import Rows, columns_of, record_type, rows_in
from crowdbot.core.types.arrays import Array


class HeaderRecord:
    """The first numbers of the state vector.

    Attributes:
        robots: number of robots that there is room for.
        tick: ticks since the start.
        trips: finished trips.
    """

    robots: float
    tick: float
    trips: float


class PersonRecord:
    """One person's numbers in the state vector; SI units.

    Attributes:
        x, y, vx, vy, ax, ay: position, velocity, desired acceleration.
        push_x, push_y: push by people and walls, m/s^2.
        goal_x, goal_y: goal.
        trip: its number.
        waiting: where the person is, see `PRESENT`.
        attempt: attempts to re-enter.
        trip_start, arrived: start of the trip, last arrival.
        on_trip: 1 while on a trip.
        last_start: start of the last finished trip.
        arrivals: finished trips.
        route_point: next point of the route.
        jumps: jumps through portals and across the border.
        lap_x, lap_y: how far wraps at a periodic boundary have moved the person.
        walked, dir_x, dir_y: way walked, and unit vector of the way faced, which sensors show.
        noticed: since when the person has been aware of robots, see `UNAWARE`.
        beside: 1 while a robot may come so near before the next decision that the person has to
            stop short of it.
        corner: of those who find their way with `crowdbot.core.crowd.routing`: 1 + the corner
            aimed at, 0 for none.
        waypoint_x, waypoint_y: the point walked to.
        aside: fraction of the free room beside the corner that the person uses, 0 to 1.
        slow_for: time without progress.
        detours: number of searches for another way.
    """

    x: float
    y: float
    vx: float
    vy: float
    ax: float
    ay: float
    push_x: float
    push_y: float
    goal_x: float
    goal_y: float
    trip: float
    waiting: float
    attempt: float
    trip_start: float
    arrived: float
    on_trip: float
    last_start: float
    arrivals: float
    route_point: float
    jumps: float
    lap_x: float
    lap_y: float
    walked: float
    dir_x: float
    dir_y: float
    noticed: float
    beside: float
    corner: float
    waypoint_x: float
    waypoint_y: float
    aside: float
    slow_for: float
    detours: float


class FeltRecord:
    """Forces of people on one robot.

    Attributes:
        robot_jx, robot_jy, people_jx, people_jy: sums of impulses on the robot and on people, N s.
        robot_fx, robot_fy, robot_torque: force on the robot (N), and its torque about the base
            (N m), in the current tick.
        contacts: finished contacts.
    """

    robot_jx: float
    robot_jy: float
    people_jx: float
    people_jy: float
    robot_fx: float
    robot_fy: float
    robot_torque: float
    contacts: float


class TouchRecord:
    """A person's contact with one robot.

    Attributes:
        touching: 1 while touching.
        start, end: s.
        impulse, peak: N s; largest force, N.
        speed: relative speed before, m/s.
        finished: finished contacts.
        side: bearing as the robot sees it at the start, rad.
    """

    touching: float
    start: float
    end: float
    impulse: float
    peak: float
    speed: float
    finished: float
    side: float


HEADER, PERSON = record_type(HeaderRecord), record_type(PersonRecord)
FELT, TOUCH = record_type(FeltRecord), record_type(TouchRecord)
HEADER_SIZE, AGENT_COLUMNS = columns_of(HEADER), columns_of(PERSON)
FELT_SIZE, TOUCH_COLUMNS = columns_of(FELT), columns_of(TOUCH)
People = Rows[PersonRecord]

# Columns of the same float64 for numpy, in the order of the fields.
ROBOTS, TICK, TRIPS = range(HEADER_SIZE)
(
    X, Y, VX, VY, AX, AY, PUSH_X, PUSH_Y, GOAL_X, GOAL_Y,
    TRIP, WAITING, ATTEMPT, TRIP_START, ARRIVED,
    ON_TRIP, LAST_START, ARRIVALS, ROUTE_POINT, JUMPS, LAP_X, LAP_Y,
    WALKED, DIR_X, DIR_Y, NOTICED, BESIDE,
    CORNER, WAYPOINT_X, WAYPOINT_Y, ASIDE, SLOW_FOR, DETOURS,
) = range(AGENT_COLUMNS)  # fmt: skip
(
    ROBOT_JX, ROBOT_JY, PEOPLE_JX, PEOPLE_JY, ROBOT_FX, ROBOT_FY, ROBOT_TORQUE, CONTACTS,
) = range(FELT_SIZE)  # fmt: skip
(
    TOUCHING, TOUCH_START, TOUCH_END, TOUCH_IMPULSE, TOUCH_PEAK, TOUCH_SPEED, TOUCHES, TOUCH_SIDE,
) = range(TOUCH_COLUMNS)  # fmt: skip

#: Values of `PersonRecord.waiting`: in the world; outside, in front of the in-portal; outside, to
#: start later; gone for good.
PRESENT, AT_PORTAL, NOT_YET, GONE = 0.0, 1.0, 2.0, 3.0

#: Value of `PersonRecord.noticed` of a person who is not aware of any robot.
UNAWARE = -1.0


def blank(agents: int, robots: int = 1) -> Array:
    """Return a flat vector of zeros with room for agents and robots."""
    size = HEADER_SIZE + agents * AGENT_COLUMNS
    flat = np.zeros(size + robots * (FELT_SIZE + agents * TOUCH_COLUMNS))
    flat[ROBOTS] = robots
    return flat


def view(flat: Array) -> tuple[Array, Array]:
    """Return header (H,) and agents (N, C) of a flat vector, sharing its memory."""
    return flat[:HEADER_SIZE], flat[HEADER_SIZE : _contacts_start(flat)].reshape(-1, AGENT_COLUMNS)


def people_in(flat: Array) -> People:
    """Return the people (N,) of a flat vector as records, sharing its memory."""
    return rows_in(flat[HEADER_SIZE : _contacts_start(flat)], PERSON)


def contact_with(flat: Array, robot: int = 0) -> tuple[Array, Array]:
    """Return the forces on a robot (F,), and its contact with each agent (N, T), sharing memory."""
    start = _contacts_start(flat)
    size = (len(flat) - start) // int(flat[ROBOTS])
    own = flat[start + robot * size : start + (robot + 1) * size]
    return own[:FELT_SIZE], own[FELT_SIZE:].reshape(-1, TOUCH_COLUMNS)


def felt_at(flat: Array, robot: int, entry: int) -> int:
    """Return the index in the flat vector of one entry of the forces on a robot."""
    start = _contacts_start(flat)
    return start + robot * ((len(flat) - start) // int(flat[ROBOTS])) + entry


def _contacts_start(flat: Array) -> int:
    robots = int(flat[ROBOTS])
    rows = len(flat) - HEADER_SIZE - robots * FELT_SIZE
    return HEADER_SIZE + rows // (AGENT_COLUMNS + robots * TOUCH_COLUMNS) * AGENT_COLUMNS
