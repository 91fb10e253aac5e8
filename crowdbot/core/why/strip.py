"""A strip of pictures: the robot and its surroundings from above, before the decisive moment."""

from __future__ import annotations

from crowdbot.core.trajectories.encounters import robot_of
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.view.shapes import Drawing, Path, Text
from crowdbot.core.view.snapshot import ground, people_at, robot_at, sample_at
from crowdbot.core.view.world import Map
from crowdbot.core.why.decisive_moment import DecisiveMoment

#: Times of the pictures before the moment, s.
BEFORE = (5.0, 4.0, 3.0, 2.0, 1.0, 0.0)
_RADIUS = 3.5  # m, half the width of a picture
_SCALE, _TOP, _SIDE = 34.0, 26.0, 6.0  # px per metre, px, px


def strip(run: Trajectories, moment: DecisiveMoment) -> list[Drawing]:
    """Return pictures at `BEFORE` s before the moment, as far as the run has them.

    All show the surroundings of the robot's place at the moment; the person involved is named.
    """
    times = [t for t in (moment.t - b for b in BEFORE) if t >= float(run.t[0])]
    last = sample_at(run, moment.t)
    robot = robot_of(run)
    x, y = float(robot.x[last]), float(robot.y[last])
    world = Map(x - _RADIUS, y - _RADIUS, x + _RADIUS, y + _RADIUS, _SCALE, _TOP, _SIDE)
    return [_picture(run, moment, t, world) for t in times]


def _picture(run: Trajectories, moment: DecisiveMoment, t: float, world: Map) -> Drawing:
    sample = sample_at(run, t)
    x, y, width, height = world.box
    frame = ((x, y), (x + width, y), (x + width, y + height), (x, y + height))
    before = moment.t - t
    title = f"{t:.1f} s" + (f", {before:.0f} s before" if before > 0.5 else "")
    return Drawing(
        width=width + 2 * _SIDE,
        height=height + 2 * _TOP,
        map_box=world.box,
        title=title,
        shapes=(
            Path(points=frame, role="floor", closed=True, inside=False),
            *ground(run, world),
            *people_at(run, sample, world, moment.agent),
            *robot_at(run, sample, world),
            Path(points=frame, role="frame", closed=True, inside=False),
            Text(at=(x, y - 8.0), text=title, role="text-strong", size=13.0),
        ),
    )
