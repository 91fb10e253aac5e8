"""Packing and checking: what is refused, and what a tampered bundle is told."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from crowdbot.core.bundle.archive import open_archive
from crowdbot.core.bundle.check import check_members, check_suite, claimed_runs
from crowdbot.core.bundle.manifest import MANIFEST
from crowdbot.core.bundle.pack import Submission, pack
from crowdbot.core.scenarios.library import open_suite
from crowdbot.errors import InputError, UnknownNameError
from tests.core.bundle.made_up_runs import make_bundle, make_runs, registry, rewrite, write_suite


def packed(folder: Path, root: Path, planner: str = "dwa", **more: Any) -> Any:
    expansion, lock = open_suite(str(folder / "tiny.yaml"), registry())
    submission = Submission(root=root, planner=planner, **more)
    return pack(submission, expansion, lock, registry(), folder / "team.cbz")


@pytest.fixture
def runs(tmp_path: Path) -> Path:
    make_runs(tmp_path / "runs", write_suite(tmp_path))
    return tmp_path / "runs"


def problems(bundle: Path) -> list[str]:
    suite = next(bundle.parent.glob("tiny.yaml"))
    expansion, _ = open_suite(str(suite), registry())
    with open_archive(bundle) as archive:
        _, wrong = claimed_runs(archive)
        return [*check_members(archive), *wrong, *check_suite(archive, expansion, registry())]


@pytest.mark.slow
def test_a_whole_set_is_packed_and_fits(tmp_path: Path) -> None:
    bundle = make_bundle(tmp_path, team="Us", seeds=(0, 1))
    assert problems(bundle) == []
    with open_archive(bundle) as archive:
        manifest = archive.manifest
    assert (manifest.team, manifest.label, manifest.classed) == ("Us", "dwa", "sensors only")
    assert (len(manifest.runs), manifest.seeds, manifest.missing) == (6, [0], [])
    assert manifest.edition.scenarios == 6
    assert manifest.edition.name.startswith("tiny · ")


def test_runs_made_from_python_get_the_axes_of_the_suite(tmp_path: Path) -> None:
    """They are whole and of its scenarios, but `crowdbot.simulate` knows of one scenario only."""
    make_runs(tmp_path / "runs", write_suite(tmp_path), axes={})
    packed(tmp_path, tmp_path / "runs")
    assert problems(tmp_path / "team.cbz") == []
    record = next((tmp_path / "runs").rglob("run.json"))
    assert json.loads(record.read_text())["axes"] == {}  # what lies there stays as it is


def test_missing_runs_are_listed_and_refused(tmp_path: Path, runs: Path) -> None:
    gone = sorted((runs / "tiny").iterdir())[2]
    shutil.rmtree(gone)
    with pytest.raises(InputError, match=f"1 of 6 runs are missing:\n  {gone.name} seed-0"):
        packed(tmp_path, runs)
    assert not (tmp_path / "team.cbz").exists()
    assert packed(tmp_path, runs, partial=True).missing == [f"{gone.name} seed-0"]
    assert problems(tmp_path / "team.cbz") == []


def test_every_scenario_has_the_seeds_of_the_suite(tmp_path: Path, runs: Path) -> None:
    suite = tmp_path / "tiny.yaml"
    suite.write_text(suite.read_text() + "seeds.runs: [0, 3]\n")
    with pytest.raises(InputError, match=r"6 of 12 runs are missing:\n  .* seed-3"):
        packed(tmp_path, runs)
    for folder in (runs / "tiny").glob("*/dwa"):
        (folder / "seed-0").rename(folder / "seed-3")
    suite.write_text(suite.read_text().replace("seeds.runs: [0, 3]\n", ""))
    with pytest.raises(InputError, match="with seeds 3 only; those of tiny are 0"):
        packed(tmp_path, runs)


def test_interrupted_runs_are_not_packed(tmp_path: Path, runs: Path) -> None:
    folder = next((runs / "tiny").glob("*/dwa"))
    (folder / "seed-0").rename(folder / "seed-0.partial")
    with pytest.raises(InputError, match="1 of 6 runs are missing"):
        packed(tmp_path, runs)


@pytest.mark.parametrize("partial", [False, True])
def test_nothing_but_changed_scenarios(tmp_path: Path, runs: Path, partial: bool) -> None:
    for folder in (runs / "tiny").iterdir():
        folder.rename(folder.with_name(f"{folder.name}+de08"))
    with pytest.raises(InputError, match=r"no run of 'dwa' is complete .*\+de08, was interrupted"):
        packed(tmp_path, runs, partial=partial)
    assert not (tmp_path / "team.cbz").exists()


def test_unknown_planners(tmp_path: Path, runs: Path) -> None:
    with pytest.raises(UnknownNameError, match="'dwaa'; did you mean 'dwa'"):
        packed(tmp_path, runs, "dwaa")
    with pytest.raises(InputError, match="no runs of tiny"):
        packed(tmp_path, tmp_path / "nowhere")


def edit(folder: Path, **changes: Any) -> None:
    record = json.loads((folder / "run.json").read_text())
    (folder / "run.json").write_text(json.dumps(record | changes))


def test_runs_of_another_state_of_the_suite_are_refused(tmp_path: Path, runs: Path) -> None:
    folder = next((runs / "tiny").glob("*/dwa/seed-0"))
    edit(folder, hashes={"spec": "other", "realisation": "x", "trajectory": "y"})
    with pytest.raises(InputError, match="of another state of tiny"):
        packed(tmp_path, runs)


@pytest.mark.parametrize(("key", "value"), [
    ("versions", {"crowdbot": "9"}),
    ("planner", {"kind": "dwa", "name": "dwa", "label": "dwa", "horizon": 9}),
    ("pinned", False),
])  # fmt: skip
def test_runs_that_are_not_alike_are_refused(
    tmp_path: Path, runs: Path, key: str, value: Any
) -> None:
    folder = sorted((runs / "tiny").glob("*/dwa/seed-0"))[-1]
    edit(folder, **{key: value})
    with pytest.raises(InputError, match=f"have different '{key}'"):
        packed(tmp_path, runs)


def test_a_missing_file_of_a_run_is_told(tmp_path: Path, runs: Path) -> None:
    next((runs / "tiny").glob("*/dwa/seed-0/scores.csv")).unlink()
    with pytest.raises(InputError, match=r"scores\.csv: missing"):
        packed(tmp_path, runs)
    with pytest.raises(InputError, match=r"run\.mcap: missing"):
        packed(tmp_path, runs, recordings=True)


# ------------------------------------------------------------------------ tampering
@pytest.fixture(scope="module")
def bundle(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_bundle(tmp_path_factory.mktemp("check"))


def members(bundle: Path, suffix: str) -> list[str]:
    with open_archive(bundle) as archive:
        return sorted(n for n in archive.names if n.endswith(suffix))


def in_record(**changes: Any) -> Callable[[bytes], bytes]:
    return lambda content: json.dumps(json.loads(content) | changes).encode()


def test_a_missing_member_is_named(bundle: Path) -> None:
    name = members(bundle, "scores.csv")[0]
    found = problems(rewrite(bundle, {name: lambda _: None}))
    assert f"{name} is missing" in found


def test_a_member_that_is_not_listed_is_named(bundle: Path) -> None:
    assert problems(rewrite(bundle, {}, {"extra.json": b"{}"})) == [
        "extra.json is not in the manifest"
    ]


def test_a_changed_score_is_noticed(bundle: Path) -> None:
    name = members(bundle, "scores.csv")[0]
    found = problems(rewrite(bundle, {name: lambda c: c.replace(b",risk,", b",riskk,")}))
    assert any("was changed" in text for text in found)


HASHES = ("spec", "realisation", "trajectory")


@pytest.mark.slow
@pytest.mark.parametrize(("change", "why"), [
    ({"seed": 5}, "its run_id is not the hash"),
    ({"planner": {"kind": "dwa", "label": "dwa"}}, "run.json: 'planner.name': field required"),
    ({"planner": {"kind": "dwa", "label": "dwa", "name": "dwa"}}, "its planner is"),
    ({"versions": {"crowdbot": "9.9"}}, "its versions are not those of the manifest"),
    ({"privileged": True}, "the manifest says 'sensors only', the run does not"),
    ({"hashes": {"spec": "a", "trajectory": "b"}}, "'hashes.realisation': field required"),
    ({"hashes": {"spec": "a", "realisation": "c", "trajectory": "b"}}, "the trajectory's hash"),
    ({"hashes": dict.fromkeys(HASHES, "a")}, "its people are not those of the lock"),
    ({"hashes": dict.fromkeys(HASHES, "b")}, "its hash is not that of the scenario that is"),
    ({"hashes": 3}, "run.json: 'hashes': input should be"),
    ({"goal_time": None}, "its status is 'arrived', but it has no time of arrival"),
    ({"status": "toppled"}, "its status is 'toppled', but it has no toppled_time"),
])  # fmt: skip
def test_a_forged_record_contradicts_itself(bundle: Path, change: Any, why: str) -> None:
    name = members(bundle, "run.json")[0]
    found = problems(rewrite(bundle, {name: in_record(**change)}, honest=True))
    assert any(why in text for text in found), found


def test_another_scenario_is_noticed(bundle: Path) -> None:
    name = members(bundle, "scenario.yaml")[0]
    easier = rewrite(bundle, {name: lambda c: c + b"\n# easier\n"}, honest=True)
    assert any("is not the scenario that its hash stands for" in p for p in problems(easier))


def test_another_lock_is_another_edition(bundle: Path) -> None:
    other = rewrite(bundle, {"suite.lock.json": lambda c: c + b" "}, honest=True)
    assert problems(other) == ["the edition is not that of suite.lock.json"]


def test_runs_that_the_manifest_forgets_are_noticed(bundle: Path) -> None:
    def forget(content: bytes) -> bytes:
        manifest = json.loads(content)
        manifest["runs"] = manifest["runs"][1:]
        return json.dumps(manifest).encode()

    found = problems(rewrite(bundle, {MANIFEST: forget}))
    assert any("left out without being listed as missing: 1 run, " in p for p in found)


@pytest.mark.parametrize("content", [b"", b"\xff\xfe", b"{", b"[]"])
def test_records_and_scores_that_are_none(bundle: Path, content: bytes) -> None:
    for suffix in ("run.json", "scores.csv"):
        name = members(bundle, suffix)[0]
        assert problems(rewrite(bundle, {name: lambda _: content}, honest=True))


def test_a_suite_without_a_matrix(tmp_path: Path) -> None:
    from tests.core.bundle.made_up_runs import TINY

    suite = tmp_path / "tiny.yaml"
    head, _, _ = TINY.partition("only:")
    text = head.replace("extends: builtin:challenge-2020.yaml\n", "").replace(
        "base:\n",
        'base:\n  extends: ["builtin:parts/corridor_50x10.yaml", "builtin:parts/turtlebot2.yaml"]\n'
        "  robots.robot.task: {start: [2.5 m, 0 m, 0 deg], goal: {zone: robot_goal}}\n",
    )
    suite.write_text(text)
    make_runs(tmp_path / "runs", suite)
    assert (tmp_path / "runs/scenarios/tiny/dwa/seed-0").is_dir()
    manifest = packed(tmp_path, tmp_path / "runs")
    assert [r.directory for r in manifest.runs] == ["runs/scenarios/tiny/dwa/seed-0"]
    assert problems(tmp_path / "team.cbz") == []
