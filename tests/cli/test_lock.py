from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from crowdbot.cli import main
from crowdbot.core.scenarios import lock as locks
from tests.paths import DATA

Captured = pytest.CaptureFixture[str]
PARTS = DATA / "diagnostics" / "parts"
SUITE = """\
crowdbot: 1
suite: {id: s}
base:
  extends: minimal.yaml
  robots.robot.task.time_limit: 1 s
matrix: {pace: {slow: {crowd.speed.mean: 1}, fast: {crowd.speed.mean: 2}}}
"""


@pytest.fixture
def suite(tmp_path: Path) -> Path:
    shutil.copy(PARTS / "minimal.yaml", tmp_path)
    (tmp_path / "s.yaml").write_text(SUITE)
    return tmp_path / "s.yaml"


def test_lock_and_check(suite: Path, capsys: Captured) -> None:
    assert main(["lock", str(suite), "--check"]) == 1
    assert "has no lock" in capsys.readouterr().err
    assert main(["lock", str(suite)]) == 0
    assert "2 scenarios, 2 tables of agents (2 drawn, 0 kept)" in capsys.readouterr().out
    assert main(["lock", str(suite), "--check"]) == 0
    assert capsys.readouterr().out == "s: the lock fits, 2 scenarios\n"
    assert main(["lock", str(suite), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["drawn"] == 0
    assert main(["lock", str(suite), "--json", "--redraw"]) == 0
    assert json.loads(capsys.readouterr().out)["drawn"] == 2
    assert main(["lock", str(suite), "--check", "--redraw"]) == 2


def test_a_seed_that_nobody_wrote_is_told(suite: Path, capsys: Captured) -> None:
    assert main(["lock", str(suite)]) == 0
    assert "the suite gives no seed, so 0 holds" in capsys.readouterr().err
    suite.write_text(SUITE.replace("id: s", "id: s, seed: 0"))
    assert main(["lock", str(suite)]) == 0
    assert capsys.readouterr().err == ""


def test_check_lists_every_difference(suite: Path, capsys: Captured) -> None:
    main(["lock", str(suite)])
    suite.write_text(SUITE.replace("fast:", "quick:").replace("mean: 1", "mean: 1.1"))
    capsys.readouterr()
    assert main(["lock", str(suite), "--check"]) == 1
    shown = capsys.readouterr()
    assert shown.out.splitlines() == [
        "changed slow", "    crowd.speed.mean: changed, now 1.1", "added quick", "removed fast",
    ]  # fmt: skip
    assert shown.err == f"3 differences; to accept: 'crowdbot lock {suite}'\n"
    assert main(["lock", str(suite), "--check", "--json"]) == 1
    found = json.loads(capsys.readouterr().out)
    assert found["ok"] is False
    assert found["differences"][0] == {
        "what": "changed", "id": "slow", "details": ["crowd.speed.mean: changed, now 1.1"],
    }  # fmt: skip


def test_an_installed_suite_is_not_changed(suite: Path, capsys: Captured) -> None:
    folder = suite.parent / "site-packages" / "acme"
    shutil.copytree(suite.parent, folder, ignore=shutil.ignore_patterns("site-packages"))
    assert main(["lock", str(folder / "s.yaml")]) == 1
    assert "belongs to an installed package" in capsys.readouterr().err
    assert not list(folder.glob("*.json"))


@pytest.mark.slow
def test_simulate_reads_locked_agents(
    suite: Path, tmp_path: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise AssertionError("agents were drawn")

    main(["lock", str(suite)])
    simulate = [
        "simulate",
        str(suite),
        "slow",
        "--planner",
        "goal_seek",
        "--out",
        str(tmp_path / "r"),
    ]
    with monkeypatch.context() as patched:
        patched.setattr(locks, "realise", refuse)
        capsys.readouterr()
        assert main([*simulate, "--json"]) == 0
        run = json.loads(capsys.readouterr().out)
    assert run["agents"] == "locked"
    locked = json.loads(suite.with_suffix(".lock.json").read_text())["scenarios"]["slow"]
    assert run["hashes"]["realisation"] == locked["realisation"]
    assert run["hashes"]["spec"] == locked["spec"]
    assert main([*simulate, "--json", "--no-references", "--set", "crowd.speed.mean=1.5"]) == 0
    assert json.loads(capsys.readouterr().out)["agents"] == "drawn"
    suite.write_text(SUITE.replace("mean: 1}", "mean: 1.1}"))
    assert main(simulate) == 1
    assert f"'crowdbot lock {suite}'" in capsys.readouterr().err
