"""Forces between robots and people."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.core.crowd.contact.geometry import nearest_on_segment
from crowdbot.core.crowd.state import (
    FELT,
    FELT_SIZE,
    TOUCH,
    TOUCH_COLUMNS,
    FeltRecord,
    People,
    TouchRecord,
)
from crowdbot.core.crowd.traits import TraitsRecord
from crowdbot.core.support.compiling.compile import kernel
from crowdbot.core.support.records import Rows, as_record, as_rows, record_type
from crowdbot.core.types.arrays import Array, Indices

#: A contact ends when the surface gap exceeds this, m (metric specification, 3.10).
RELEASE_GAP = 0.05
#: Columns of a robot row for numpy, in the order of the fields of `RobotRecord`.
RX, RY, RVX, RVY, R_BODY, R_SEEN, R_YAW, R_W = range(8)


class RobotRecord:
    """State and shape of a robot, for contacts with people and their perception.

    Attributes:
        x, y, vx, vy: position, velocity.
        body, seen: physical radius (of a polygon: 0), perceived radius.
        yaw, turning: heading, yaw rate.
    """

    x: float
    y: float
    vx: float
    vy: float
    body: float
    seen: float
    yaw: float
    turning: float


ROBOT = record_type(RobotRecord)
#: Outline of a robot that is a disc.
DISC = np.zeros((0, 2))
#: Nearer to an edge the direction from it is rounding, so the edge's normal is used, m.
_ON_EDGE = 1e-12


@kernel
def robot_contacts(
    contacts: Array,
    agents: People,
    traits: Rows[TraitsRecord],
    robots: Rows[RobotRecord],
    outlines: Array,
    numbers: Indices,
    stiffnesses: Array,
    dissipation: float,
    now: float,
    dt: float,
    reaction: Array,
) -> None:
    """Compute the contact forces of each robot that is present, see `robot_contact`.

    Args:
        contacts: forces and contacts of every robot, changed in place: the last part of the
            crowd's state.
        numbers: (R,) indices of the robots that are present.
        stiffnesses: (R,) of the contact with each, N/m.
        reaction: (N, 2) the sum of their forces on each agent, N; written.
    """
    size = FELT_SIZE + agents.shape[0] * TOUCH_COLUMNS
    reaction[:] = 0.0
    for r in range(robots.shape[0]):
        own = contacts[numbers[r] * size : (numbers[r] + 1) * size]
        felt, touches = as_record(own, FELT), as_rows(own[FELT_SIZE:], TOUCH)
        outline = outlines[r][: corners_of(outlines, r)]
        robot_contact(
            felt, touches, agents, traits, robots[r], outline, stiffnesses[r], dissipation, now,
            dt, reaction,
        )  # fmt: skip


@kernel
def robot_contact(
    felt: FeltRecord,
    touches: Rows[TouchRecord],
    agents: People,
    traits: Rows[TraitsRecord],
    robot: RobotRecord,
    outline: Array,
    stiffness: float,
    dissipation: float,
    now: float,
    dt: float,
    reaction: Array,
) -> None:
    """Compute the Hunt-Crossley force F = k d (1 + c d'), repulsive, equal and opposite.

    There is no friction: the force is along the normal through the person's centre. Writes the
    force on the robot (N) and its torque about the base (N m) to ``felt``, adds the force on each
    agent (N) to ``reaction`` (N, 2), and records the contacts in ``touches``.

    Args:
        felt, touches: of this robot; (N,) of each person.
        outline: (K, 2) in the robot's frame, m: none (a disc), the ends of a capsule's axis, or
            the corners of a convex polygon, counter-clockwise.
    """
    felt.robot_fx = felt.robot_fy = felt.robot_torque = 0.0
    extent = extent_of(outline)
    for i in range(agents.shape[0]):
        if agents[i].waiting != 0.0:
            if touches[i].touching != 0.0:
                _end_touch(felt, touches, i)
            continue
        dx, dy = robot.x - agents[i].x, robot.y - agents[i].y
        reach = robot.body + traits[i].radius
        if dx * dx + dy * dy > (extent + reach + RELEASE_GAP) ** 2:
            if touches[i].touching != 0.0:
                _end_touch(felt, touches, i)
            continue
        depth, nx, ny, px, py = overlap(robot.yaw, outline, dx, dy, reach)
        if depth < 0.0:
            if depth < -RELEASE_GAP and touches[i].touching != 0.0:
                _end_touch(felt, touches, i)
            continue
        vx = robot.vx - robot.turning * py - agents[i].vx
        vy = robot.vy + robot.turning * px - agents[i].vy
        closing = -(vx * nx + vy * ny)
        force = max(0.0, stiffness * depth * (1.0 + dissipation * closing))
        fx, fy = force * nx, force * ny
        felt.robot_fx += fx
        felt.robot_fy += fy
        felt.robot_torque += px * fy - py * fx
        reaction[i, 0] -= fx
        reaction[i, 1] -= fy
        felt.robot_jx += fx * dt
        felt.robot_jy += fy * dt
        felt.people_jx -= fx * dt
        felt.people_jy -= fy * dt
        if touches[i].touching == 0.0:
            side = bearing(robot, px - robot.body * nx, py - robot.body * ny)
            _begin_touch(touches, i, now, dt, depth, closing, math.hypot(vx, vy), side)
        touches[i].end = now
        touches[i].impulse += force * dt
        touches[i].peak = max(touches[i].peak, force)


@kernel
def corners_of(outlines: Array, r: int) -> int:
    """Return the number of corners of robot r; shorter outlines (R, K, 2) are padded with NaN."""
    count = 0
    while count < outlines.shape[1] and outlines[r, count, 0] == outlines[r, count, 0]:
        count += 1
    return count


@kernel
def overlap(
    yaw: float, outline: Array, dx: float, dy: float, reach: float
) -> tuple[float, float, float, float, float]:
    """Return the overlap of a robot's outline and a person's disc.

    Args:
        yaw: heading of the robot, rad.
        dx, dy: from the person to the robot, m.
        reach: radius of the person and of the robot's rounding together, m.

    Returns:
        depth (m), negative for a gap; unit normal towards the robot; and the outline's point of
        contact relative to the base, before rounding (m). World frame.
    """
    if outline.shape[0] == 0:
        distance = math.sqrt(dx * dx + dy * dy)
        nx, ny = (dx / distance, dy / distance) if distance > 0.0 else (1.0, 0.0)
        return reach - distance, nx, ny, 0.0, 0.0
    c, s = math.cos(yaw), math.sin(yaw)
    gap, ux, uy, qx, qy = from_outline(outline, -c * dx - s * dy, s * dx - c * dy)
    return reach - gap, s * uy - c * ux, -s * ux - c * uy, c * qx - s * qy, s * qx + c * qy


@kernel
def from_outline(outline: Array, x: float, y: float) -> tuple[float, float, float, float, float]:
    """Return a point's position relative to a segment (K = 2) or a counter-clockwise polygon.

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
    """Return the distance of the farthest corner from the base, m."""
    farthest = 0.0
    for k in range(outline.shape[0]):
        farthest = max(farthest, math.hypot(outline[k, 0], outline[k, 1]))
    return farthest


@kernel
def bearing(robot: RobotRecord, x: float, y: float) -> float:
    """Return the direction of a world vector in the robot's frame, rad, counter-clockwise."""
    angle = math.atan2(y, x) - robot.yaw
    return math.atan2(math.sin(angle), math.cos(angle))


@kernel
def _begin_touch(
    touches: Rows[TouchRecord],
    i: int,
    now: float,
    dt: float,
    depth: float,
    closing: float,
    speed: float,
    side: float,
) -> None:
    since = min(dt, depth / closing) if closing > 0.0 else 0.0
    touches[i].touching, touches[i].start = 1.0, max(0.0, now - since)
    touches[i].speed, touches[i].impulse, touches[i].peak = speed, 0.0, 0.0
    touches[i].side = side


@kernel
def _end_touch(felt: FeltRecord, touches: Rows[TouchRecord], i: int) -> None:
    touches[i].touching = 0.0
    touches[i].finished += 1.0
    felt.contacts += 1.0
