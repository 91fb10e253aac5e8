"""The surroundings of a plan: people, who may give way, and static obstacles; compiled."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from crowdbot.plugin import Array, kernel
from crowdbot.plugins.planners.shared.distance_field_build import distance_at

#: Time step of a rollout, s.
STEP = 0.16


class TimeToGo(NamedTuple):
    """The time to the goal from places and times ahead, where that is known beforehand.

    Attributes:
        values: (T, I, J) from each node, s; empty: it is not known, and the distance counts.
        corner: place of the first node, m.
        direction: cosine and sine of the direction in which I counts.
        cell: between nodes, m.
        step: between layers, s.
        since: age of the first layer, s.
    """

    values: Array
    corner: tuple[float, float]
    direction: tuple[float, float]
    cell: float
    step: float
    since: float


#: Nothing is known beforehand.
UNKNOWN = TimeToGo(np.zeros((0, 0, 0)), (0.0, 0.0), (1.0, 0.0), 1.0, 1.0, 0.0)


class PlanWorld(NamedTuple):
    """The surroundings that plans are tested against.

    Attributes:
        people: (N, 5) x, y, vx, vy, radius; m, m/s.
        predicted: (T, N, 2) where they will be after each `STEP`, m; empty: they keep their
            velocity.
        field: distances to what stands, `DistanceField.values`.
        corner: of the field, m.
        robot: (K, 3) discs that hold the robot, in its frame, m.
        goal: m.
        yields: (N,) time to contact from which each person gives way, s, 0: never; empty: people
            do not respond to the robot. If they do, they must be predicted as if it was not there.
        moved: (N, 5) room for people on their way, if they respond.
        to_go: the time to the goal.
    """

    people: Array
    predicted: Array
    field: Array
    corner: tuple[float, float]
    robot: Array
    goal: tuple[float, float]
    yields: Array
    moved: Array
    to_go: TimeToGo


@kernel
def way_left(world: PlanWorld, x: float, y: float, t: float, speed: float) -> float:
    """Return the way that is left to the goal after ``t`` seconds, m.

    The distance; or, where the time is known, the way that a speed makes in it.
    """
    gx, gy = world.goal[0] - x, world.goal[1] - y
    away, known = math.sqrt(gx * gx + gy * gy), world.to_go
    layers, rows, columns = known.values.shape
    if layers == 0:
        return away
    dx, dy = x - known.corner[0], y - known.corner[1]
    u = (known.direction[0] * dx + known.direction[1] * dy) / known.cell
    w = (known.direction[0] * dy - known.direction[1] * dx) / known.cell
    at = (t + known.since) / known.step
    i, j, k = math.floor(u), math.floor(w), math.floor(at)
    if not (0 <= i < rows - 1 and 0 <= j < columns - 1 and 0 <= k < layers - 1):
        return away
    a, b, c, v = u - i, w - j, at - k, known.values
    now = (1 - a) * ((1 - b) * v[k, i, j] + b * v[k, i, j + 1])
    now += a * ((1 - b) * v[k, i + 1, j] + b * v[k, i + 1, j + 1])
    soon = (1 - a) * ((1 - b) * v[k + 1, i, j] + b * v[k + 1, i, j + 1])
    soon += a * ((1 - b) * v[k + 1, i + 1, j] + b * v[k + 1, i + 1, j + 1])
    return speed * float((1 - c) * now + c * soon)


@kernel
def gaps(world: PlanWorld, x: float, y: float, yaw: float, t: float) -> tuple[float, float]:
    """Return the gap from the robot to the nearest person in ``t`` seconds, and to walls, m."""
    person, wall = math.inf, math.inf
    c, s = math.cos(yaw), math.sin(yaw)
    step = min(round(t / STEP), world.predicted.shape[0]) - 1
    known = step >= 0
    for k in range(world.robot.shape[0]):
        px = x + c * world.robot[k, 0] - s * world.robot[k, 1]
        py = y + s * world.robot[k, 0] + c * world.robot[k, 1]
        r = world.robot[k, 2]
        wall = min(wall, distance_at(world.field, world.corner, px, py) - r)
        for i in range(world.people.shape[0]):
            if known:
                dx, dy = world.predicted[step, i, 0] - px, world.predicted[step, i, 1] - py
            else:
                dx = world.people[i, 0] + t * world.people[i, 2] - px
                dy = world.people[i, 1] + t * world.people[i, 3] - py
            most = person + r + world.people[i, 4]
            square = dx * dx + dy * dy
            if most > 0.0 and square > most * most:
                continue  # most cases
            person = min(person, math.sqrt(square) - r - world.people[i, 4])
    return person, wall


@kernel
def at_first(world: PlanWorld) -> PlanWorld:
    """Return the surroundings with people at their positions at the beginning of a plan."""
    for i in range(world.people.shape[0]):
        for k in range(world.people.shape[1]):
            world.moved[i, k] = world.people[i, k]
    return PlanWorld(
        world.moved, world.predicted, world.field, world.corner, world.robot, world.goal,
        world.yields, world.moved, world.to_go,
    )  # fmt: skip


@kernel
def extent_of(robot: Array) -> float:
    """Return the largest distance of the robot's discs from its centre, m."""
    most = 0.0
    for k in range(robot.shape[0]):
        most = max(most, math.sqrt(robot[k, 0] ** 2 + robot[k, 1] ** 2) + robot[k, 2])
    return most
