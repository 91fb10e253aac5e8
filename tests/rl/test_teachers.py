"""Planners that teach: each sees its own world, and drives it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crowdbot.core.crowd.contact.robot_contact import R_YAW, RX, RY
from crowdbot.rl.libraries import SAME_STEP
from crowdbot.rl.vector_env import NavVectorEnv
from tests.paths import ROOT

pytest.importorskip("gymnasium", reason="the extra rl is not installed")


@pytest.mark.slow  # 3 s: the planner's kernels
def test_teachers_drive_towards_the_goals_of_their_worlds(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    script: Any = __import__("teachers")
    env = NavVectorEnv(
        3, autoreset_mode=SAME_STEP, scenario="counter-d000-slow-c20",
        suite=str(ROOT / "benchmarks" / "training" / "nav-training.yaml"),
        observation={"kind": "lidar_stack", "sensor": "front_lidar"},
        set=["rates.planner=8 Hz"], start_spread={"y": 3.0, "yaw": 1.0},
    )  # fmt: skip
    env.reset(seed=5)
    teachers = script.Teachers(env, "people_mpc")
    teachers.begin(np.ones(3, np.bool_))
    x, y, yaw = (env.rollout.rows[:, 0, k] for k in (RX, RY, R_YAW))
    goal = env.rollout.world(0).tasks[0].goal
    left = np.sin(np.arctan2(goal[1] - y, goal[0] - x) - yaw)
    assert np.ptp(left) > 0.1  # each world has its own start
    first = teachers.actions()
    assert np.abs(first).max() <= 1.0
    assert (np.sign(first[:, 1]) == np.sign(left)).all()
    before = x.copy()
    for _ in range(24):
        env.step(teachers.actions())
    assert (env.rollout.rows[:, 0, RX] > before + 0.5).all()
