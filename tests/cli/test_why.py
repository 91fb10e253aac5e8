"""``crowdbot why``: one run, a folder of runs, a wrong word."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from crowdbot import cli

SCENARIO = """
crowdbot: 1
scenario:
  id: crossing
  environment:
    kind: corridor
    length: 8 m
    width: 4 m
    zones: {all: {x: [0 m, 8 m], y: [-2 m, 2 m]}, end: {x: [7 m, 8 m], y: [-2 m, 2 m]}}
  robots:
    robot:
      model: {kind: turtlebot2}
      sensors: {odometry: {kind: wheel_odometry}}
      task: {start: [1 m, 0 m, 0 deg], goal: {zone: end}, time_limit: 2 s}
"""


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("why")
    (folder / "crossing.yaml").write_text(SCENARIO)
    words = ["simulate", str(folder / "crossing.yaml"), "--planner", "goal_seek", "--quiet"]
    assert cli.main([*words, "--no-references", "--out", str(folder / "runs")]) == 0
    return folder / "runs"


def run_of(runs: Path) -> Path:
    return runs / "scenarios/crossing/goal_seek/seed-0"


def test_one_run(runs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    page = tmp_path / "why.html"
    assert cli.main(["why", str(run_of(runs)), "--out", str(page)]) == 0
    out = capsys.readouterr().out
    assert "crossing · goal_seek · seed 0: did not arrive within 2.0 s" in out
    assert "the robot moved until time was up" in out
    text = page.read_text()
    assert text.count("<svg") == 3  # 0, 1 and 2 s before: the run has no more
    assert "Replay of this run" in text
    assert "http://" not in text.replace("http://www.w3.org/2000/svg", "")


def test_a_folder_counts_causes(runs: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["why", str(runs), "--json"]) == 0
    (found,) = json.loads(capsys.readouterr().out)
    assert (found["planner"], found["cause"], found["count"], found["runs"]) == (
        "goal_seek", "slow", 1, 1,
    )  # fmt: skip
    assert found["example"]["directory"] == str(run_of(runs))


def test_wrong_words(runs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["why", str(tmp_path)]) == 1
    assert "there is no run with a robot below it" in capsys.readouterr().err
    assert cli.main(["why", str(runs), "--planner", "goal_sek"]) == 1
    assert "goal_seek" in capsys.readouterr().err
    assert cli.main(["why", str(run_of(runs)), "--robot", "r2"]) == 1
    assert "r2" in capsys.readouterr().err
