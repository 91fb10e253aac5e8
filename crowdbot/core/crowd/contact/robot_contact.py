"""Forces between a robot and people."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.crowd.state import (
    CONTACTS,
    PEOPLE_JX,
    PEOPLE_JY,
    ROBOT_FX,
    ROBOT_FY,
    ROBOT_JX,
    ROBOT_JY,
    ROBOT_TORQUE,
    TOUCH_END,
    TOUCH_IMPULSE,
    TOUCH_PEAK,
    TOUCH_SIDE,
    TOUCH_SPEED,
    TOUCH_START,
    TOUCHES,
    TOUCHING,
    VX,
    VY,
    WAITING,
    X,
    Y,
)
from crowdbot.core.support.compile import kernel
from crowdbot.core.types.arrays import Array

#: A contact has ended when the surface gap exceeds this, m (metric specification, 3.10).
RELEASE_GAP = 0.05
#: Columns of a robot row: position, velocity, physical radius (of a polygon: 0), perceived radius,
#: heading, yaw rate.
RX, RY, RVX, RVY, R_BODY, R_SEEN, R_YAW, R_W = range(8)
#: Outline of a robot that is a disc.
DISC = np.zeros((0, 2))
#: Columns of an agent that tell of its contact with one robot.
TOUCH = np.array(
    [
        TOUCHING, TOUCH_START, TOUCH_END, TOUCH_IMPULSE, TOUCH_PEAK, TOUCH_SPEED, TOUCHES,
        TOUCH_SIDE,
    ]
)  # fmt: skip
#: Entries of the header that tell of one robot.
FELT = np.array(
    [
        ROBOT_JX, ROBOT_JY, PEOPLE_JX, PEOPLE_JY, ROBOT_FX, ROBOT_FY, CONTACTS, ROBOT_TORQUE,
    ]
)  # fmt: skip
#: Nearer to an edge a point's direction from it is rounding: the edge's normal counts, m.
_ON_EDGE = 1e-12


@kernel
def robot_contact(
    header: Array,
    agents: Array,
    radius: Array,
    robot: Array,
    outline: Array,
    stiffness: float,
    dissipation: float,
    now: float,
    dt: float,
    reaction: Array,
) -> None:
    """Hunt-Crossley force F = k d (1 + c d'), never pulling; equal and opposite by one number.

    Nothing rubs: the force is along the normal through the person's centre. Writes the force on
    the robot (N) and its torque about the base (N m) to the header, the force on each agent (N)
    to ``reaction`` (N, 2), and records the contacts.

    Args:
        robot: (8,) columns as above.
        outline: (K, 2) in the robot's frame, m: none (a disc), the ends of a capsule's axis, or
            the corners of a convex polygon, counter-clockwise.
    """
    header[ROBOT_FX] = header[ROBOT_FY] = header[ROBOT_TORQUE] = 0.0
    extent = extent_of(outline)
    for i in range(agents.shape[0]):
        reaction[i, 0] = reaction[i, 1] = 0.0
        if agents[i, WAITING] != 0.0:
            if agents[i, TOUCHING] != 0.0:
                _end_touch(header, agents, i)
            continue
        dx, dy = robot[RX] - agents[i, X], robot[RY] - agents[i, Y]
        reach = robot[R_BODY] + radius[i]
        if dx * dx + dy * dy > (extent + reach + RELEASE_GAP) ** 2:
            if agents[i, TOUCHING] != 0.0:
                _end_touch(header, agents, i)
            continue
        depth, nx, ny, px, py = overlap(robot, outline, dx, dy, reach)
        if depth < 0.0:
            if depth < -RELEASE_GAP and agents[i, TOUCHING] != 0.0:
                _end_touch(header, agents, i)
            continue
        vx = robot[RVX] - robot[R_W] * py - agents[i, VX]
        vy = robot[RVY] + robot[R_W] * px - agents[i, VY]
        closing = -(vx * nx + vy * ny)
        force = max(0.0, stiffness * depth * (1.0 + dissipation * closing))
        fx, fy = force * nx, force * ny
        header[ROBOT_FX] += fx
        header[ROBOT_FY] += fy
        header[ROBOT_TORQUE] += px * fy - py * fx
        reaction[i, 0], reaction[i, 1] = -fx, -fy
        header[ROBOT_JX] += fx * dt
        header[ROBOT_JY] += fy * dt
        header[PEOPLE_JX] -= fx * dt
        header[PEOPLE_JY] -= fy * dt
        if agents[i, TOUCHING] == 0.0:
            side = bearing(robot, px - robot[R_BODY] * nx, py - robot[R_BODY] * ny)
            _begin_touch(agents, i, now, dt, depth, closing, math.hypot(vx, vy), side)
        agents[i, TOUCH_END] = now
        agents[i, TOUCH_IMPULSE] += force * dt
        agents[i, TOUCH_PEAK] = max(agents[i, TOUCH_PEAK], force)


@kernel
def contacts_of_several(
    header: Array,
    agents: Array,
    radius: Array,
    robots: Array,
    outlines: Array,
    books: Array,
    stiffness: Array,
    dissipation: float,
    now: float,
    dt: float,
    reaction: Array,
    total: Array,
) -> None:
    """`robot_contact` with each of several robots, each with a book of its own.

    Args:
        books: (R, 8 + 8 N) what `FELT` and `TOUCH` hold of each robot, changed in place; header
            and agents hold none of it before and afterwards.
        stiffness: (R,) of the contact with each, N/m.
        reaction: (N, 2) the sum of the forces of all on each agent, N.
        total: (N, 2 or more) room to add them up.
    """
    total[:, :2] = 0.0
    for r in range(robots.shape[0]):
        _exchange(header, agents, books[r])
        outline = outlines[r][: corners_of(outlines, r)]
        robot_contact(
            header, agents, radius, robots[r], outline, stiffness[r], dissipation, now, dt, reaction
        )
        for i in range(agents.shape[0]):
            total[i, 0] += reaction[i, 0]
            total[i, 1] += reaction[i, 1]
        _exchange(header, agents, books[r])
    for i in range(agents.shape[0]):
        reaction[i, 0], reaction[i, 1] = total[i, 0], total[i, 1]


@kernel
def _exchange(header: Array, agents: Array, book: Array) -> None:
    """Swap what header and agents say of one robot with a book."""
    for k in range(len(FELT)):
        header[FELT[k]], book[k] = book[k], header[FELT[k]]
    at = len(FELT)
    for i in range(agents.shape[0]):
        for k in range(len(TOUCH)):
            agents[i, TOUCH[k]], book[at] = book[at], agents[i, TOUCH[k]]
            at += 1


@kernel
def corners_of(outlines: Array, r: int) -> int:
    """How many corners robot r has, of outlines (R, K, 2) whose shorter ones end with NaN."""
    count = 0
    while count < outlines.shape[1] and outlines[r, count, 0] == outlines[r, count, 0]:
        count += 1
    return count


@kernel
def overlap(
    robot: Array, outline: Array, dx: float, dy: float, reach: float
) -> tuple[float, float, float, float, float]:
    """How a robot and a person's disc overlap.

    Args:
        dx, dy: from the person to the robot, m.
        reach: radius of the person and of the robot's rounding together, m.

    Returns:
        depth (m), negative: a gap; unit normal towards the robot; and from the robot's base the
        point of its outline where they meet, before rounding (m). World frame.
    """
    if outline.shape[0] == 0:
        distance = math.sqrt(dx * dx + dy * dy)
        nx, ny = (dx / distance, dy / distance) if distance > 0.0 else (1.0, 0.0)
        return reach - distance, nx, ny, 0.0, 0.0
    c, s = math.cos(robot[R_YAW]), math.sin(robot[R_YAW])
    gap, ux, uy, qx, qy = from_outline(outline, -c * dx - s * dy, s * dx - c * dy)
    return reach - gap, s * uy - c * ux, -s * ux - c * uy, c * qx - s * qy, s * qx + c * qy


@kernel
def from_outline(outline: Array, x: float, y: float) -> tuple[float, float, float, float, float]:
    """Where a point lies beside a segment (K = 2) or a convex polygon, counter-clockwise.

    Returns:
        distance (m), negative inside a polygon; unit vector outwards; nearest point.
    """
    count = outline.shape[0]
    nearest, qx, qy, nx, ny = math.inf, 0.0, 0.0, 1.0, 0.0
    inside = count > 2
    for k in range(count if count > 2 else 1):
        ax, ay = outline[k, 0], outline[k, 1]
        bx, by = outline[(k + 1) % count, 0], outline[(k + 1) % count, 1]
        length = math.hypot(bx - ax, by - ay)
        ex, ey = ((by - ay) / length, (ax - bx) / length) if length > 0.0 else (1.0, 0.0)
        inside = inside and ex * (x - ax) + ey * (y - ay) < 0.0
        px, py = nearest_on_segment(x, y, ax, ay, bx, by)
        distance = math.hypot(x - px, y - py)
        if distance < nearest:
            nearest, qx, qy, nx, ny = distance, px, py, ex, ey
    if inside:
        return -nearest, nx, ny, qx, qy
    if nearest > _ON_EDGE:
        nx, ny = (x - qx) / nearest, (y - qy) / nearest
    return nearest, nx, ny, qx, qy


@kernel
def extent_of(outline: Array) -> float:
    """Distance of the farthest corner from the base, m."""
    farthest = 0.0
    for k in range(outline.shape[0]):
        farthest = max(farthest, math.hypot(outline[k, 0], outline[k, 1]))
    return farthest


@kernel
def bearing(robot: Array, x: float, y: float) -> float:
    """Direction of a vector (world frame) as the robot sees it, rad, counter-clockwise."""
    angle = math.atan2(y, x) - robot[R_YAW]
    return math.atan2(math.sin(angle), math.cos(angle))


@kernel
def _begin_touch(
    agents: Array,
    i: int,
    now: float,
    dt: float,
    depth: float,
    closing: float,
    speed: float,
    side: float,
) -> None:
    since = min(dt, depth / closing) if closing > 0.0 else 0.0
    agents[i, TOUCHING], agents[i, TOUCH_START] = 1.0, max(0.0, now - since)
    agents[i, TOUCH_SPEED], agents[i, TOUCH_IMPULSE], agents[i, TOUCH_PEAK] = speed, 0.0, 0.0
    agents[i, TOUCH_SIDE] = side


@kernel
def _end_touch(header: Array, agents: Array, i: int) -> None:
    agents[i, TOUCHING] = 0.0
    agents[i, TOUCHES] += 1.0
    header[CONTACTS] += 1.0
