from __future__ import annotations

import numpy as np
import pytest

from crowdbot.plugin import Rectangle
from crowdbot.plugins.environments.corridor import CorridorSpec
from crowdbot.plugins.environments.place_build import build

PORTALS = {"a": Rectangle(x=(-1.0, 0.0), y=(-5.0, 5.0)), "b": Rectangle(x=(50.0, 51.0), y=(-5, 5))}


def test_walls_of_the_challenge() -> None:
    parts = build(CorridorSpec(portals=PORTALS))
    side, other, start, end = parts.walls
    assert {tuple(side[[1, 3]]), tuple(other[[1, 3]])} == {(-5.0, -5.0), (5.0, 5.0)}
    for wall in (side, other):  # as far as the portals
        assert sorted(wall[[0, 2]]) == [-1.0, 51.0]
    assert list(start[[0, 2]]) == [0.0, 0.0]
    assert list(end[[0, 2]]) == [50.0, 50.0]
    assert np.all(parts.stops_robot)
    assert list(parts.stops_crowd) == [True, True, False, False]
    assert parts.wall_heights.tolist() == [[0.0, 2.5]] * 4
    assert parts.portals == {"a": (-1.0, 0.0, -5.0, 5.0), "b": (50.0, 51.0, -5.0, 5.0)}


def test_the_free_side_of_every_wall_is_on_its_left() -> None:
    parts = build(CorridorSpec(portals=PORTALS, length=30.0, width=4.0))
    inside = np.array([15.0, 0.0])
    for x0, y0, x1, y1 in parts.walls:
        to_point = inside - [x0, y0]
        assert (x1 - x0) * to_point[1] - (y1 - y0) * to_point[0] > 0.0


@pytest.mark.parametrize(("length", "width"), [(50.0, 10.0), (8.0, 3.0)])
def test_without_portals_walls_end_at_the_ends(length: float, width: float) -> None:
    parts = build(CorridorSpec(length=length, width=width))
    assert np.min(parts.walls[:, [0, 2]]) == 0.0
    assert np.max(parts.walls[:, [0, 2]]) == length
    assert np.max(np.abs(parts.walls[:, [1, 3]])) == 0.5 * width


def test_zones_are_polygons_counter_clockwise() -> None:
    parts = build(CorridorSpec(zones={"goal": Rectangle(x=(45.0, 50.0), y=(-5.0, 5.0))}))
    x, y = parts.zones["goal"].T
    area = 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    assert area == pytest.approx(50.0)
