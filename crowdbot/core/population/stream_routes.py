"""Routes of people in streams: goals with the areas around them, pauses, and the end."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from crowdbot.core.types.arrays import Point
from crowdbot.dsl.scenario.crowd import AtGoal
from crowdbot.dsl.scenario.streams import Lanes
from crowdbot.dsl.spec.areas import Area, GoalArea

#: Goals of a walk from border to border; its shortest leg, as a part of the smaller side.
_TURNS, _SHORTEST = 16, 0.4
_POINT = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Route:
    """Goals and pauses of one person of a stream.

    Attributes:
        goals: points, or centres of areas, m.
        sizes: size of the area around each goal: own x and y, rotation; zeros: a point.
        at_goal: behaviour after the last.
        pauses: time at each, s; empty if none.
        origin: area of entry, if there is a choice.
    """

    goals: tuple[Point, ...]
    sizes: tuple[tuple[float, float, float], ...]
    at_goal: AtGoal
    pauses: tuple[float, ...] = ()
    origin: Area | None = None

    def columns(self) -> dict[str, Any]:
        """Return the route's columns for one person's row of the agents' table."""
        area = self.origin
        some = any(size != _POINT for size in self.sizes)
        return {
            "goals": self.goals,
            "at_goal": self.at_goal,
            "goal_areas": self.sizes if some else (),
            "pauses": self.pauses if any(self.pauses) else (),
            "origin": () if area is None else (*area.centre, *area.size, area.rotation),
        }


def route_through(
    areas: Sequence[Area],
    at_goal: AtGoal,
    *,
    before: Sequence[tuple[Point, float]] = (),
    origin: Area | None = None,
) -> Route:
    """Return a route through areas, any point of each.

    Args:
        before: first points, and the time at each, s.
    """
    return Route(
        goals=(*(point for point, _ in before), *(area.centre for area in areas)),
        sizes=(*(_POINT for _ in before), *((*a.size, a.rotation) for a in areas)),
        at_goal=at_goal,
        pauses=(*(pause for _, pause in before), *(0.0 for _ in areas)) if before else (),
        origin=origin,
    )


def lane_of(area: Area, lanes: Lanes | None, lane: int) -> Area:
    """Return one lane of an area; the whole area if it has none."""
    if lanes is None:
        return area
    width = area.size[1] / lanes.of
    middle = area.point(0.0, (lane + 0.5) * width - 0.5 * area.size[1])
    return Area(centre=middle, size=(area.size[0], width), rotation=area.rotation)


def straight_on(start: Point, angle: float, trip: float) -> Route:
    """Return an endless path in one direction, in trips of this many metres."""
    goal = (start[0] + trip * math.cos(angle), start[1] + trip * math.sin(angle))
    return Route((start, goal), (_POINT, _POINT), "onward")


def border_to_border(
    area: Area, start: Point, radius: float, angles: Sequence[float], rng: np.random.Generator
) -> Route:
    """Return an endless route: straight to an area's border, then in a new direction, and so on.

    Args:
        angles: directions to sample from, rad; if empty, any.
        radius: radius of the person, m.
    """
    half = [max(0.5 * side - 2.0 * radius, 0.0) for side in area.size]
    least = _SHORTEST * 2.0 * min(half)
    goals: list[Point] = []
    u, v = area.own(*start)
    for turn in range(_TURNS):
        for _ in range(100):
            angle = (
                angles[int(rng.integers(len(angles)))] if angles else rng.uniform(-math.pi, math.pi)
            )
            reach = _to_border(u, v, angle - area.rotation, half)
            if reach >= (least if turn else 0.0):
                break
        else:  # a corner that the given directions cannot leave: back through the centre
            angle, reach = math.atan2(-v, -u) + area.rotation, 2.0 * math.hypot(u, v)
        own = angle - area.rotation
        u, v = u + reach * math.cos(own), v + reach * math.sin(own)
        goals.append(area.point(u, v))
    side = 4.0 * radius
    return Route(tuple(goals), ((side, side, area.rotation),) * len(goals), "loop")


def _to_border(u: float, v: float, angle: float, half: Sequence[float]) -> float:
    """Return the distance from (u, v) to the sides of a box around 0 in a direction, m."""
    found = math.inf
    for at, step, side in ((u, math.cos(angle), half[0]), (v, math.sin(angle), half[1])):
        if abs(step) > 1e-9:
            found = min(found, (math.copysign(side, step) - at) / step)
    return max(found, 0.0)


def stroll(
    areas: Mapping[str, GoalArea], begin: Sequence[str], visits: int, rng: np.random.Generator
) -> list[str]:
    """Return the next area of a stroll: a linked one if there is one, else any other."""
    names = [begin[int(rng.integers(len(begin)))]]
    while len(names) < visits:
        here = names[-1]
        onward = list(areas[here].next) or [n for n in begin if n != here] or [here]
        names.append(onward[int(rng.integers(len(onward)))])
    return names
