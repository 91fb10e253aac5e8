"""Trained policies as planners: they drive as in training, and wrong files are named."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import crowdbot
from crowdbot.api import registry
from crowdbot.core.learning.conventions import read_conventions
from crowdbot.core.planning.planner_files import planner_files
from crowdbot.core.planning.resolve import resolve_planner
from crowdbot.errors import InputError, MissingLibraryError, PlannerError
from tests.paths import DATA

ort = pytest.importorskip("onnxruntime", reason="the extra onnx is not installed")
POLICIES = DATA / "policies"
TO_GOAL = POLICIES / "to_goal.onnx"
SURE = "robots.robot.sensors.{}_lidar.noise.range={{kind: offset, value: 0 m}}"
FIELDS = [
    "robots.robot.control=kinematic",
    "robots.robot.task.time_limit=4",
    "robots.robot.task.start=[2.5 m, 1 m, 40 deg]",
    "crowd.flow.density=0.02",
    *(SURE.format(name) for name in ("front", "rear")),
]


def test_a_policy_drives_in_a_run_as_it_drives_in_its_environment(tmp_path: Path) -> None:
    gym = pytest.importorskip("gymnasium", reason="the extra rl is not installed")
    rl = pytest.importorskip("crowdbot.rl")
    suite, name = "challenge-2020", "counter-d0500-dispersed-c20-r05"
    scenario = crowdbot.load(suite, name, set=FIELDS)
    run = crowdbot.simulate(
        scenario, planner=str(TO_GOAL), references=False, replay=False, out=tmp_path
    )
    robot = run.trajectories.robot
    assert robot is not None
    choice = resolve_planner(str(TO_GOAL), registry())
    assert choice.needs == ("lidar",)
    assert choice.spec_dump["sha256"]
    session = ort.InferenceSession(str(TO_GOAL), providers=["CPUExecutionProvider"])
    seen = {"kind": "lidar_stack", "sectors": 4, "scans": 1}
    env = gym.make(rl.NAV, suite=suite, scenario=name, set=FIELDS, edition=True, observation=seen)
    obs, _ = env.reset(seed=0)
    late = False
    while not late:
        obs, _, _, late, _ = env.step(session.run(None, {"observation": obs[np.newaxis]})[0][0])
    x, y = env.unwrapped.rollout.world(0).robots[0, :2]
    assert np.hypot(x - 2.5, y - 1.0) > 0.8
    # The policy of the run sees its pose by wheel odometry, that of the environment exactly.
    assert np.hypot(robot.x[-1] - x, robot.y[-1] - y) < 0.01
    kept = session.get_modelmeta().custom_metadata_map["crowdbot"]
    assert rl.conventions(env) == read_conventions(kept, "", registry()).values


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("no_conventions.onnx", "says nothing of its observation and action"),
        ("wrong_size.onnx", r"its input has shape \(any, 10\), not \(any, 66\)"),
        ("nowhere.onnx", "no such file"),
    ],
)
def test_a_file_that_is_no_policy_is_named(name: str, message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        resolve_planner(str(POLICIES / name), registry())
    assert name in str(caught.value)


def test_a_file_that_is_not_onnx_and_parameters_are_refused(tmp_path: Path) -> None:
    other = tmp_path / "policy.onnx"
    other.write_text("no weights")
    with pytest.raises(InputError, match="onnxruntime cannot load it"):
        resolve_planner(str(other), registry())
    with pytest.raises(InputError, match="takes no parameters; leave out 'speed'"):
        resolve_planner(str(TO_GOAL), registry(), ["speed=1"])


def test_a_policy_that_changed_since_is_refused(tmp_path: Path) -> None:
    copy = tmp_path / "mine.onnx"
    copy.write_bytes(TO_GOAL.read_bytes())
    choice = resolve_planner(str(copy), registry())
    assert planner_files(str(copy)) == {"mine.onnx": copy}
    copy.write_bytes((POLICIES / "no_conventions.onnx").read_bytes())
    with pytest.raises(InputError, match="changed since it was chosen"):
        choice.build()


def test_a_robot_with_other_sensors_is_refused_when_it_begins() -> None:
    planner = resolve_planner(str(TO_GOAL), registry()).build()
    scenario = crowdbot.load("challenge-2020", "counter-d0500-dispersed-c20-r05")
    session = crowdbot.Session(scenario, sensors=["front_lidar"])
    from dataclasses import replace

    sideways = replace(session.limits, vy_max=0.5)
    with pytest.raises(PlannerError, match="acts by v, w"):
        planner.reset(session.task, sideways, session.sensors, 0)


def saved(path: Path, weights: dict[str, Any], **data: Any) -> str:
    """A file as Stable-Baselines3 writes it, without what crowdbot does not read."""
    torch = pytest.importorskip("torch", reason="torch is not installed")
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("data", json.dumps(data))
        with file.open("policy.pth", "w") as part:
            torch.save({name: torch.tensor(w) for name, w in weights.items()}, part)
    return f"sb3:{path}"


def test_a_policy_of_stable_baselines_is_read_without_its_code(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    sizes = [(8, 10), (8, 8), (2, 8)]
    names = ["mlp_extractor.policy_net.0", "mlp_extractor.policy_net.2", "action_net"]
    weights = {}
    for name, shape in zip(names, sizes, strict=True):
        weights[f"{name}.weight"] = rng.normal(size=shape).astype(np.float32)
        weights[f"{name}.bias"] = rng.normal(size=shape[0]).astype(np.float32)
    model = ort.InferenceSession(str(TO_GOAL), providers=["CPUExecutionProvider"])
    own = json.loads(model.get_modelmeta().custom_metadata_map["crowdbot"])
    choice = resolve_planner(saved(tmp_path / "a.zip", weights, crowdbot=own), registry())
    assert (choice.name, choice.needs) == ("a", ("lidar",))
    from crowdbot.core.planning.policies.sb3_policy import load_sb3

    act, _ = load_sb3(tmp_path / "a.zip", registry())
    seen = rng.normal(size=(1, 10)).astype(np.float32)
    wanted = seen
    for name in names[:2]:
        wanted = np.tanh(wanted @ weights[f"{name}.weight"].T + weights[f"{name}.bias"])
    wanted = wanted @ weights["action_net.weight"].T + weights["action_net.bias"]
    assert np.allclose(act(seen), wanted)
    with pytest.raises(InputError, match="10 inputs and 2 outputs, not 12 and 2"):
        resolve_planner(
            saved(tmp_path / "b.zip", weights, crowdbot={**own, "size": 12}), registry()
        )
    del weights["action_net.bias"]
    with pytest.raises(InputError, match="only fully connected policies"):
        resolve_planner(saved(tmp_path / "c.zip", weights, crowdbot=own), registry())


def test_without_torch_a_saved_model_says_what_is_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "torch", None)
    (tmp_path / "a.zip").write_bytes(b"")
    with pytest.raises(MissingLibraryError, match="need torch"):
        resolve_planner(f"sb3:{tmp_path / 'a.zip'}", registry())
