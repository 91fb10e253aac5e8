"""Constraints of each stage of a plan: the nearest people, and half-planes of free space.

Half-planes are found as in convex decompositions of free space: the nearest point gives the first
one, the nearest of the points that it does not cut off the next (Liu et al., "Planning dynamically
feasible trajectories for quadrotors using safe flight corridors", RA-L 2(3), 2017).
"""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, array_kernel, kernel
from crowdbot.plugins.planners.shared.braking_build import AroundRobot

#: Points and people farther than this from the robot's disc do not constrain it, m.
_NEAR = 2.5


@array_kernel
def poses_of(pose: tuple[float, float, float], plan: Array, dt: float) -> Array:
    """Return the poses (N, 3) at the end of each stage of a plan (N, 2 or 3)."""
    out = np.empty((plan.shape[0], 3))
    x, y, yaw = pose
    for k in range(plan.shape[0]):
        middle = yaw + 0.5 * dt * plan[k, 1]
        c, s = math.cos(middle), math.sin(middle)
        vy = plan[k, 2] if plan.shape[1] > 2 else 0.0
        x += dt * (plan[k, 0] * c - vy * s)
        y += dt * (plan[k, 0] * s + vy * c)
        yaw += dt * plan[k, 1]
        out[k, 0], out[k, 1], out[k, 2] = x, y, yaw
    return out


@array_kernel
def constrain(
    world: AroundRobot,
    poses: Array,
    dt: float,
    margins: tuple[float, float],
    people: int,
    planes: int,
) -> Array:
    """Return the constraints (N, people + planes, 5) of each stage, first those of people.

    Args:
        poses: (N, 3) of the plan that the problem starts from.
        dt: length of a stage, s.
        margins: clearance, m; its growth for people, m/s.
        people, planes: most of them in a stage.
    """
    out, gaps = np.empty((poses.shape[0], people + planes, 5)), np.empty(people)
    for k in range(poses.shape[0]):
        t = (k + 1) * dt
        _people(world, poses[k], t, margins[0] + margins[1] * t, gaps, out[k, :people])
        _planes(world, poses[k], margins[0], out[k, people:])
    return out


@kernel
def _people(
    world: AroundRobot, pose: Array, t: float, margin: float, gaps: Array, out: Array
) -> None:
    """Write the people with the least gaps, in order; slots without one never bind."""
    count = out.shape[0]
    for n in range(count):
        gaps[n] = _NEAR
        for k in range(5):
            out[n, k] = 0.0
        out[n, 4] = -1e3
    c, s = math.cos(pose[2]), math.sin(pose[2])
    for i in range(world.people.shape[0]):
        ex = world.people[i, 0] + t * world.people[i, 2]
        ey = world.people[i, 1] + t * world.people[i, 3]
        gap, at = math.inf, 0
        for d in range(world.robot.shape[0]):
            ox, oy, r = world.robot[d, 0], world.robot[d, 1], world.robot[d, 2]
            dx, dy = ex - pose[0] - c * ox + s * oy, ey - pose[1] - s * ox - c * oy
            here = math.sqrt(dx * dx + dy * dy) - r - world.people[i, 4]
            if here < gap:
                gap, at = here, d
        n = count - 1
        if gap >= gaps[n]:
            continue
        while n > 0 and gap < gaps[n - 1]:
            gaps[n] = gaps[n - 1]
            for k in range(5):
                out[n, k] = out[n - 1, k]
            n -= 1
        gaps[n] = gap
        out[n, 0], out[n, 1] = ex, ey
        out[n, 2], out[n, 3] = world.robot[at, 0], world.robot[at, 1]
        out[n, 4] = world.robot[at, 2] + world.people[i, 4] + margin


@kernel
def _planes(world: AroundRobot, pose: Array, margin: float, out: Array) -> None:
    """Write half-planes n·p >= b of the free space around the robot's discs."""
    c, s = math.cos(pose[2]), math.sin(pose[2])
    for n in range(out.shape[0]):
        gap, at, point = _NEAR, -1, -1
        for d in range(world.robot.shape[0]):
            ox, oy, r = world.robot[d, 0], world.robot[d, 1], world.robot[d, 2]
            x, y = pose[0] + c * ox - s * oy, pose[1] + s * ox + c * oy
            for i in range(world.points.shape[0]):
                dx, dy = world.points[i, 0] - x, world.points[i, 1] - y
                here = math.sqrt(dx * dx + dy * dy) - r
                if here >= gap or _cut_off(out, n, ox, oy, r + margin, world.points[i]):
                    continue
                gap, at, point = here, d, i
        for k in range(5):
            out[n, k] = 0.0
        out[n, 4] = -1e3
        if at >= 0:
            ox, oy, r = world.robot[at, 0], world.robot[at, 1], world.robot[at, 2]
            x, y = pose[0] + c * ox - s * oy, pose[1] + s * ox + c * oy
            nx, ny = x - world.points[point, 0], y - world.points[point, 1]
            long = max(math.sqrt(nx * nx + ny * ny), 1e-6)
            nx, ny = nx / long, ny / long
            out[n, 0], out[n, 1], out[n, 2], out[n, 3] = nx, ny, ox, oy
            beyond = nx * world.points[point, 0] + ny * world.points[point, 1]
            out[n, 4] = beyond + r + margin


@kernel
def _cut_off(planes: Array, count: int, ox: float, oy: float, need: float, point: Array) -> bool:
    """Return True if an earlier half-plane of the same disc keeps it away from a point."""
    for n in range(count):
        if planes[n, 2] != ox or planes[n, 3] != oy:
            continue
        if planes[n, 0] * point[0] + planes[n, 1] * point[1] <= planes[n, 4] - need + 1e-9:
            return True
    return False
