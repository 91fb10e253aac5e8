"""The way past what stands: people who walk by do not block it, walls do."""

from __future__ import annotations

import numpy as np

from crowdbot.plugin import Pose
from crowdbot.plugins.planners.shared.local_map_build import thinned
from crowdbot.plugins.planners.shared.path_finder_build import PathFinder, _still_there

START, GOAL = Pose(0.0, 0.0, 0.0), (5.0, 0.0)
WALL = np.column_stack([np.full(41, 2.0), np.linspace(-2.0, 2.0, 41)])


def test_a_wall_is_passed_once_it_was_seen_three_times() -> None:
    finder = PathFinder(0.3)
    aims = [finder.waypoint(0.5 * n, START, WALL, GOAL) for n in range(4)]
    assert aims[0] == aims[1] == GOAL
    assert aims[2] != GOAL
    assert abs(aims[2][1]) > 0.5  # along the wall


def test_points_that_move_on_do_not_turn_it_round() -> None:
    finder = PathFinder(0.3)
    for n in range(20):
        walkers = WALL - (0.4 * (n % 5), 0.0)  # 0.8 m/s towards it, and new ones behind them
        assert finder.waypoint(0.5 * n, START, walkers, GOAL) == GOAL


def test_what_stands_is_remembered_while_it_is_hidden() -> None:
    finder = PathFinder(0.3)
    for n in range(3):
        finder.waypoint(0.5 * n, START, WALL, GOAL)
    near = np.column_stack([np.full(41, 1.0), np.linspace(-2.0, 2.0, 41)])  # people before it
    assert finder.waypoint(1.5, START, near, GOAL) != GOAL
    free = np.zeros((0, 2))
    assert finder.waypoint(2.0, START, free, GOAL) == GOAL


def test_what_is_still_there_is_what_a_search_through_all_cells_finds() -> None:
    rng = np.random.default_rng(37)
    for spread in (0.1, 1.0, 5.0):
        seen, *before = (rng.normal(0.0, spread, (60, 2)) for _ in range(3))
        cells = [np.floor(p / 0.15) for p in (seen, *before)]
        near = [np.abs(cells[0][:, None] - c).max(axis=2).min(axis=1) <= 1.0 for c in cells[1:]]
        assert (_still_there(seen, before) == seen[near[0] & near[1]]).all()


def test_of_the_points_of_a_cell_the_first_is_kept() -> None:
    points = np.array([[0.52, 0.0], [0.0, 0.0], [0.02, -0.02], [0.48, 0.0], [0.0, -0.1]])
    assert thinned(points).tolist() == [[0.0, -0.1], [0.0, 0.0], [0.52, 0.0]]
    assert thinned(points[:0]).shape == (0, 2)
