from __future__ import annotations

import numpy as np
import pytest
import shapely  # type: ignore[import-untyped,unused-ignore]

from crowdbot.core.crowd.routing.free_space import FreeSpace
from crowdbot.core.population.realise import realise
from crowdbot.core.registry.registry import discover
from crowdbot.core.scenarios.library import open_spec, pick
from crowdbot.core.view.build import build_map_content

BOX = np.array([[0, 0, 6, 0], [6, 0, 6, 4], [6, 4, 0, 4], [0, 4, 0, 0]], np.float64)
PILLAR = np.array([[3.0, 2.0, 0.5]])
INSIDE, OUTSIDE = np.array([[1.0, 1.0]]), np.array([[-3.0, -3.0]])


def test_borders_are_those_of_the_part_where_somebody_is() -> None:
    space = FreeSpace.of(BOX, PILLAR, 0.25, np.concatenate([INSIDE, OUTSIDE]))
    assert len(space.parts) == 2
    room, around = (space.holding(at).borders() for at in (INSIDE, OUTSIDE))
    assert sorted(len(ring) for ring in room) == [4, 16]  # its walls, and the pillar's margin
    (wall,) = around  # not where the floor ends
    assert wall.min() < 0.0
    assert shapely.Polygon(wall).area > 24.0
    assert space.holding(np.array([[3.0, 2.0]])).borders() == []


def test_what_lies_on_the_border_is_held() -> None:
    space = FreeSpace.of(BOX, PILLAR, 0.25, INSIDE)
    used = space.holding(INSIDE)
    corners = np.array([[0.25, 0.25], [5.75, 3.75], [-0.25, -0.25], [3.0, 2.0]])
    assert used.holds(corners).tolist() == [True, True, False, False]


@pytest.mark.parametrize("name", ["crossing_both-d040-usual", "shed_along-d010-usual"])
def test_no_line_of_a_mesh_is_behind_the_walls(name: str) -> None:
    registry = discover(allow=())
    scenario = pick(open_spec("challenge-2021", registry), name)
    people = realise(scenario)
    content = build_map_content(scenario, people, registry)
    walls = content.parts.walls
    low, high = walls.reshape(-1, 2).min(axis=0), walls.reshape(-1, 2).max(axis=0)
    ends = np.array([p for ring in content.ways.margins for p in ring])
    ends = np.concatenate([ends, np.array(content.ways.links).reshape(-1, 2)])
    assert np.all((low < ends) & (ends < high))
    if name.startswith("crossing"):  # nor in the corners between two corridors
        assert np.all(np.abs(ends).min(axis=1) < 2.5)
