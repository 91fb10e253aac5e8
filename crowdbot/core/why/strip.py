"""A strip of pictures: the robot and its surroundings from above, before the decisive moment."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from crowdbot.core.trajectories.encounters import people, robot_of
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.arrays import Array, Point
from crowdbot.core.view.map_content import arrow
from crowdbot.core.view.shapes import SPEEDS, Disc, Drawing, Path, Shape, Text
from crowdbot.core.view.world import LEFT, Map
from crowdbot.core.why.decisive_moment import DecisiveMoment

#: Times of the pictures before the moment, s.
BEFORE = (5.0, 4.0, 3.0, 2.0, 1.0, 0.0)
_RADIUS = 3.5  # m, half the width of a picture
_SCALE, _TOP = 34.0, 26.0  # px per metre, px
_FASTEST = 2.0  # m/s, top of the colours
_TRAIL = 3.0  # s
_BODY = 0.4  # m, people so far outside are seen in part


def strip(run: Trajectories, moment: DecisiveMoment) -> list[Drawing]:
    """Return pictures at `BEFORE` s before the moment, as far as the run has them.

    All show the surroundings of the robot's place at the moment; the person involved is named.
    """
    times = [t for t in (moment.t - b for b in BEFORE) if t >= float(run.t[0])]
    last = _sample(run, moment.t)
    robot = robot_of(run)
    x, y = float(robot.x[last]), float(robot.y[last])
    world = Map(x - _RADIUS, y - _RADIUS, x + _RADIUS, y + _RADIUS, _SCALE, _TOP)
    return [_picture(run, moment, t, world) for t in times]


def _sample(run: Trajectories, t: float) -> int:
    return max(0, int(np.searchsorted(run.t, t + 1e-9, side="right")) - 1)


def _picture(run: Trajectories, moment: DecisiveMoment, t: float, world: Map) -> Drawing:
    sample = _sample(run, t)
    x, y, width, height = world.box
    frame = ((x, y), (x + width, y), (x + width, y + height), (x, y + height))
    before = moment.t - t
    title = f"{t:.1f} s" + (f", {before:.0f} s before" if before > 0.5 else "")
    return Drawing(
        width=width + 2 * LEFT,
        height=height + 2 * _TOP,
        map_box=world.box,
        title=title,
        shapes=(
            Path(points=frame, role="floor", closed=True, inside=False),
            *_ground(run, world),
            *_people(run, sample, world, moment.agent),
            *_robot(run, sample, world),
            Path(points=frame, role="frame", closed=True, inside=False),
            Text(at=(x, y - 8.0), text=title, role="text-strong", size=13.0),
        ),
    )


def _ground(run: Trajectories, world: Map) -> Iterator[Shape]:
    if run.goal_zone is not None:
        yield world.path(_points(run.goal_zone), "goal", closed=True)
    for x0, y0, x1, y1 in () if run.walls is None else run.walls.tolist():
        yield world.path([(x0, y0), (x1, y1)], "wall")


def _people(run: Trajectories, sample: int, world: Map, involved: int | None) -> Iterator[Shape]:
    crowd = people(run)
    for i in range(len(crowd.id)):
        x, y = float(crowd.x[sample, i]), float(crowd.y[sample, i])
        if not (
            world.x0 - _BODY < x < world.x1 + _BODY and world.y0 - _BODY < y < world.y1 + _BODY
        ):
            continue  # also where they are absent, NaN
        vx, vy = float(crowd.vx[sample, i]), float(crowd.vy[sample, i])
        speed = math.hypot(vx, vy)
        shade = min(len(SPEEDS) - 1, int(speed / _FASTEST * len(SPEEDS)))
        radius = float(crowd.radius[i]) * world.scale
        yield Disc(centre=world.at(x, y), radius=radius, role=f"person-{shade}")
        if speed > 0.05:
            yield from arrow(world, x, y, math.atan2(vy, vx), speed)
        if i == involved:
            yield Disc(centre=world.at(x, y), radius=radius + 4.0, role="involved")
            px, py = world.at(x, y)
            yield Text(
                at=(px, py - radius - 7.0), text=f"person {int(crowd.id[i])}",
                role="text-route", size=11.0, anchor="middle",
            )  # fmt: skip


def _robot(run: Trajectories, sample: int, world: Map) -> Iterator[Shape]:
    robot = robot_of(run)
    first = _sample(run, float(run.t[sample]) - _TRAIL)
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
