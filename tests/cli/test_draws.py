"""``crowdbot draws``: what an organiser does, and what somebody does who cheats."""

from __future__ import annotations

import json
import shutil
import stat
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from crowdbot.cli import main
from crowdbot.cli.commands.challenge import verify
from crowdbot.core.registry.registry import discover
from crowdbot.dsl.suite.commitment import commitment_of
from crowdbot.errors import SpecError
from tests.paths import DATA, ROOT

Captured = pytest.CaptureFixture[str]
EXAMPLES = ROOT / "scenario_specs" / "examples"
PARTS = DATA / "diagnostics" / "parts"
SUITE = """\
crowdbot: 1
suite: {id: s}
base:
  extends: minimal.yaml
  robots.robot.task.time_limit: 1 s
matrix: {pace: {slow: {crowd.speed.mean: 1}, fast: {crowd.speed.mean: 2}}} # a comment stays
"""


#: These import Drake, or draw.
_SLOW = (
    ["view", "slow"], ["campaign", "--planner", "goal_seek"], ["audit"],
    ["simulate", "slow", "--planner", "goal_seek"],
)  # fmt: skip


@pytest.fixture
def suite(tmp_path: Path) -> Path:
    shutil.copy(PARTS / "minimal.yaml", tmp_path)
    (tmp_path / "s.yaml").write_text(SUITE)
    return tmp_path / "s.yaml"


def secret_of(suite: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(suite.with_suffix(".secret.json").read_text())
    return found


def test_errors_name_the_suite_and_no_copy_of_it(suite: Path, capsys: Captured) -> None:
    suite.write_text(SUITE.replace("crowd.speed.mean: 2", "crowd.sped: 2"))
    assert main(["draws", "commit", str(suite)]) == 1
    shown = capsys.readouterr().err
    assert f"{suite}:6:" in shown.replace("\n", "")
    assert ".try" not in shown
    assert sorted(suite.parent.iterdir()) == [suite.parent / "minimal.yaml", suite]


def test_commit_then_reveal(suite: Path, capsys: Captured) -> None:
    assert main(["draws", "commit", str(suite), "--json"]) == 0
    shown = capsys.readouterr().out
    secret = secret_of(suite)
    assert secret["salt"] not in shown
    assert str(secret["seed"]) not in shown
    assert stat.S_IMODE(suite.with_suffix(".secret.json").stat().st_mode) == 0o600
    assert len(bytes.fromhex(secret["salt"])) >= 16
    assert suite.read_text() == f"{SUITE}suite.commitment: {secret['commitment']}\n"
    assert main(["validate", str(suite)]) == 0
    assert main(["draws", "reveal", str(suite)]) == 0
    assert f"suite.seed: {secret['seed']}\n" in suite.read_text()
    capsys.readouterr()
    assert main(["draws", "check", str(suite), "--commitment", secret["commitment"]]) == 0
    assert "are revealed" in capsys.readouterr().out
    assert main(["lock", str(suite)]) == 0
    assert main(["lock", str(suite), "--check"]) == 0
    assert sorted(p.name for p in suite.parent.iterdir()) == [
        "minimal.yaml", "s.agents.csv", "s.lock.json", "s.secret.json", "s.yaml",
    ]  # fmt: skip


@pytest.mark.parametrize(
    "argv",
    [
        ["lock"], ["bundle"], *(pytest.param(a, marks=pytest.mark.slow) for a in _SLOW)
    ],
)  # fmt: skip
def test_what_needs_the_people_says_that_they_are_hidden(
    argv: list[str], suite: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(suite.parent)
    main(["draws", "commit", "s.yaml"])
    if argv == ["bundle"]:
        (suite.parent / "runs/s/slow/dwa/seed-0").mkdir(parents=True)
        record = {"scenario": "slow", "seed": 0, "complete": True, "status": "arrived"}
        (suite.parent / "runs/s/slow/dwa/seed-0/run.json").write_text(json.dumps(record))
        argv = ["bundle", "runs", "--partial", "--suite"]
        line = [*argv, "s.yaml"]
    else:
        line = [argv[0], "s.yaml", *argv[1:]]
    capsys.readouterr()
    assert main(line) == 1
    error = capsys.readouterr().err
    assert "hidden" in error
    assert "crowd.seed.root" in error
    assert not (suite.parent / "s.lock.json").exists()


def test_conditions_are_seen_and_practice_is_possible(suite: Path, capsys: Captured) -> None:
    main(["draws", "commit", str(suite)])
    capsys.readouterr()
    assert main(["expand", str(suite)]) == 0
    assert capsys.readouterr().out == "slow  hidden draw\nfast  hidden draw\n"
    assert main(["expand", str(suite), "--json"]) == 0
    assert {row["hash"] for row in json.loads(capsys.readouterr().out)} == {None}
    assert main(["expand", str(suite), "--set", "crowd.seed.root=1"]) == 0
    assert "cb1-sha256" in capsys.readouterr().out
    assert main(["expand", str(suite), "--one", "slow"]) == 0
    assert "not theirs" in capsys.readouterr().err


def test_a_seed_from_a_file(suite: Path, tmp_path: Path, capsys: Captured) -> None:
    file = tmp_path / "lottery.txt"
    for text in ("", "-1", "7 8", "1e3", str(2**63), "0x10"):
        file.write_text(text)
        assert main(["draws", "commit", str(suite), "--seed-file", str(file)]) == 1
        assert "a seed is a whole number" in capsys.readouterr().err
    file.write_text("42\n")
    assert main(["draws", "commit", str(suite), "--seed-file", str(file), "--print"]) == 0
    assert secret_of(suite)["seed"] == 42
    assert suite.read_text() == SUITE


def test_a_small_seed_cannot_be_found_by_trying(suite: Path, tmp_path: Path) -> None:
    """Two commitments to one seed have nothing in common: who tries seeds lacks the salt."""
    (tmp_path / "seed").write_text("1")
    found = set()
    for name in ("a", "b"):
        argv = ["draws", "commit", str(suite), "--seed-file", str(tmp_path / "seed"), "--print"]
        assert main([*argv, "--secret", str(tmp_path / name)]) == 0
        found.add(json.loads((tmp_path / name).read_text())["commitment"])
    assert len(found) == 2


def change_seed(secret: dict[str, Any], text: str) -> str:
    secret["seed"] = (secret["seed"] + 1) % 2**63
    return text


def change_document(secret: dict[str, Any], text: str) -> str:
    del secret
    return text.replace("mean: 2", "mean: 1.9")


def change_commitment(secret: dict[str, Any], text: str) -> str:
    return text.replace(secret["commitment"], f"sha256:{'0' * 64}")


def change_suite(secret: dict[str, Any], text: str) -> str:
    secret["suite"] = "other"
    return text


def change_both(secret: dict[str, Any], text: str) -> str:
    """A seed that the organiser likes better, with a commitment of its own in the secret."""
    secret["seed"] = 1
    secret["commitment"] = commitment_of(secret["document"], 1, secret["salt"])
    return text


@pytest.mark.parametrize(
    ("cheat", "says"),
    [
        (change_seed, "not those of its commitment"),
        (change_document, "the document was changed after the commitment (matrix.pace.fast."),
        (change_commitment, "its commitment is not that of the secret"),
        (change_suite, "the secret of 'other', not of 's'"),
        (change_both, "its commitment is not that of the secret"),
    ],
)
def test_nothing_but_what_was_committed_is_revealed(
    cheat: Any, says: str, suite: Path, capsys: Captured
) -> None:
    main(["draws", "commit", str(suite)])
    secret = secret_of(suite)
    suite.write_text(cheat(secret, suite.read_text()))
    suite.with_suffix(".secret.json").write_text(json.dumps(secret))
    before = suite.read_text()
    capsys.readouterr()
    assert main(["draws", "reveal", str(suite)]) == 1
    assert says in capsys.readouterr().err
    assert suite.read_text() == before


@pytest.mark.parametrize("argv", [["lock"], ["validate"], ["draws", "check"], ["expand"]])
def test_a_changed_seed_stops_every_reader(argv: list[str], suite: Path, capsys: Captured) -> None:
    main(["draws", "commit", str(suite)])
    main(["draws", "reveal", str(suite)])
    seed = secret_of(suite)["seed"]
    suite.write_text(suite.read_text().replace(str(seed), str(seed // 2 + 1)))
    capsys.readouterr()
    assert main([*argv, str(suite)]) == 1
    assert "s.yaml:7:19: error[E214]" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (SUITE.replace("id: s", "id: s, seed: 3"), "s.yaml:2:22: error[E215]"),
        (SUITE + "base.crowd.seed.root: 3\n", "no people are drawn from suite.seed"),
        (f"{{{SUITE.replace('crowdbot: 1', 'crowdbot: 1,')}", "error[E002]"),
        ("{crowdbot: 1, suite: {id: s}, base: {extends: minimal.yaml}}\n", "suite.commitment: sha"),
        (SUITE + "suite.salt: 0123456789abcdef0123456789abcdef\n", "error[E215]"),
        ("crowdbot: 1\nscenario: {id: s, extends: minimal.yaml}\n", "is a single scenario"),
    ],
)
def test_what_cannot_be_hidden(text: str, says: str, suite: Path, capsys: Captured) -> None:
    suite.write_text(text)
    assert main(["draws", "commit", str(suite)]) == 1
    assert says in capsys.readouterr().err
    assert suite.read_text() == text
    assert sorted(p.name for p in suite.parent.iterdir()) == ["minimal.yaml", "s.yaml"]


def test_verify_names_the_commitment_and_refuses_another_seed(
    suite: Path, capsys: Captured
) -> None:
    main(["draws", "commit", str(suite)])
    main(["draws", "reveal", str(suite)])
    manifest = SimpleNamespace(edition=SimpleNamespace(suite="s"))
    bundle: Any = SimpleNamespace(manifest=manifest, path="b.cbz")
    capsys.readouterr()
    assert verify._suite(bundle, discover(allow=()), str(suite)).scenarios
    assert f"seed and salt fit {secret_of(suite)['commitment']}" in capsys.readouterr().err
    seed = str(secret_of(suite)["seed"])
    suite.write_text(suite.read_text().replace(f"seed: {seed}", "seed: 5"))
    with pytest.raises(SpecError):
        verify._suite(bundle, discover(allow=()), str(suite))


def test_a_secret_is_never_lost(suite: Path, capsys: Captured) -> None:
    main(["draws", "commit", str(suite), "--print"])
    before = secret_of(suite)
    capsys.readouterr()
    assert main(["draws", "commit", str(suite)]) == 1
    assert "there already" in capsys.readouterr().err
    assert secret_of(suite) == before
    assert suite.read_text() == SUITE


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"secret": 2}', "\0"])
def test_what_is_not_a_secret(text: str, suite: Path, capsys: Captured) -> None:
    main(["draws", "commit", str(suite)])
    suite.with_suffix(".secret.json").write_text(text)
    capsys.readouterr()
    assert main(["draws", "reveal", str(suite)]) == 1
    assert "s.secret.json is not a secret of hidden draws" in capsys.readouterr().err


def test_twice_is_refused(suite: Path, capsys: Captured) -> None:
    assert main(["draws", "reveal", str(suite)]) == 1
    main(["draws", "commit", str(suite)])
    assert main(["draws", "commit", str(suite), "--secret", str(suite) + ".2"]) == 1
    assert "committed already" in capsys.readouterr().err
    main(["draws", "reveal", str(suite)])
    assert main(["draws", "reveal", str(suite)]) == 1
    assert "revealed already" in capsys.readouterr().err


def test_check_compares_with_what_was_published(suite: Path, capsys: Captured) -> None:
    assert main(["draws", "check", str(suite)]) == 0
    assert "nothing was committed to" in capsys.readouterr().out
    main(["draws", "commit", str(suite)])
    capsys.readouterr()
    assert main(["draws", "check", str(suite), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["draws"] == "hidden"
    assert main(["draws", "check", str(suite), "--commitment", f"sha256:{'0' * 64}"]) == 1
    assert "not sha256:000" in capsys.readouterr().err


def test_the_building_is_committed_to_as_well(suite: Path, capsys: Captured) -> None:
    plans = suite.parent / "plans"
    shutil.copytree(EXAMPLES / "plans", plans)
    text = (EXAMPLES / "world_floor_plan.yaml").read_text().replace("scenario:\n", "base:\n")
    text = text.replace("  id: world-floor-plan\n", "").replace(
        "  title: An office", "  # An office"
    )
    suite.write_text(text.replace("crowdbot: 1\n", "crowdbot: 1\nsuite: {id: s}\n"))
    assert main(["draws", "commit", str(suite)]) == 0
    assert '[{"path": "plans/office.geojson", "sha256": "' in capsys.readouterr().out
    assert main(["draws", "check", str(suite)]) == 0
    plan = plans / "office.geojson"
    before = plan.read_text()
    plan.write_text(before + "\n")
    for argv in (["draws", "check"], ["draws", "reveal"], ["validate"]):
        capsys.readouterr()
        assert main([*argv, str(suite)]) == 1
        shown = capsys.readouterr().err
        assert "'plans/office.geojson' was changed after the commitment" in shown
    plan.write_text(before)
    assert main(["draws", "reveal", str(suite)]) == 0
    assert main(["lock", str(suite)]) == 0
