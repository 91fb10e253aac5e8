"""Extrapolated pose of a robot at its arrival, which lies between two recorded samples."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from crowdbot.core.geometry.footprint import Footprint
from crowdbot.core.trajectories.tracks import RobotTrack
from crowdbot.core.trajectories.trajectories import Trajectories

_HALVINGS = 50


def arrival_pose(
    run: Trajectories, robot: RobotTrack, goal_time: float
) -> tuple[float, float, float]:
    """Return x, y, yaw at ``goal_time`` (s), not before the last sample; m, rad.

    The last velocity is kept. A point that is still outside the goal, since the robot accelerated,
    is moved towards the middle of the goal until it is inside.
    """
    dt = goal_time - float(run.t[-1])
    x, y, yaw = (float(column[-1]) for column in (robot.x, robot.y, robot.theta))
    if robot.vx is not None and robot.vy is not None:
        vx, vy = float(robot.vx[-1]), float(robot.vy[-1])
    else:
        v, middle = float(robot.v[-1]), yaw + 0.5 * dt * float(robot.w[-1])
        vx, vy = v * math.cos(middle), v * math.sin(middle)
    x, y = _inside(x + dt * vx, y + dt * vy, run, robot)
    return x, y, yaw + dt * float(robot.w[-1])


def _inside(x: float, y: float, run: Trajectories, robot: RobotTrack) -> tuple[float, float]:
    """Return the point, or the first one in the goal on the way to the goal's middle."""
    (goal_x, goal_y), gap = _goal(run, robot)
    if gap(x, y) <= 0.0 or not gap(goal_x, goal_y) <= 0.0:
        return x, y
    out, within = 0.0, 1.0
    for _ in range(_HALVINGS):
        half = 0.5 * (out + within)
        if gap(x + half * (goal_x - x), y + half * (goal_y - y)) <= 0.0:
            within = half
        else:
            out = half
    return x + within * (goal_x - x), y + within * (goal_y - y)


def _goal(
    run: Trajectories, robot: RobotTrack
) -> tuple[tuple[float, float], Callable[[float, float], float]]:
    """Return the middle of the goal, and the distance of a point from the goal, m; 0: in it."""
    zone = run.goal_zone
    if zone is not None:
        shape = Footprint(zone, 0.0)
        middle = zone.mean(axis=0)
        return (float(middle[0]), float(middle[1])), lambda x, y: float(
            shape.gap(np.array([x]), np.array([y]))[0]
        )
    goal = robot.goal
    if goal is not None and robot.goal_radius > 0.0:
        return goal, lambda x, y: math.hypot(x - goal[0], y - goal[1]) - robot.goal_radius
    return (math.nan, math.nan), lambda _x, _y: math.nan
