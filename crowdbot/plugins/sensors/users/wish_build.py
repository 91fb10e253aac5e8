"""The deflection that a synthetic user wants: direction and speed from the people around.

Direction: Fajen, Warren, "Behavioral dynamics of steering, obstacle avoidance, and route
selection", J. Exp. Psychol. HPP 29(2), 2003: the goal attracts the heading, each obstacle repels
it. Their turning is an acceleration against a damping; a stick commands the yaw rate at which both
balance. Speed: no faster than the gap ahead in a relaxation time (Moussaïd, Helbing, Theraulaz,
PNAS 108(17), 2011, their second heuristic).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from crowdbot.plugin import Array, Pose, RobotBody, Scene
from crowdbot.plugins.sensors.joystick_build import full
from crowdbot.plugins.sensors.users.users import UserSpec

#: Damping (1/s), stiffness of the goal (1/s^2) and its decay with distance (1/m) and floor;
#: stiffness of obstacles (1/s^2), their decay with angle (1/rad) and distance (1/m).
DAMPING, GOAL, GOAL_DECAY, GOAL_FLOOR = 3.25, 7.5, 0.4, 0.4
OBSTACLE, ANGLE_DECAY, DISTANCE_DECAY = 198.0, 6.5, 0.8
#: Free space beside the robot within which something counts as ahead, m.
_BESIDE = 0.05


class Wish(NamedTuple):
    """The deflection that a user wants, before delay and error.

    Attributes:
        ahead, aside: deflections of a stick, forward and to the left, from -1 to 1.
        off: angle from the robot's heading to the goal, rad.
        free: way straight ahead to the goal or to what stands before it, m.
    """

    ahead: float
    aside: float
    off: float
    free: float


def wish(
    spec: UserSpec,
    body: RobotBody,
    goal: tuple[float, float],
    most: tuple[float, float],
    scene: Scene,
    pose: Pose,
) -> Wish:
    """Return the deflection that a user wants.

    Args:
        goal: world frame, m.
        most: speed (m/s) and yaw rate (rad/s) of the stick's full deflection.
    """
    x, y = goal[0] - pose.x, goal[1] - pose.y
    far = math.hypot(x, y)
    felt = Pose(pose.x, pose.y, pose.yaw - spec.bias)
    off = math.remainder(math.atan2(y, x) - felt.yaw, 2.0 * math.pi)
    turn = GOAL / DAMPING * off * (math.exp(-GOAL_DECAY * far) + GOAL_FLOOR)
    gap = math.inf
    if spec.sight > 0.0:
        seen = _seen(scene, felt, spec.sight + body.reach)
        turn += _repulsion(seen, body)
        gap = _gap(seen, body)
    near = min(1.0, far / spec.slow_distance)
    speed = min(max(0.0, math.cos(off)), gap / spec.gap_time / most[0])
    return Wish(near * speed, near * full(turn / most[1]), off, min(gap, far))


def _seen(scene: Scene, pose: Pose, reach: float) -> Array:
    """Return (N, 3) x ahead, y to the left and radius of what is near, robot frame, m."""
    people = np.column_stack([scene.people[:, :2], scene.people_radius])[scene.present]
    walls = scene.walls
    start, way = walls[:, :2], walls[:, 2:] - walls[:, :2]
    here = np.array([pose.x, pose.y])
    length = np.maximum((way * way).sum(axis=1), 1e-12)
    along = np.clip(((here - start) * way).sum(axis=1) / length, 0.0, 1.0)
    nearest = np.column_stack([start + along[:, None] * way, np.zeros(len(walls))])
    all_of_it = np.concatenate([people, scene.pillars, nearest])
    d = all_of_it[:, :2] - here
    c, s = math.cos(pose.yaw), math.sin(pose.yaw)
    local = np.column_stack([c * d[:, 0] + s * d[:, 1], c * d[:, 1] - s * d[:, 0]])
    found = np.column_stack([local, all_of_it[:, 2]])
    keep = np.hypot(local[:, 0], local[:, 1]) - all_of_it[:, 2] < reach
    near: Array = found[keep & (local[:, 0] > 0.0)]
    return near


def _repulsion(seen: Array, body: RobotBody) -> float:
    """Return the yaw rate away from obstacles, rad/s."""
    if not len(seen):
        return 0.0
    bearing = np.arctan2(seen[:, 1], seen[:, 0])
    gap = np.hypot(seen[:, 0], seen[:, 1]) - seen[:, 2] - body.half_width
    away = np.exp(-ANGLE_DECAY * np.abs(bearing) - DISTANCE_DECAY * np.maximum(gap, 0.0))
    return float(-OBSTACLE / DAMPING * (bearing * away).sum())


def _gap(seen: Array, body: RobotBody) -> float:
    """Return the free way straight ahead, m."""
    ahead = np.abs(seen[:, 1]) < body.half_width + _BESIDE + seen[:, 2]
    free = seen[ahead, 0] - seen[ahead, 2] - body.front
    return max(0.0, float(free.min(initial=math.inf)))
