"""Surroundings of a plan: people, some of whom give way, and static obstacles; compiled."""

from __future__ import annotations

import math
from typing import NamedTuple

from crowdbot.plugin import Array, kernel
from crowdbot.plugins.planners.shared.distance_field_build import distance_at

#: Time step of a rollout, s.
STEP = 0.16


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
    """

    people: Array
    predicted: Array
    field: Array
    corner: tuple[float, float]
    robot: Array
    goal: tuple[float, float]
    yields: Array
    moved: Array


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
        world.yields, world.moved,
    )  # fmt: skip


@kernel
def extent_of(robot: Array) -> float:
    """Return the largest distance of the robot's discs from its centre, m."""
    most = 0.0
    for k in range(robot.shape[0]):
        most = max(most, math.sqrt(robot[k, 0] ** 2 + robot[k, 1] ** 2) + robot[k, 2])
    return most
