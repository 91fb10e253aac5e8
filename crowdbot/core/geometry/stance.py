"""The place where a robot should be beside a person, and the robot's deviation from it.

Functions take numbers or arrays over time. Angles are in rad, in an inertial frame.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from crowdbot.core.geometry.footprint import Footprint
from crowdbot.core.types.arrays import Array
from crowdbot.core.types.motion import Pose
from crowdbot.core.types.person_task import PersonTask
from crowdbot.core.types.robot import RobotBody

#: How far the robot may turn off the person (or, side by side, off the person's heading), rad.
LOOKS_AT = math.radians(45.0)
#: Borders of the intimate, personal and social zones (Hall 1966), m.
INTIMATE, PERSONAL, SOCIAL = 0.45, 1.2, 3.6
#: Members of a group that face together less than this (length of the mean of unit vectors) face
#: each other: the group has no front.
_TOGETHER = 0.3


class PersonCircle(NamedTuple):
    """A person, or a group as a circle: numbers, or arrays (N,) over time; NaN where absent.

    ``heading`` is NaN where there is no front. ``radius`` is that of the circle.
    """

    x: Array
    y: Array
    heading: Array
    radius: Array


class RelativePosition(NamedTuple):
    """A robot's position relative to a person: numbers, or arrays (N,).

    Attributes:
        gap: between the surfaces, m; negative inside.
        around: direction to the robot relative to the person's front, positive to the left.
        bearing: direction to the person relative to the robot's front.
        turned: the robot's heading relative to the person's.
    """

    gap: Array
    around: Array
    bearing: Array
    turned: Array


def together(x: Array, y: Array, facing: Array, radius: Array) -> PersonCircle:
    """Return people as one: a person alone, or the circle around a group.

    Args:
        x, y, facing: (N, M) of the members over time, NaN where absent.
        radius: (M,) of their discs, m.
    """
    if x.shape[1] == 1:
        size = np.where(np.isnan(x[:, 0]), np.nan, radius[0])
        return PersonCircle(x[:, 0], y[:, 0], facing[:, 0], size)
    here = ~np.isnan(x)
    count = np.where(here.any(axis=1), here.sum(axis=1), np.nan)
    cx, cy, fx, fy = (
        np.where(here, part, 0.0).sum(axis=1) / count
        for part in (x, y, np.cos(facing), np.sin(facing))
    )
    out = np.hypot(x - cx[:, None], y - cy[:, None]) + radius
    heading = np.where(np.hypot(fx, fy) >= _TOGETHER, np.arctan2(fy, fx), np.nan)
    size = np.where(np.isnan(count), np.nan, np.where(here, out, 0.0).max(axis=1))
    return PersonCircle(cx, cy, heading, size)


def off(
    outline: Footprint, x: Array, y: Array, yaw: Array, person: PersonCircle
) -> RelativePosition:
    """Return a robot's position relative to a person."""
    dx, dy = person.x - x, person.y - y
    c, s = np.cos(yaw), np.sin(yaw)
    ahead, left = c * dx + s * dy, c * dy - s * dx
    return RelativePosition(
        gap=outline.gap(ahead, left) - person.radius,
        around=wrapped(np.arctan2(-dy, -dx) - person.heading),
        bearing=np.arctan2(left, ahead),
        turned=wrapped(yaw - person.heading),
    )


def wrapped(angle: Array) -> Array:
    """Return angles within -pi to pi."""
    turned: Array = np.arctan2(np.sin(angle), np.cos(angle))
    return turned


def wanted_direction(task: PersonTask, around: Array) -> Array:
    """Return the wanted direction from the person's front, on the side where the robot is, rad."""
    if task.kind in ("approach", "lead"):
        return np.zeros_like(around)
    if task.kind == "follow":
        return np.full_like(around, math.pi)
    if task.side == "either":
        return np.where(around >= 0.0, 0.5 * math.pi, -0.5 * math.pi)
    return np.full_like(around, 0.5 * math.pi if task.side == "left" else -0.5 * math.pi)


def in_place(task: PersonTask, position: RelativePosition) -> Array:
    """Return True where a robot is at its place; without a known front, any direction counts."""
    near = np.abs(position.gap - task.distance) <= task.tolerance
    aside = np.abs(wrapped(position.around - wanted_direction(task, position.around)))
    fits = np.isnan(aside) | (aside <= task.angle)
    turned = position.turned if task.kind == "accompany" else position.bearing
    if task.kind == "lead":  # the robot looks where it goes
        return np.asarray(near & fits)
    return np.asarray(near & fits & (np.isnan(turned) | (np.abs(turned) <= LOOKS_AT)))


def place_beside(
    task: PersonTask, body: RobotBody, x: float, y: float, heading: float, robot: Pose
) -> Pose:
    """Return the pose of the robot's base at the centre of its place.

    Args:
        task: what to do, with the person's radius.
        x, y, heading: of the person; heading NaN: no front.
        robot: where the robot is: it decides the side, and the direction where there is no front.
    """
    seen_from = math.atan2(robot.y - y, robot.x - x)
    direction = seen_from
    if not math.isnan(heading):
        around = wrapped(np.array(seen_from - heading))
        direction = heading + float(wanted_direction(task, around))
    beside = task.kind == "accompany"
    reach = {"accompany": body.half_width, "lead": body.back}.get(task.kind, body.front)
    away = task.radius + task.distance + reach
    ahead = heading if beside or task.kind == "lead" else direction + math.pi
    yaw = robot.yaw if math.isnan(ahead) else math.remainder(ahead, 2.0 * math.pi)
    return Pose(x + away * math.cos(direction), y + away * math.sin(direction), yaw)
