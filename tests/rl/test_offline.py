"""Runs as data sets: what a planner saw and did, as episodes and as scenes."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import crowdbot
from crowdbot import cli
from crowdbot.api import registry
from crowdbot.core.learning.actions import actions_of, commands_of
from crowdbot.core.runs.run_directory import RECORD, runs_under
from crowdbot.core.trajectories.trajectories import Trajectories
from crowdbot.core.types.robot import RobotLimits
from crowdbot.errors import InputError
from crowdbot.rl.offline import run_episode

NAME = "counter-d0500-dispersed-c20-r05"
FIELDS = ["crowd.flow.density=0.02", "robots.robot.task.time_limit=3"]


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of two runs, the second a copy of the first, and one that is not complete."""
    folder = tmp_path_factory.mktemp("runs")
    scenario = crowdbot.load("challenge-2020", NAME, set=FIELDS)
    crowdbot.simulate(
        scenario, planner="goal_seek", references=False, replay=False, out=folder / "a"
    )
    shutil.copytree(folder / "a", folder / "b")
    shutil.copytree(folder / "a", folder / "cut")
    for record in (folder / "cut").rglob(RECORD):
        record.unlink()
    return folder


def test_actions_are_the_inverse_of_commands() -> None:
    limits = RobotLimits(v_min=-0.2, v_max=0.6, w_max=2.0, a_max=1.0, alpha_max=1.0)
    given = np.random.default_rng(0).uniform(-1.0, 1.0, (5, 2))
    assert np.allclose(actions_of(commands_of(given, limits), limits), given)
    assert actions_of(np.array([[9.0, -9.0, 0.0]]), limits).tolist() == [[1.0, -1.0]]


def test_an_episode_is_what_the_robot_met_and_did(runs: Path) -> None:
    first, second = runs_under(runs)
    assert [run.relative_to(runs).parts[0] for run in (first, second)] == ["a", "b"]
    episode = run_episode(first, registry())
    assert episode.observations.shape == (49, 66)
    assert episode.actions.shape == (48, 2)
    assert (episode.observations >= episode.low).all()
    assert (episode.observations <= episode.high).all()
    assert np.abs(episode.actions).max() <= 1.0
    assert episode.actions[-1, 0] == pytest.approx(1.0)  # full speed ahead
    # Twice the way from 1.5 s to 3 s, at 0.65 m/s; the rest of the reward is time.
    progress = 0.65 / 16
    assert episode.rewards[-8:] == pytest.approx(progress - 0.05 / 16, abs=2e-3)
    assert not episode.arrived


def test_calibration_runs_are_no_data(runs: Path, tmp_path: Path) -> None:
    folder, (first, _) = tmp_path / "runs", runs_under(runs)
    for name in ("a/seed-0", "references/robot_alone-0a1b"):
        shutil.copytree(first, folder / name)
    assert runs_under(folder) == [folder / "a" / "seed-0"]
    alone = folder / "references" / "robot_alone-0a1b"
    assert runs_under(alone) == [alone]  # named by itself


def test_scenes_of_trajnet_share_no_person_and_no_frame(runs: Path, tmp_path: Path) -> None:
    out = tmp_path / "all.ndjson"
    assert cli.main(["export", str(runs), "--to", "trajnet", "--out", str(out)]) == 0
    lines = [json.loads(line) for line in out.read_text().splitlines()]
    one, other = (line["scene"] for line in lines if "scene" in line)
    assert (one["id"], other["id"]) == (0, 1)
    assert other["s"] == one["e"] + 1
    tracks = [line["track"] for line in lines if "track" in line]
    people: list[set[int]] = [
        {t["p"] for t in tracks if scene["s"] <= t["f"] <= scene["e"]} for scene in (one, other)
    ]
    assert one["p"] in people[0]
    assert other["p"] in people[1]
    assert not people[0] & people[1]
    read = [Trajectories.from_trajnet(out, scene=s["id"], robot=s["p"]) for s in (one, other)]
    assert read[0].robot is not None
    assert read[1].robot is not None
    assert np.allclose(read[0].robot.x, read[1].robot.x)
    assert read[0].agents is not None


def test_trajnet_plus_plus_reads_the_scenes(runs: Path, tmp_path: Path) -> None:
    tools = pytest.importorskip("trajnetplusplustools", reason="trajnetplusplustools is missing")
    out = tmp_path / "all.ndjson"
    assert cli.main(["export", str(runs), "--to", "trajnet", "--out", str(out)]) == 0
    scenes = list(tools.Reader(str(out), scene_type="paths").scenes())
    assert len(scenes) == 2
    assert all(len(paths[0]) == 8 for _, paths in scenes)  # 3 s at 2.5 frames a second


def test_minari_loads_the_episodes(
    runs: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    minari: Any = pytest.importorskip("minari", reason="minari is not installed")
    out = tmp_path / "sets" / "runs-v0"
    monkeypatch.chdir(tmp_path)
    assert cli.main(["export", str(runs), "--to", "minari", "--out", "sets/runs-v0"]) == 0
    assert "MINARI_DATASETS_PATH" not in os.environ
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(out.parent))
    data = minari.load_dataset("runs-v0")
    assert (data.total_episodes, data.total_steps) == (2, 96)
    wanted = run_episode(runs_under(runs)[0], registry())
    for episode in data.iterate_episodes():
        assert np.array_equal(episode.observations, wanted.observations)
        assert np.array_equal(episode.actions, wanted.actions)
        assert np.allclose(episode.rewards, wanted.rewards)
        assert episode.truncations.tolist() == [False] * 47 + [True]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--out", "nowhere"], "like 'runs-v0'"),
        (["--robot", "robot"], "--robot has no meaning for --to minari"),
    ],
)
def test_what_minari_has_no_use_for_is_named(
    arguments: list[str], message: str, runs: Path, tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    pytest.importorskip("minari", reason="minari is not installed")
    monkeypatch.chdir(tmp_path)
    assert cli.main(["export", str(runs), "--to", "minari", *arguments]) != 0
    assert message in " ".join(capsys.readouterr().err.split())
    assert not list(tmp_path.iterdir())


def test_a_folder_without_runs_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["export", str(tmp_path), "--to", "trajnet"]) == 1
    assert "no run in it" in " ".join(capsys.readouterr().err.split())
    with pytest.raises(InputError):
        run_episode(tmp_path, registry())
