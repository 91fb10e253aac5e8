"""Starts and goals that are drawn for each episode; levels of a curriculum."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crowdbot.core.crowd.contact.robot_contact import R_YAW
from crowdbot.errors import InputError
from crowdbot.rl.env_setup import resolve
from crowdbot.rl.rollout import Rollout

FEW: dict[str, Any] = {
    "suite": "challenge-2020",
    "scenario": "counter-d0500-dispersed-c20-r05",
    "set": ["crowd.flow.density=0.02"],
    "observation": "tracks",
    "draws": 1,
}
WIDE = {"start_spread": {"x": 1.0, "y": 4.0, "yaw": 3.0}, "goal_spread": {"x": 2.0}}
ALL = np.ones(2, np.bool_)


def rollout(**more: Any) -> Rollout:
    return Rollout(resolve(**{**FEW, **more}), [3, 4])


def test_each_episode_has_its_own_start_and_goal_which_its_seed_decides() -> None:
    one, other, starts = rollout(**WIDE), rollout(**WIDE), []
    for _ in range(3):
        one.begin(ALL, [None, None])
        other.begin(ALL, [None, None])
        world = one.world(0)
        assert np.array_equal(world.robots, other.world(0).robots)
        x, y, yaw = world.robots[0, [0, 1, R_YAW]]
        assert abs(x - 2.5) <= 1.0
        assert abs(y) <= 4.0
        assert abs(yaw) <= 3.0
        (task,) = world.tasks
        moved = np.asarray(task.goal_zone) - np.asarray(world.blueprint.tasks[0].goal_zone)
        assert np.allclose(moved, moved[0])
        assert 0.0 < abs(moved[0, 0]) <= 2.0
        assert moved[0, 1] == 0.0
        starts.append((x, y))
    assert len(set(starts)) == 3
    assert not np.array_equal(one.world(0).robots, one.world(1).robots)
    one.begin(ALL, [3, 4])
    fresh = rollout(**WIDE)
    fresh.begin(ALL, [3, 4])
    assert np.array_equal(one.world(1).robots, fresh.world(1).robots)


def test_the_moved_goal_is_where_an_episode_ends() -> None:
    near = ["crowd=null", "robots.robot.task.start=[44.9 m, 0 m, 0 deg]"]
    worlds = rollout(set=near, goal_spread={"x": 1.5})
    for _ in range(6):
        worlds.begin(ALL, [None, None])
        border = float(np.min(np.asarray(worlds.world(0).tasks[0].goal_zone)[:, 0]))
        if border > 45.2:
            break
    arrived_at = None
    for _ in range(60):
        result = worlds.step(np.array([[1.0, 0.0], [1.0, 0.0]]), np.arange(2))
        if result.arrived[0]:
            arrived_at = worlds.world(0).robots[0, 0]
            break
    assert arrived_at is not None
    assert border <= arrived_at < border + 0.1


def test_a_start_keeps_clear_of_walls_and_is_refused_where_there_is_no_room() -> None:
    worlds = rollout(start_spread={"y": 60.0})
    for _ in range(3):
        worlds.begin(ALL, [None, None])
        assert all(abs(worlds.world(w).robots[0, 1]) < 5.0 for w in (0, 1))
    with pytest.raises(InputError, match=r"no free start in 200 tries: .*behind a wall"):
        rollout(goal_spread={"y": 1e6})


def test_wrong_spreads_are_named() -> None:
    with pytest.raises(InputError, match="start_spread has no 'z'; it has x, y, yaw"):
        resolve(**FEW, start_spread={"z": 1.0})
    with pytest.raises(InputError, match="goal_spread: x is a distance of at least 0, not -1"):
        resolve(**FEW, goal_spread={"x": -1})


def test_a_level_holds_from_the_next_episode_on_also_with_another_seed() -> None:
    levels = ["in-d0125-slow-c20-r10", "in-d0125-slow-c20-r05"]
    worlds = rollout(scenario=None, levels=levels)
    assert worlds.scenarios.tolist()[0].startswith(levels[0])
    worlds.set_level(1)
    assert worlds.scenarios.tolist()[0].startswith(levels[0])
    worlds.begin(ALL, [9, 9])
    assert all(name.startswith(levels[1]) for name in worlds.scenarios)
    with pytest.raises(InputError, match="level 2 of 2"):
        worlds.set_level(2)
