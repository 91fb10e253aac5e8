"""The policy that comes with the training script: small, a planner, and able to reach its goal."""

from __future__ import annotations

import json

import numpy as np
import pytest

from crowdbot.api import registry
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.rl.env_setup import resolve
from crowdbot.rl.rollout import Rollout
from tests.paths import ROOT

ort = pytest.importorskip("onnxruntime", reason="the extra onnx is not installed")
FOLDER = ROOT / "benchmarks" / "training"
POLICY = FOLDER / "counterflow.onnx"


def test_it_is_a_planner_that_uses_both_lidars() -> None:
    choice = resolve_planner(str(POLICY), registry())
    assert choice.needs == ("front_lidar", "rear_lidar")
    assert not choice.privileged
    assert POLICY.stat().st_size < 1_000_000


def test_it_turns_round_and_reaches_its_goal_where_no_one_is() -> None:
    session = ort.InferenceSession(str(POLICY), providers=["CPUExecutionProvider"])
    kept = json.loads(session.get_modelmeta().custom_metadata_map["crowdbot"])
    setup = resolve(
        suite=str(FOLDER / "nav-training.yaml"), scenario="counter-d000-slow-c01",
        set=["crowd=null"], observation=kept["observation"], start_spread={"y": 3.0, "yaw": 3.1},
    )  # fmt: skip
    worlds, here = Rollout(setup, [1, 2, 3, 4]), np.arange(4)
    fresh, arrived = np.ones(4, np.bool_), np.zeros(4, np.bool_)
    for _ in range(60 * 16):
        seen = worlds.look(fresh, ~fresh)
        (actions,) = session.run(None, {"observation": seen})
        arrived |= worlds.step(np.asarray(actions, float), here).arrived
        fresh[:] = False
        if arrived.all():
            return
    assert arrived.all()
