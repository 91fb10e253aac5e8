"""`crowdbot audit`, and the floors that every campaign runs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from crowdbot import cli
from crowdbot.core.results.results import Results
from crowdbot.core.statistics.audit import read_audit
from tests.cli.campaign_cases import TINY, run

NOBODY = """\
crowdbot: 1
suite: {id: nobody}
base:
  extends: ["builtin:parts/corridor_50x10.yaml", "builtin:parts/turtlebot2.yaml"]
  robots.robot.task:
    start: [44.4 m, 0 m, 0 deg]
    goal: {zone: robot_goal}
    time_limit: 4 s
matrix:
  x:
    a: {robots.robot.task.start: [44.3 m, 0 m, 0 deg]}
    b: {robots.robot.task.start: [44.35 m, 0 m, 0 deg]}
    c: {robots.robot.task.start: [44.4 m, 0 m, 0 deg]}
    d: {robots.robot.task.start: [44.45 m, 0 m, 0 deg]}
    e: {robots.robot.task.start: [44.5 m, 0 m, 0 deg]}
    f: {robots.robot.task.start: [44.55 m, 0 m, 0 deg]}
"""
FLOORS = ["goal_seek", "stand_still", "stop_and_go", "wall_hug"]


def audit(capsys: pytest.CaptureFixture[str], *argv: str) -> tuple[int, Any, str]:
    code = cli.main(["audit", *argv, "--json"])
    captured = capsys.readouterr()
    return code, json.loads(captured.out) if captured.out else {}, captured.err


@pytest.mark.slow
def test_a_suite_without_people_tells_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Whoever drives straight on arrives; only standing still is worse."""
    suite = tmp_path / "nobody.yaml"
    suite.write_text(NOBODY)
    out = tmp_path / "runs"
    code, found, err = audit(capsys, str(suite), "--out", str(out), "--jobs", "2")
    assert code == 1, err
    assert not found["tells_apart"]
    verdicts = {p["worse"]: p["verdict"] for p in found["pairs"] if p["required"]}
    assert verdicts["stand_still"] == "ahead"
    assert verdicts["goal_seek"] == "not distinguishable"
    written = read_audit(out / "nobody" / "audit.json")
    assert written.model_dump(mode="json") == found
    assert sorted(written.roles) == sorted([*FLOORS, "dwa", "oracle+privileged"])

    page = tmp_path / "report.html"
    assert cli.main(["report", str(out), "--out", str(page), "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert "nobody cannot tell floors from baselines" in report["suspicion"]
    assert {c["planner"]: c["beats_floors"] for c in report["floors"]} == {
        "dwa": False, "oracle+privileged": False,
    }  # fmt: skip
    lines = page.with_suffix(".md").read_text().splitlines()
    assert "cannot tell floors from baselines" in "".join(lines[:6])

    again = audit(capsys, str(suite), "--out", str(out))
    assert (again[0], again[1]) == (code, found)
    assert "36 runs, 36 complete, 0 jobs to do" in again[2]


def test_the_plan_of_an_audit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    argv = ["challenge-2020", "--scenarios", "2", "--dry-run", "--out", str(tmp_path / "runs")]
    code, plan, _ = audit(capsys, *argv)
    assert (code, plan["runs"], plan["left_out"]) == (0, 12, {})
    assert not (tmp_path / "runs").exists()


def test_a_robot_that_cannot_see_has_fewer_floors(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    argv = ["challenge-2020", "--scenarios", "1", "--dry-run", "--out", str(tmp_path / "runs")]
    blind = ["--set", "robots.robot.sensors={}"]
    code, plan, _ = audit(capsys, *argv, *blind)
    assert (code, plan["runs"]) == (0, 3)
    assert sorted(plan["left_out"]) == ["dwa", "oracle+privileged", "stop_and_go"]
    assert "needs 'lidar'" in plan["left_out"]["dwa"]


@pytest.mark.parametrize(
    ("argv", "says"),
    [
        (["no-such-suite"], "no-such-suite"),
        (["challenge-2020", "--only", "nothing"], "nothing"),
        (["challenge-2020", "--scenarios", "0"], "--scenarios"),
        (["challenge-2020", "--seeds", "x"], "--seeds"),
    ],
)
def test_what_is_wrong_is_told(
    argv: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["audit", *argv]) in (1, 2)
    output = capsys.readouterr().err
    assert says in output
    assert "Traceback" not in output


def plan_of(capsys: pytest.CaptureFixture[str], out: Path, *argv: str) -> dict[str, Any]:
    words = [w for w in TINY if w != "--no-floors"]
    assert cli.main(["campaign", *words, "--out", str(out), "--dry-run", "--json", *argv]) == 0
    plan: dict[str, Any] = json.loads(capsys.readouterr().out)
    return plan


def test_floors_belong_to_every_campaign_at_the_first_seed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Three scenarios: of dwa with three seeds, of four floors and a ceiling with one."""
    seeds = ["--planner", "dwa", "--seeds", "0..2"]
    assert plan_of(capsys, tmp_path, *seeds)["runs"] == 9 + 5 * 3
    assert plan_of(capsys, tmp_path, *seeds, "--no-floors")["runs"] == 9
    both = plan_of(capsys, tmp_path, *seeds, "--planner", "goal_seek")
    assert both["runs"] == 9 + 9 + 4 * 3  # who is named is run like any other
    changed = plan_of(capsys, tmp_path, "--planner", "goal_seek", "--planner-set", "speed=0.5")
    assert changed["runs"] == 3 + 5 * 3  # settings are not for floors


def test_many_scenarios_have_few_with_floors(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    argv = ["campaign", "challenge-2020", "--planner", "stand_still", "--out", str(tmp_path)]
    assert cli.main([*argv, "--dry-run", "--json"]) == 0
    plan = json.loads(capsys.readouterr().out)
    assert plan["runs"] == 162 + 4 * 18


@pytest.mark.slow
def test_floors_are_reused_like_any_other_run(tmp_path: Path) -> None:
    only = ["--only", "in-d0125-slow-c01-r02", "--floors"]
    code, summary, err = run(tmp_path, *only, "--planner", "goal_seek")
    assert code == 0, err
    assert summary["made"] == 5
    roles = {r.planner: r.role for r in Results.open(tmp_path).runs}
    assert roles == {**dict.fromkeys(FLOORS, "floor"), "oracle+privileged": "ceiling"}
    code, summary, _ = run(tmp_path, *only, "--planner", "dwa")
    assert (code, summary["made"]) == (0, 1)
