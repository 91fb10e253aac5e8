"""Forces between a robot and people."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.crowd.state import (
    CONTACTS,
    FELT_SIZE,
    PEOPLE_JX,
    PEOPLE_JY,
    ROBOT_FX,
    ROBOT_FY,
    ROBOT_JX,
    ROBOT_JY,
    ROBOT_TORQUE,
    TOUCH_COLUMNS,
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
from crowdbot.core.types.arrays import Array, Indices

#: A contact has ended when the surface gap exceeds this, m (metric specification, 3.10).
RELEASE_GAP = 0.05
#: Columns of a robot row: position, velocity, physical radius (of a polygon: 0), perceived radius,
#: heading, yaw rate.
RX, RY, RVX, RVY, R_BODY, R_SEEN, R_YAW, R_W = range(8)
#: Outline of a robot that is a disc.
DISC = np.zeros((0, 2))
#: Nearer to an edge a point's direction from it is rounding: the edge's normal counts, m.
_ON_EDGE = 1e-12


@kernel
def robot_contacts(
    contacts: Array,
    agents: Array,
    radius: Array,
    robots: Array,
    outlines: Array,
    numbers: Indices,
    stiffnesses: Array,
    dissipation: float,
    now: float,
    dt: float,
    reaction: Array,
) -> None:
    """`robot_contact` with each robot that is there.

    Args:
        contacts: (A, F + T N) what each of all robots feels, changed in place: the last part of
            the crowd's state.
        numbers: (R,) which of them are there.
        stiffnesses: (R,) of the contact with each, N/m.
        reaction: (N, 2) the sum of their forces on each agent, N; written.
    """
    reaction[:] = 0.0
    for r in range(robots.shape[0]):
        own = contacts[numbers[r]]
        felt, touches = own[:FELT_SIZE], own[FELT_SIZE:].reshape(-1, TOUCH_COLUMNS)
        outline = outlines[r][: corners_of(outlines, r)]
        robot_contact(
            felt, touches, agents, radius, robots[r], outline, stiffnesses[r], dissipation, now,
            dt, reaction,
        )  # fmt: skip


@kernel
def robot_contact(
    felt: Array,
    touches: Array,
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
    the robot (N) and its torque about the base (N m) to ``felt``, adds the force on each agent (N)
    to ``reaction`` (N, 2), and records the contacts in ``touches``.

    Args:
        felt, touches: (F,), (N, T) as in `crowdbot.core.crowd.state`, of this robot.
        robot: (8,) columns as above.
        outline: (K, 2) in the robot's frame, m: none (a disc), the ends of a capsule's axis, or
            the corners of a convex polygon, counter-clockwise.
    """
    felt[ROBOT_FX] = felt[ROBOT_FY] = felt[ROBOT_TORQUE] = 0.0
    extent = extent_of(outline)
    for i in range(agents.shape[0]):
        if agents[i, WAITING] != 0.0:
            if touches[i, TOUCHING] != 0.0:
                _end_touch(felt, touches, i)
            continue
        dx, dy = robot[RX] - agents[i, X], robot[RY] - agents[i, Y]
        reach = robot[R_BODY] + radius[i]
        if dx * dx + dy * dy > (extent + reach + RELEASE_GAP) ** 2:
            if touches[i, TOUCHING] != 0.0:
                _end_touch(felt, touches, i)
            continue
        depth, nx, ny, px, py = overlap(robot, outline, dx, dy, reach)
        if depth < 0.0:
            if depth < -RELEASE_GAP and touches[i, TOUCHING] != 0.0:
                _end_touch(felt, touches, i)
            continue
        vx = robot[RVX] - robot[R_W] * py - agents[i, VX]
        vy = robot[RVY] + robot[R_W] * px - agents[i, VY]
        closing = -(vx * nx + vy * ny)
        force = max(0.0, stiffness * depth * (1.0 + dissipation * closing))
        fx, fy = force * nx, force * ny
        felt[ROBOT_FX] += fx
        felt[ROBOT_FY] += fy
        felt[ROBOT_TORQUE] += px * fy - py * fx
        reaction[i, 0] -= fx
        reaction[i, 1] -= fy
        felt[ROBOT_JX] += fx * dt
        felt[ROBOT_JY] += fy * dt
        felt[PEOPLE_JX] -= fx * dt
        felt[PEOPLE_JY] -= fy * dt
        if touches[i, TOUCHING] == 0.0:
            side = bearing(robot, px - robot[R_BODY] * nx, py - robot[R_BODY] * ny)
            _begin_touch(touches, i, now, dt, depth, closing, math.hypot(vx, vy), side)
        touches[i, TOUCH_END] = now
        touches[i, TOUCH_IMPULSE] += force * dt
        touches[i, TOUCH_PEAK] = max(touches[i, TOUCH_PEAK], force)


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
    touches: Array,
    i: int,
    now: float,
    dt: float,
    depth: float,
    closing: float,
    speed: float,
    side: float,
) -> None:
    since = min(dt, depth / closing) if closing > 0.0 else 0.0
    touches[i, TOUCHING], touches[i, TOUCH_START] = 1.0, max(0.0, now - since)
    touches[i, TOUCH_SPEED], touches[i, TOUCH_IMPULSE], touches[i, TOUCH_PEAK] = speed, 0.0, 0.0
    touches[i, TOUCH_SIDE] = side


@kernel
def _end_touch(felt: Array, touches: Array, i: int) -> None:
    touches[i, TOUCHING] = 0.0
    touches[i, TOUCHES] += 1.0
    felt[CONTACTS] += 1.0
