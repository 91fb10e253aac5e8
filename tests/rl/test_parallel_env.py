"""Several robots in one world."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crowdbot.errors import InputError

gym = pytest.importorskip("gymnasium", reason="the extra rl is not installed")
pytest.importorskip("pettingzoo", reason="the extra rl is not installed")
rl = pytest.importorskip("crowdbot.rl")
TESTS = pytest.importorskip("pettingzoo.test")

TWO: dict[str, Any] = {
    "suite": "challenge-2020",
    "scenario": "counter-d0500-dispersed-c20-r05",
    "set": [
        "crowd.flow.density=0.02",
        "robots.other.model={kind: turtlebot2}",
        "robots.other.task={start: [4 m, 2 m, 0 deg], goal: {zone: robot_goal}, time_limit: 1 s}",
        "robots.other.sensors.front_lidar={kind: lidar2d}",
        "robots.robot.task.time_limit=1 s",
    ],
    "draws": 1,
}


def test_it_passes_pettingzoos_own_test() -> None:
    TESTS.parallel_api_test(rl.ParallelNavEnv(**TWO), num_cycles=20)


def test_robots_see_each_other_and_end_one_by_one() -> None:
    env = rl.ParallelNavEnv(**{**TWO, "set": [*TWO["set"], "crowd=null"]})
    seen, _ = env.reset(seed=1)
    assert set(seen) == {"robot", "other"}
    before = seen["robot"].copy()
    still, ahead = np.array([-1.0, 0.0]), np.array([1.0, 0.0])
    limits = env.rollout.actors[env.possible_agents.index("robot")].context.limits
    still[0] = -1.0 - 2.0 * limits.v_min / (limits.v_max - limits.v_min)
    for _ in range(15):
        seen, rewards, _, late, _ = env.step({"robot": still, "other": ahead})
        assert not any(late.values())
    assert not np.array_equal(before, seen["robot"])
    assert rewards["other"] > 0.0
    _, _, _, late, _ = env.step({"robot": still, "other": ahead})
    assert late == {"robot": True, "other": True}
    assert env.agents == []


def test_one_robot_has_one_environment_and_several_have_another() -> None:
    with pytest.raises(InputError, match=r"has 2 robots.*ParallelNavEnv"):
        gym.make(rl.NAV, **TWO)
    env = rl.ParallelNavEnv(**TWO)
    env.reset(seed=0)
    with pytest.raises(InputError, match="'other' has no action"):
        env.step({"robot": np.zeros(2)})
