"""The way past what stands: people who walk by do not block it, walls do."""

from __future__ import annotations

import numpy as np

from crowdbot.plugin import Pose
from crowdbot.plugins.planners.shared.way_build import Way

START, GOAL = Pose(0.0, 0.0, 0.0), (5.0, 0.0)
WALL = np.column_stack([np.full(41, 2.0), np.linspace(-2.0, 2.0, 41)])


def test_a_wall_is_passed_once_it_was_seen_three_times() -> None:
    way = Way(0.3)
    aims = [way.aim(0.5 * n, START, WALL, GOAL) for n in range(4)]
    assert aims[0] == aims[1] == GOAL
    assert aims[2] != GOAL
    assert abs(aims[2][1]) > 0.5  # along the wall


def test_points_that_move_on_do_not_turn_it_round() -> None:
    way = Way(0.3)
    for n in range(20):
        walkers = WALL - (0.4 * (n % 5), 0.0)  # 0.8 m/s towards it, and new ones behind them
        assert way.aim(0.5 * n, START, walkers, GOAL) == GOAL


def test_what_stands_is_remembered_while_it_is_hidden() -> None:
    way = Way(0.3)
    for n in range(3):
        way.aim(0.5 * n, START, WALL, GOAL)
    near = np.column_stack([np.full(41, 1.0), np.linspace(-2.0, 2.0, 41)])  # people before it
    assert way.aim(1.5, START, near, GOAL) != GOAL
    free = np.zeros((0, 2))
    assert way.aim(2.0, START, free, GOAL) == GOAL
