"""Runs of two robots on their way to the leaderboard, with real simulations."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path
from typing import Any

import pytest

from crowdbot import cli
from tests.core.bundle.made_up_runs import rewrite

pytestmark = pytest.mark.slow

PAIR = """\
crowdbot: 1
suite: {id: pair}
base:
  environment:
    kind: floor
    area: {x: [-10 m, 10 m], y: [-3 m, 3 m]}
    zones: {east: {x: [8 m, 10 m], y: [-3 m, 3 m]}, west: {x: [-10 m, -8 m], y: [-3 m, 3 m]}}
  robots:
    a:
      model: {kind: turtlebot2}
      control: differential_drive
      sensors: {odometry: {kind: wheel_odometry}}
      task: {start: [7.9 m, 0 m, 0 deg], goal: {zone: east}, time_limit: 1 s}
    b:
      model: {kind: pepper}
      control: force
      sensors: {odometry: {kind: wheel_odometry}}
      task: {start: [6 m, 0.5 m, 180 deg], goal: {zone: west}, time_limit: 1 s}
matrix:
  place:
    near: {robots.b.task.start: [7 m, 0.1 m, 180 deg]}
    far: {robots.b.task.start: [-6 m, 0.5 m, 180 deg]}
"""
#: Label of the planner -> name of its bundle.
BUNDLES = {"goal_seek": "one.cbz", "a=goal_seek,b=stand_still": "each.cbz"}


@pytest.fixture(scope="module")
def world(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two scenarios of two robots, and the bundles of two planners that have run them."""
    folder = tmp_path_factory.mktemp("fleet")
    (folder / "bundles").mkdir()
    (folder / "pair.yaml").write_text(PAIR, encoding="utf-8")
    planners = [word for label in BUNDLES for word in ("--planner", label)]
    assert cli.main(["-q", "campaign", str(folder / "pair.yaml"), *planners, "--no-floors",
                     "--no-replay", "--jobs", "1", "--out", str(folder / "runs")]) == 0  # fmt: skip
    for label, name in BUNDLES.items():
        assert cli.main(["-q", "bundle", str(folder / "runs"), "--suite",
                         str(folder / "pair.yaml"), "--planner", label, "--recordings",
                         "--out", str(folder / "bundles" / name)]) == 0  # fmt: skip
    return folder


def verified(
    world: Path, bundle: Path, capsys: pytest.CaptureFixture[str], *more: str
) -> tuple[int, dict[str, Any]]:
    """Exit code and what `verify` found."""
    capsys.readouterr()
    code = cli.main(["verify", str(bundle), "--suite", str(world / "pair.yaml"), "--json", *more])
    return code, json.loads(capsys.readouterr().out)


def test_bundles_of_two_robots_are_verified_and_ranked(
    world: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in BUNDLES.values():
        code, found = verified(world, world / "bundles" / name, capsys, "--sample", "1")
        assert (code, found["outcome"], found["findings"]) == (0, "verified", [])
        assert list(found["runs"].values()) == ["identical"]
    page = world / "leaderboard.html"
    capsys.readouterr()
    assert cli.main(["leaderboard", str(world / "bundles"), "--out", str(page), "--json"]) == 0
    (table,) = json.loads(capsys.readouterr().out)["tables"]
    assert {entry["file"] for entry in table["entries"]} == set(BUNDLES.values())
    assert all(label in page.read_text(encoding="utf-8") for label in BUNDLES)


@pytest.mark.parametrize(
    ("row", "finding"),
    [
        (b",success,S,corrected,0.5,", "success.corrected of the fleet is not the mean"),
        (b",success,S,corrected@b,0.0,", "its success of b is 1, which its time of arrival"),
        (b",success,S,corrected@a,1.0,", "success.corrected@c is of a robot that run.json"),
    ],
)
def test_scores_of_robots_that_do_not_fit_are_found(
    row: bytes, finding: str, world: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A fleet of which one arrives says 0.5; a forger lets every hash follow."""
    forged = row.replace(b"@a", b"@c").replace(b"0.5", b"1.0").replace(b"0.0", b"1.0")
    bundle = world / "bundles" / "one.cbz"
    names = [
        n for n in zipfile.ZipFile(bundle).namelist() if n.endswith("goal_seek/seed-0/scores.csv")
    ]
    with zipfile.ZipFile(bundle) as file:
        assert all(row in file.read(n) for n in names)
    changed = rewrite(bundle, dict.fromkeys(names, lambda c: c.replace(row, forged)), honest=True)
    code, found = verified(world, changed, capsys, "--sample", "0")
    changed.unlink()
    assert (code, found["outcome"]) == (1, "invalid")
    assert any(finding in text for text in found["findings"])
