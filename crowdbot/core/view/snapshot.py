"""People, robots and ground of one moment of a run, from above, as shapes on a map."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from crowdbot.core.trajectories.encounters import people, robot_of
from crowdbot.core.trajectories.person_track import members_of
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array, Point
from crowdbot.core.view.map_content import arrow
from crowdbot.core.view.shapes import SPEEDS, Disc, Shape, Text
from crowdbot.core.view.world import Map

FASTEST = 2.0  # m/s, top of the colours
_TRAIL = 3.0  # s
_BODY = 0.4  # m, people so far outside are seen in part


def sample_at(run: Trajectories, t: float) -> int:
    """Return the index of the last sample at or before a time, s."""
    return max(0, int(np.searchsorted(run.t, t + 1e-9, side="right")) - 1)


def ground(run: Trajectories, world: Map) -> Iterator[Shape]:
    """Yield the goal and the walls."""
    if run.goal_zone is not None:
        yield world.path(_points(run.goal_zone), "goal", closed=True)
    for x0, y0, x1, y1 in () if run.walls is None else run.walls.tolist():
        yield world.path([(x0, y0), (x1, y1)], "wall")


def people_at(
    run: Trajectories, sample: int, world: Map, involved: int | None = None
) -> Iterator[Shape]:
    """Yield people, coloured by their speed, with their direction; the one involved is named."""
    crowd = people(run)
    members = () if run.person is None else members_of(crowd, run.person).tolist()
    for i in range(len(crowd.id)):
        x, y = float(crowd.x[sample, i]), float(crowd.y[sample, i])
        if not (
            world.x0 - _BODY < x < world.x1 + _BODY and world.y0 - _BODY < y < world.y1 + _BODY
        ):
            continue  # also where they are absent, NaN
        vx, vy = float(crowd.vx[sample, i]), float(crowd.vy[sample, i])
        speed = math.hypot(vx, vy)
        shade = min(len(SPEEDS) - 1, int(speed / FASTEST * len(SPEEDS)))
        radius = float(crowd.radius[i]) * world.scale
        yield Disc(centre=world.at(x, y), radius=radius, role=f"person-{shade}")
        if i in members:
            yield Disc(centre=world.at(x, y), radius=radius + 4.0, role="wanted")
        if speed > 0.05:
            yield from arrow(world, x, y, math.atan2(vy, vx), speed)
        if i == involved:
            yield Disc(centre=world.at(x, y), radius=radius + 4.0, role="involved")
            px, py = world.at(x, y)
            yield Text(
                at=(px, py - radius - 7.0), text=f"person {int(crowd.id[i])}",
                role="text-route", size=11.0, anchor="middle",
            )  # fmt: skip


def robot_at(run: Trajectories, sample: int, world: Map) -> Iterator[Shape]:
    """Yield the robot with its trail of the last seconds."""
    robot = robot_of(run)
    first = sample_at(run, float(run.t[sample]) - _TRAIL)
    trail = np.column_stack([robot.x, robot.y])[first : sample + 1]
    yield world.path(_points(trail), "route")
    x, y, theta = (float(a[sample]) for a in (robot.x, robot.y, robot.theta))
    c, s = math.cos(theta), math.sin(theta)
    outline = run.robot_footprint
    if outline is None or len(outline) < 3:
        yield Disc(centre=world.at(x, y), radius=robot.radius * world.scale, role="robot")
    else:
        turned = outline @ np.array([[c, s], [-s, c]]) + (x, y)
        yield world.path(_points(turned), "robot", closed=True)
    nose = max(robot.radius, 0.2)
    yield world.path([(x, y), (x + nose * c, y + nose * s)], "robot-nose")


def _points(rows: Array) -> list[Point]:
    return [(float(x), float(y)) for x, y in rows]
