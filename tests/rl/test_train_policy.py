"""The script of the how-to trains a policy that is a planner."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crowdbot.api import registry
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.errors import InputError
from tests.paths import ROOT

pytest.importorskip("gymnasium", reason="the extra rl is not installed")
ort = pytest.importorskip("onnxruntime", reason="the extra onnx is not installed")
rl = pytest.importorskip("crowdbot.rl")


def script() -> Any:
    path = ROOT / "benchmarks" / "train_policy.py"
    spec = importlib.util.spec_from_file_location("train_policy", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_generation_is_trained_and_saved_as_a_planner(tmp_path: Path) -> None:
    module, out = script(), tmp_path / "policy.onnx"
    module.WORLDS = {**module.WORLDS, "scenario": "counter-d0125-slow-c20-r05", "draws": 2}
    (earned,) = module.train(0.0, worlds=4, steps=3, out=out)
    assert np.isfinite(earned)
    choice = resolve_planner(str(out), registry())
    assert choice.needs == ("front_lidar",)
    # What the file computes is what was trained.
    env = rl.NavVectorEnv(2, **module.WORLDS)
    rng, inputs = np.random.default_rng(0), env.single_observation_space.shape[0]
    numbers = rng.normal(size=(inputs + 1) * module.HIDDEN + (module.HIDDEN + 1) * 2)
    layers = module.layers_of(numbers, inputs, 2)
    rl.save_layers(layers, env, out)
    seen = rng.normal(size=(3, inputs)).astype(np.float32)
    session = ort.InferenceSession(str(out), providers=["CPUExecutionProvider"])
    found = session.run(None, {"observation": seen})[0]
    wanted = module.actions_of(np.repeat(numbers[np.newaxis], 3, axis=0), seen.astype(float), 2)
    assert np.allclose(found, wanted, atol=1e-4)
    with pytest.raises(InputError, match="layer 0 has shapes"):
        rl.save_layers(layers[1:], env, out)
