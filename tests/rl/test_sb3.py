"""Stable-Baselines3 trains in our worlds, and what it saves drives as a planner."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crowdbot.api import registry
from crowdbot.core.planning.policies.sb3_policy import load_sb3
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.errors import InputError

pytest.importorskip("gymnasium", reason="the extra rl is not installed")
sb3 = pytest.importorskip("stable_baselines3", reason="Stable-Baselines3 is not installed")
rl = pytest.importorskip("crowdbot.rl")

FEW: dict[str, Any] = {
    "suite": "challenge-2020",
    "scenario": "counter-d0500-dispersed-c20-r05",
    "set": ["crowd.flow.density=0.02", "robots.robot.task.time_limit=0.5"],
    "observation": {"kind": "lidar_stack", "sensor": "front_lidar", "sectors": 8},
    "draws": 2,
}


def test_one_world_passes_its_own_checks() -> None:
    from stable_baselines3.common.env_checker import check_env

    check_env(rl.NavEnv(**FEW, render_mode="rgb_array"), warn=True)


def test_many_worlds_report_the_end_of_each_episode() -> None:
    env = rl.StableVecEnv(2, **FEW)
    env.seed(5)
    first = env.reset()
    env.seed(5)
    assert np.array_equal(first, env.reset())
    for step in range(8):
        seen, _, done, infos = env.step(np.zeros((2, 2), np.float32))
        assert done.tolist() == [step == 7] * 2
    assert infos[0]["TimeLimit.truncated"]
    assert infos[0]["episode"]["l"] == 8
    assert not np.array_equal(infos[0]["terminal_observation"], seen[0])
    assert env.get_attr("render_mode", [1]) == [None]
    env.close()


def test_the_level_can_be_raised_while_it_learns() -> None:
    levels = ["in-d0125-slow-c20-r10", "in-d0125-slow-c20-r05"]
    env = rl.StableVecEnv(1, suite="challenge-2020", levels=levels, draws=1)
    env.reset()
    env.set_level(1)
    env.reset()
    assert env.worlds.rollout.scenarios[0] == levels[1]


def test_what_it_learns_is_a_planner_in_both_forms(tmp_path: Path) -> None:
    pytest.importorskip("onnx", reason="onnx is not installed")
    ort = pytest.importorskip("onnxruntime", reason="the extra onnx is not installed")
    env = rl.StableVecEnv(2, **FEW)
    model = sb3.PPO("MlpPolicy", env, n_steps=8, batch_size=16, n_epochs=1, device="cpu", seed=1)
    model.learn(32)
    model.save(tmp_path / "bare.zip")
    with pytest.raises(InputError, match="says nothing of its observation"):
        load_sb3(tmp_path / "bare.zip", registry())
    model.crowdbot = rl.conventions(env)
    model.save(tmp_path / "model.zip")
    rl.save_onnx(model, env, tmp_path / "model.onnx")
    seen = np.random.default_rng(0).uniform(0.0, 1.0, (1, len(env.observation_space.low)))
    wanted, _ = model.predict(seen.astype(np.float32), deterministic=True)
    act, conventions = load_sb3(tmp_path / "model.zip", registry())
    assert np.allclose(np.clip(act(seen.astype(np.float32)), -1, 1), wanted, atol=1e-5)
    session = ort.InferenceSession(str(tmp_path / "model.onnx"))
    (found,) = session.run(None, {"observation": seen.astype(np.float32)})
    assert np.allclose(np.clip(found, -1, 1), wanted, atol=1e-5)
    assert conventions.values == rl.conventions(env)
    for text in (f"sb3:{tmp_path / 'model.zip'}", str(tmp_path / "model.onnx")):
        assert resolve_planner(text, registry()).needs == ("front_lidar",)
    other = rl.StableVecEnv(1, **{**FEW, "observation": "lidar_stack"})
    with pytest.raises(InputError, match=r"does not take observations|returns shape"):
        rl.save_onnx(model, other, tmp_path / "wrong.onnx")


@pytest.mark.slow
def test_worlds_in_processes_of_their_own_are_the_same() -> None:
    from stable_baselines3.common.vec_env import DummyVecEnv, SubprocVecEnv

    seen: list[Any] = []
    for kind in (DummyVecEnv, SubprocVecEnv):
        worlds = kind([_nav, _nav])
        worlds.seed(5)
        seen.append([worlds.reset(), *(worlds.step(np.full((2, 2), 0.3))[0] for _ in range(3))])
        worlds.close()
    assert np.array_equal(*seen)
    assert not np.array_equal(seen[0][0][0], seen[0][0][1])


def _nav() -> Any:
    return rl.NavEnv(**FEW)
