"""Shortest ways, held against shapely and scipy, which know nothing of corners and trees."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped,unused-ignore]
from scipy.sparse.csgraph import dijkstra

from crowdbot.core.crowd.routing import route_map
from crowdbot.core.crowd.routing.free_space import FreeSpace
from crowdbot.core.crowd.routing.route_map import RouteMap
from crowdbot.core.crowd.routing.sight import Sight, crosses, is_clear
from crowdbot.errors import InputError
from tests.core.crowd.routing.floor_plans import outline, rooms

NO_PILLARS = np.zeros((0, 3))
NO_POINTS = np.zeros((0, 2))
RADIUS = 0.3


def _length(way: np.ndarray) -> float:
    return float(np.hypot(*np.diff(way, axis=0).T).sum())


def _expected(space: FreeSpace, start: np.ndarray, goal: np.ndarray) -> float:
    """Length of the shortest way, by visibility between all corners of what is taken."""
    rings = [r for p in shapely.get_parts(space.taken) for r in (p.exterior, *p.interiors)]
    points = np.concatenate([[start, goal], *(np.asarray(r.coords)[:-1] for r in rings)])
    inner = shapely.buffer(space.taken, -1e-6)
    first, second = np.triu_indices(len(points), 1)
    lines = shapely.linestrings(np.stack([points[first], points[second]], axis=1))
    sees = ~shapely.intersects(inner, lines)
    table = np.full((len(points), len(points)), np.inf)
    table[first[sees], second[sees]] = np.hypot(*(points[first] - points[second]).T)[sees]
    return float(dijkstra(table, directed=False, indices=0)[1])


@pytest.mark.parametrize("seed", range(3))
def test_ways_are_shortest(seed: int) -> None:
    rng = np.random.default_rng(seed)
    walls = rooms(rng, 2, 2)
    pillars = np.array([[2.5, 2.5, 0.4]])
    found = RouteMap.of(walls, pillars, RADIUS, NO_POINTS)
    places = [p for p in rng.uniform(0.5, 9.5, (40, 2)) if found.space.part_of(p[None])[0] >= 0]
    for start, goal in zip(places[:6], places[6:12], strict=True):
        expected = _expected(found.space, start, goal)
        way = found.way(tuple(start), tuple(goal))
        same = np.ptp(found.space.part_of(np.array([start, goal]))) == 0
        assert math.isfinite(expected) == same
        if same:
            assert _length(way) == pytest.approx(expected, rel=0.01)
            for a, b in pairwise(way):  # along the margin at the nearest
                assert (
                    shapely.LineString([a, b]).distance(
                        shapely.multilinestrings(walls.reshape(-1, 2, 2))
                    )
                    > RADIUS - 0.02
                )


def test_around_one_wall() -> None:
    walls = np.array(outline(-0.1, -5.0, 0.1, 2.0))
    found = RouteMap.of(walls, NO_PILLARS, RADIUS, np.array([[-4.0, 0.0], [4.0, 0.0]]))
    way = found.way((-4.0, 0.0), (4.0, 0.0))
    assert len(way) in (3, 4)
    assert np.all(way[1:-1, 1] > 2.0 + RADIUS)
    # a taut string around a square corner and one around a round one
    assert 2 * math.hypot(4.0, 2.3) - 0.1 < _length(way) < 2 * math.hypot(4.0, 2.31) + 0.4


def test_where_no_way_leads() -> None:
    walls = np.array(outline(2.0, 2.0, 6.0, 6.0))[:, [2, 3, 0, 1]]  # a room without a door
    space = FreeSpace.of(walls, NO_PILLARS, RADIUS, NO_POINTS)
    inside, outside, within = space.part_of(np.array([[4.0, 4.0], [8.0, 4.0], [2.1, 4.0]]))
    assert inside >= 0
    assert outside >= 0
    assert inside != outside
    assert within == -1


@pytest.mark.parametrize(("door", "radius", "open_"), [(0.8, 0.33, True), (0.8, 0.42, False)])
def test_who_is_too_wide_for_a_door_finds_no_way(door: float, radius: float, open_: bool) -> None:
    walls = np.array(outline(-0.1, -9.0, 0.1, -door / 2) + outline(-0.1, door / 2, 0.1, 9.0))
    border = np.array([[-5, -9, 5, -9], [5, -9, 5, 9], [5, 9, -5, 9], [-5, 9, -5, -9]])
    space = FreeSpace.of(np.concatenate([walls, border]), NO_PILLARS, radius, NO_POINTS)
    left, right = space.part_of(np.array([[-2.0, 0.0], [2.0, 0.0]]))
    assert (left == right) is np.bool_(open_)


@pytest.mark.parametrize("seed", range(5))
def test_sight_is_what_no_edge_crosses(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rings = [rng.uniform(-9, 9, 2) + rng.normal(0, 1.5, (rng.integers(3, 7), 2)) for _ in range(25)]
    sight = Sight.of(rings)
    for px, py, qx, qy in rng.uniform(-14, 14, (300, 4)).tolist():
        expected = not any(crosses(px, py, qx, qy, edge) for edge in sight.edges)
        assert is_clear(px, py, qx, qy, sight) == expected
        assert is_clear(px, py, px, qy, sight) == (
            not any(crosses(px, py, px, qy, edge) for edge in sight.edges)
        )


def test_an_empty_floor_has_no_corners() -> None:
    found = RouteMap.of(np.zeros((0, 4)), NO_PILLARS, RADIUS, NO_POINTS)
    assert found.count == 0
    assert found.way((0.0, 0.0), (3.0, 4.0)).tolist() == [[0.0, 0.0], [3.0, 4.0]]


def test_too_many_corners(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(route_map, "MOST_CORNERS", 10)
    with pytest.raises(InputError, match="more than 10; simplify it"):
        RouteMap.of(rooms(np.random.default_rng(0), 2, 2), NO_PILLARS, RADIUS, NO_POINTS)
