"""The map of a recording: occupied, free, and unknown outside."""

from __future__ import annotations

import numpy as np
import pytest

from crowdbot.core.recording import scenery

#: A room of 4 m by 2 m with a pillar, and the same without its right wall.
ROOM = np.array(
    [[0, 0, 4, 0], [4, 2, 0, 2], [0, 2, 0, 0], [1, 0.5, 1.5, 0.5], [1.5, 0.5, 1.5, 1],
     [1.5, 1, 1, 1], [1, 1, 1, 0.5], [4, 0, 4, 2]], float,
)  # fmt: skip
GOAL, INSIDE, OUTSIDE, PILLAR = (3.0, 1.0), (0.5, 1.5), (-0.3, 1.0), (1.25, 0.75)


def _at(walls: np.ndarray, goal: tuple[float, float] | None, point: tuple[float, float]) -> int:
    grid = scenery.occupancy_grid(0, walls, goal=goal)
    cells = grid.data.reshape(grid.info.height, grid.info.width)
    low = grid.info.origin.position
    column, row = (int(d / grid.info.resolution) for d in (point[0] - low.x, point[1] - low.y))
    return int(cells[row, column])


def test_outside_of_a_room_is_unknown() -> None:
    assert [_at(ROOM, GOAL, p) for p in (GOAL, INSIDE, OUTSIDE, (2.0, 0.0))] == [0, 0, -1, 100]
    assert _at(ROOM, GOAL, PILLAR) == 0


@pytest.mark.parametrize(
    ("walls", "goal"), [(ROOM[:-1], GOAL), (ROOM, None), (ROOM, (2.0, 0.0)), (ROOM, (9.0, 1.0))]
)
def test_nothing_is_unknown_where_outside_is_not_known(
    walls: np.ndarray, goal: tuple[float, float] | None
) -> None:
    assert [_at(walls, goal, p) for p in (INSIDE, OUTSIDE)] == [0, 0]
