"""Paths of people with path finding, and the mesh used for it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from crowdbot.core.population.realisation import Realisation
from crowdbot.core.types.arrays import Point
from crowdbot.core.types.environment import EnvironmentParts
from crowdbot.dsl.scenario.crowd import Crowd

if TYPE_CHECKING:
    from crowdbot.core.crowd.routing.free_space import FreeSpace
    from crowdbot.core.crowd.routing.route_map import RouteMap

#: Largest number of links that are drawn.
_MOST_LINKS = 3000


@dataclass(frozen=True, slots=True, kw_only=True)
class Ways:
    """Routing data to draw, world frame, m.

    Attributes:
        of_agents: each agent's path through its goals; empty without goals.
        margins: limits for the centres of the largest bodies, in the occupied parts of the floor
            only.
        links: pairs of corners that paths may connect.
    """

    of_agents: tuple[tuple[Point, ...], ...]
    margins: tuple[tuple[Point, ...], ...] = ()
    links: tuple[tuple[Point, Point], ...] = ()


def ways_of(crowd: Crowd | None, people: Realisation, parts: EnvironmentParts) -> Ways:
    """Return the paths as planned at the start; straight ones for agents without path finding."""
    straight = [_stops(people, i) for i in range(len(people))]
    if crowd is None or crowd.routing is None or crowd.routing.kind != "mesh":
        return Ways(of_agents=tuple(map(tuple, straight)))
    # Imports compiled code, which only these drawings need.
    from crowdbot.core.crowd.routing.route_map import RouteMap
    from crowdbot.core.crowd.routing.router import rounded

    walls, pillars, _ = parts.in_the_way(crowd.body.height)
    points = np.array([p for way in straight for p in way], np.float64).reshape(-1, 2)
    sizes = rounded(people.radius)
    largest = crowd.body.radius if not len(people) else float(sizes.max())
    maps = {
        float(size): RouteMap.of(walls, pillars, float(size), points)
        for size in {*sizes.tolist(), largest}
    }
    found = []
    for i, stops in enumerate(straight):
        way = list(stops[:1])
        for start, goal in pairwise(stops):
            leg = maps[float(sizes[i])].way(start, goal).tolist()
            way += [(float(x), float(y)) for x, y in leg[1:]]
        found.append(tuple(way))
    routes = maps[largest]
    places = [box.mean(axis=0) for box in parts.zones.values()]
    places += [
        np.array([0.5 * (x0 + x1), 0.5 * (y0 + y1)]) for x0, x1, y0, y1 in parts.portals.values()
    ]
    used = routes.space.holding(np.concatenate([points, np.array(places).reshape(-1, 2)]))
    return Ways(of_agents=tuple(found), margins=_margins(used), links=_links(routes, used))


def _stops(people: Realisation, i: int) -> list[Point]:
    """Return an agent's start and its goals in order, closed if it walks in a loop."""
    route = people.goals[i]
    if not route:
        return []
    back = route[:1] if people.at_goal[i] == "loop" and len(route) > 2 else ()
    return [(float(people.x[i]), float(people.y[i])), *route, *back]


def _margins(used: FreeSpace) -> tuple[tuple[Point, ...], ...]:
    return tuple(tuple((float(x), float(y)) for x, y in ring) for ring in used.borders())


def _links(routes: RouteMap, used: FreeSpace) -> tuple[tuple[Point, Point], ...]:
    corners = routes.corners
    from crowdbot.core.crowd.routing.corners import X, Y

    if len(corners.linked) > 2 * _MOST_LINKS:
        return ()
    here = used.holds(corners.table[:, [X, Y]])
    at = [(float(x), float(y)) for x, y in corners.table[:, [X, Y]]]
    return tuple(
        (at[v], at[w])
        for v in np.flatnonzero(here).tolist()
        for w in corners.linked[corners.first[v] : corners.first[v + 1]].tolist()
        if v < w
    )
