"""The scenario files that come with the package drive a robot among their people."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from crowdbot import cli
from crowdbot.core.recording import read_trajectories
from tests.paths import ROOT

EXAMPLES = ROOT / "scenario_specs" / "examples"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "which", "people"),
    [
        ("explicit_agents", [], 7),
        ("cafe_crossing", [], 36),
        ("bidirectional_corridor", ["half"], 100),
    ],
)
def test_an_example_runs(name: str, which: list[str], people: int, tmp_path: Path) -> None:
    argv = [
        "simulate", str(EXAMPLES / f"{name}.yaml"), *which, "--planner", "goal_seek",
        "--no-references", "--set", "robots.robot.task.time_limit=3", "--out", str(tmp_path),
    ]  # fmt: skip
    assert cli.main(argv) == 0
    (file,) = tmp_path.glob("**/run.json")
    record = json.loads(file.read_text())
    assert (record["status"], record["sim_time"]) == ("timeout", 3.0)
    tracks = read_trajectories(file.parent / "run.mcap")
    assert tracks.agents is not None
    at = np.stack([tracks.agents.x, tracks.agents.y], axis=-1)
    here = np.isfinite(at[..., 0])
    assert at.shape[1] == people
    assert np.count_nonzero(here[0]) >= 6  # others come later
    assert np.all(np.isfinite(at[here]))
    moved = np.hypot(*(at[-1] - at[0])[here[0] & here[-1]].T)
    assert np.max(moved) > 2.0  # in 3 s at 1 m/s or more
    assert np.max(moved) < 9.0
