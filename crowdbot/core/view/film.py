"""Pictures of a recorded run from above, one after the other."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from PIL import Image

from crowdbot.core.recording.placed_drawings import PlacedDrawing
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.view.raster import ground_of, to_image
from crowdbot.core.view.render import legend_of
from crowdbot.core.view.shapes import LIGHT, Drawing, Path, Shape, Text
from crowdbot.core.view.snapshot import FASTEST, ground, people_at, robot_at, sample_at
from crowdbot.core.view.thoughts import thoughts_at
from crowdbot.core.view.world import LEFT, Map
from crowdbot.errors import InputError

#: m: largest extent that is shown whole by default; and the window that follows a robot.
_WHOLE, _WINDOW = 26.0, (16.0, 10.0)
_HEAD, _GAP = 34.0, 20.0  # px above the map, and between it and the legend
_PERSON = 0.3  # m, kept around people


@dataclass(frozen=True, slots=True, kw_only=True)
class FilmedRun:
    """A run to be filmed.

    Attributes:
        tracks: its trajectories, once for each robot; one without a robot for people alone.
        title: the head of each picture.
        width: of a picture, px.
        follow: True to follow the first robot, False to show all; None: all if that is small.
        colours: `LIGHT` or `DARK`.
        legend: True for a legend and a scale below the map.
        drawings: what the planners of all robots drew, once for each robot, in the order of time.
    """

    tracks: Sequence[Trajectories]
    title: str
    width: int = 960
    follow: bool | None = None
    colours: Mapping[str, str] = field(default_factory=lambda: LIGHT)
    drawings: Sequence[Sequence[PlacedDrawing]] = ()
    legend: bool = True

    @property
    def end(self) -> float:
        """Return the time of the last sample, s."""
        return float(self.tracks[0].t[-1])

    def times(self, first: float, last: float | None, rate: float, speed: float) -> list[float]:
        """Return the times of the pictures of a film, s.

        Args:
            first, last: of the run, s; None for its end.
            rate: pictures a second.
            speed: how many times faster than real time.

        Raises:
            InputError: there is nothing in between.
        """
        until = self.end if last is None else min(last, self.end)
        if not 0.0 <= first < until:
            raise InputError(
                f"there is nothing to film from {first:g} s to {until:g} s: the run lasts "
                f"{self.end:g} s"
            )
        count = math.ceil((until - first) * rate / speed)
        return [first + i * speed / rate for i in range(count)]

    def images(self, times: Sequence[float]) -> Iterator[Image.Image]:
        """Yield a picture for each time, all of one size."""
        whole = self._whole()
        fixed: Image.Image | None = None
        for t in times:
            world = whole or self._around_robot(t)
            drawing = self._drawing(t, world)
            if whole is None:
                still = ground_of(drawing, self.colours, self._still(world))
            else:
                fixed = fixed or ground_of(drawing, self.colours, self._still(world))
                still = fixed
            yield to_image(drawing, self.colours, still)

    def _still(self, world: Map) -> tuple[Shape, ...]:
        x, y, width, height = world.box
        frame = ((x, y), (x + width, y), (x + width, y + height), (x, y + height))
        floor = Path(points=frame, role="floor", closed=True)
        return (floor, *world.grid(), *ground(self.tracks[0], world), *self._foot(world)[0])

    def _foot(self, world: Map) -> tuple[list[Shape], float]:
        """Return legend and scale below the map, and the bottom edge, px."""
        x, y, width, height = world.box
        if not self.legend:
            return [], y + height + _GAP
        return legend_of(self._entries(), world, x, y + height + _GAP, x + width)

    def _entries(self) -> Iterator[tuple[str, str]]:
        """Yield role and label of what the pictures show, for a legend."""
        if any(run.robot is not None for run in self.tracks):
            yield "robot", "robot"
            yield "route", "its path"
        if self.tracks[0].agents is not None:
            yield "ramp", f"people, 0–{FASTEST:g} m/s"
        if any(run.goal_zone is not None for run in self.tracks):
            yield "goal", "goal"
        if any(self.drawings):
            yield "thought", "drawn by the planner"

    def _drawing(self, t: float, world: Map) -> Drawing:
        x, y, width, _ = world.box
        first = self.tracks[0]
        shapes: list[Shape] = []
        if first.agents is not None:
            shapes += people_at(first, sample_at(first, t), world)
        for run in self.tracks:
            if run.robot is not None:
                shapes += robot_at(run, sample_at(run, t), world)
        thoughts = [shape for drawn in self.drawings for shape in thoughts_at(drawn, t, world)]
        shapes += sorted(thoughts, key=lambda shape: isinstance(shape, Text))
        shapes.append(Text(at=(x, y - 11.0), text=self.title, role="text-strong", size=13.0))
        clock = Text(at=(x + width, y - 11.0), text=f"{t:.1f} s", role="text-muted", size=13.0,
                     anchor="end")  # fmt: skip
        return Drawing(
            width=width + 2 * LEFT / 3, height=self._foot(world)[1],
            map_box=world.box, title=self.title, shapes=(*shapes, clock),
        )  # fmt: skip

    def _whole(self) -> Map | None:
        """Return the map of everything; None if the robot is followed."""
        x0, y0, x1, y1 = _extent(self.tracks)
        small = max(x1 - x0, y1 - y0) <= _WHOLE
        has_robot = self.tracks[0].robot is not None
        if has_robot and (self.follow or (self.follow is None and not small)):
            return None
        return self._map(x0, y0, x1, y1)

    def _around_robot(self, t: float) -> Map:
        run = self.tracks[0]
        assert run.robot is not None
        sample = sample_at(run, t)
        x, y = float(run.robot.x[sample]), float(run.robot.y[sample])
        wide, high = _WINDOW
        return self._map(x - wide / 2, y - high / 2, x + wide / 2, y + high / 2)

    def _map(self, x0: float, y0: float, x1: float, y1: float) -> Map:
        scale = (self.width - 2 * LEFT / 3) / (x1 - x0)
        return Map(x0, y0, x1, y1, scale, _HEAD, LEFT / 3)


def _extent(tracks: Sequence[Trajectories]) -> tuple[float, float, float, float]:
    """Return the smallest rectangle around walls, goals, robots and people, m."""
    points = []
    for run in tracks:
        if run.robot is not None:
            points.append(np.column_stack([run.robot.x, run.robot.y]))
        if run.goal_zone is not None:
            points.append(np.asarray(run.goal_zone))
    first = tracks[0]
    if first.agents is not None:
        points.append(np.column_stack([first.agents.x.ravel(), first.agents.y.ravel()]))
    if first.walls is not None:
        points += [first.walls[:, :2], first.walls[:, 2:]]
    everything = np.concatenate(points) if points else np.zeros((1, 2))
    known = everything[np.isfinite(everything).all(axis=1)]
    x0, y0 = (known.min(axis=0) - 2 * _PERSON).tolist()
    x1, y1 = (known.max(axis=0) + 2 * _PERSON).tolist()
    return x0, y0, x1, y1
