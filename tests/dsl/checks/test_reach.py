"""Reach without a numbers library: it never refuses a way that there is."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crowdbot.core.crowd.routing.free_space import FreeSpace
from crowdbot.dsl.checks.reach import Reach, wide_reach_of
from crowdbot.dsl.spec.outlines import contains, first_crossing, is_convex, signed_area
from crowdbot.plugin import Face, Pillar, Place, Solid

HEIGHTS = (0.0, 2.5)
BOX = (0.0, 12.0, 0.0, 8.0)


def _closed(x0: float, x1: float, y0: float, y1: float) -> Face:
    points = ((x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0))
    return Face(points=points, heights=HEIGHTS)


def _wall(x: float, y0: float, y1: float) -> Solid:
    outline = ((x, y0), (x + 0.2, y0), (x + 0.2, y1), (x, y1))
    return Solid(outline=outline, heights=HEIGHTS)


def _room(door: float) -> Place:
    walls = (_wall(6.0, 0.0, 4.0), _wall(6.0, 4.0 + door, 8.0))
    return Place(faces=(_closed(*BOX),), solids=walls)


@pytest.mark.parametrize(("door", "open_"), [(0.0, False), (0.3, False), (0.8, True), (2.0, True)])
def test_doors(door: float, open_: bool) -> None:
    reach = Reach(_room(door), 0.3, BOX)
    assert reach.connects((1.0, 1.0), (10.0, 7.0)) == open_
    assert reach.connects((1.0, 1.0), (4.0, 7.0))
    left, right = ((1, 1), (2, 1), (2, 2)), ((9, 1), (10, 1), (10, 2))
    assert reach.connects_areas(left, right) == open_
    both = ((1, 1), (11, 1), (11, 2), (1, 2))  # an area on both sides of the wall
    assert reach.connects_areas(both, right)
    assert not reach.is_free(6.1, 1.0)
    assert not reach.connects((1.0, 1.0), (6.1, 1.0))


def test_what_is_inside_of_something_is_not_free() -> None:
    hole = ((4.0, 3.0), (6.0, 3.0), (6.0, 5.0), (4.0, 5.0))
    block = Solid(outline=((2, 1), (9, 1), (9, 7), (2, 7)), holes=(hole,), heights=HEIGHTS)
    place = Place(solids=(block,), pillars=(Pillar(x=11, y=4, radius=0.5, heights=HEIGHTS),))
    reach = Reach(place, 0.25, BOX)
    assert reach.is_free(5.0, 4.0)
    assert not reach.is_free(3.0, 4.0)
    assert not reach.is_free(11.0, 4.0)
    assert reach.is_free(11.9, 4.0)
    assert not reach.connects((5.0, 4.0), (1.0, 1.0))  # a courtyard
    assert place.clearance(5.0, 4.0) == pytest.approx(1.0)
    assert place.clearance(3.0, 4.0) == pytest.approx(-1.0)
    assert place.clearance(11.0, 4.0) == pytest.approx(-0.5)


def _strewn(rng: np.random.Generator) -> tuple[Place, FreeSpace]:
    """A room with walls at random places, and what is exactly free in it."""
    solids = []
    for x, y, turn in rng.uniform((0, 0, 0), (12, 8, math.pi), (14, 3)).tolist():
        c, s = 1.5 * math.cos(turn), 1.5 * math.sin(turn)
        outline = ((x, y), (x + c, y + s), (x + c - 0.1 * s, y + s + 0.1 * c))
        solids.append(Solid(outline=outline, heights=HEIGHTS))
    place = Place(faces=(_closed(*BOX),), solids=tuple(solids))
    walls = np.array([[*a, *b] for a, b in place.segments()])
    return place, FreeSpace.of(walls, np.zeros((0, 3)), 0.3, np.zeros((0, 2)))


@pytest.mark.parametrize("seed", range(6))
def test_no_way_that_there_is_not_is_seen_at_a_quick_look(seed: int) -> None:
    rng = np.random.default_rng(seed)
    place, space = _strewn(rng)
    quick = wide_reach_of(place, 0.3, BOX)
    points = rng.uniform((0, 0), (12, 8), (60, 2))
    parts = space.part_of(points).tolist()
    seen = [quick.is_free(*point) for point in points.tolist()]
    assert any(seen)
    for point, part, free in zip(points.tolist(), parts, seen, strict=True):
        assert not free or (part >= 0 and place.clearance(*point) >= 0.3)
    joined = [quick.connects(tuple(points[i]), tuple(points[i + 30])) for i in range(30)]
    assert any(joined)
    assert all(parts[i] == parts[i + 30] for i in range(30) if joined[i])


@pytest.mark.parametrize("seed", range(6))
def test_no_way_that_there_is_is_refused(seed: int) -> None:
    rng = np.random.default_rng(seed)
    place, space = _strewn(rng)
    reach = Reach(place, 0.3, BOX)
    points = rng.uniform((0, 0), (12, 8), (60, 2))
    parts = space.part_of(points)
    free = np.array([place.clearance(x, y) >= 0.3 for x, y in points.tolist()])
    for point, part, room in zip(points.tolist(), parts.tolist(), free.tolist(), strict=True):
        if part >= 0 and room:
            assert reach.is_free(*point)
    for i in range(30):
        if parts[i] == parts[i + 30] >= 0 and free[i] and free[i + 30]:
            assert reach.connects(tuple(points[i]), tuple(points[i + 30]))


def test_outlines() -> None:
    square = ((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0))
    assert signed_area(square) == 4.0
    assert signed_area(square[::-1]) == -4.0
    assert is_convex(square)
    assert first_crossing(square) is None
    assert contains(square, 1.0, 1.0)
    assert not contains(square, 3.0, 1.0)
    arrow = ((0.0, 0.0), (2.0, 1.0), (0.0, 2.0), (1.0, 1.0))
    assert not is_convex(arrow)
    assert first_crossing(arrow) is None
    bow = ((0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 3.0))
    assert first_crossing(bow) == (0, 2)
    spike = ((0.0, 0.0), (2.0, 0.0), (4.0, 0.0), (3.0, 0.0), (1.0, 2.0))  # back over a side
    assert first_crossing(spike) is not None
