"""Reference scores: there and back, beside own results, and made again bit by bit."""

from __future__ import annotations

import json
import lzma
from dataclasses import replace
from pathlib import Path

import pytest

import crowdbot
from crowdbot.cli import main
from crowdbot.core.campaign.extend_references import extended, without_known
from crowdbot.core.campaign.plan import make_plan
from crowdbot.core.campaign.remake import RemakeSetup, remake, sample_of
from crowdbot.core.campaign.request import CampaignRequest
from crowdbot.core.registry.registry import discover
from crowdbot.core.results.chosen_planners import of_planners
from crowdbot.core.results.reference_file import (
    LARGEST,
    METRICS,
    open_references,
    read_references,
    shipped_file,
    write_references,
)
from crowdbot.core.results.results import Results
from crowdbot.core.results.with_reference import (
    among_references,
    place_of_run,
    with_reference,
)
from crowdbot.errors import InputError, UnknownNameError

SUITE, SCENARIO = "social-guidelines", "frontal_approach"


@pytest.fixture(scope="module")
def root(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs")
    scenario = crowdbot.load(SUITE, SCENARIO)
    for planner in ("goal_seek", "stand_still"):
        crowdbot.simulate(
            scenario, planner=planner, out=folder, suite=SUITE, references=False, replay=False,
            record="none", metrics=["safe_efficiency", "success", "fluency"],
        )  # fmt: skip
    return folder


@pytest.fixture(scope="module")
def file(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("references") / "r.json.xz"
    write_references(out, Results.open(root), ["by hand"])
    return out


def test_what_is_written_is_read_again(root: Path, file: Path) -> None:
    wanted, found = Results.open(root), read_references(file)
    assert found.commands == ("by hand",)
    assert [r.run_id for r in found.results.runs] == [r.run_id for r in wanted.runs]
    for one, other in zip(found.results.runs, wanted.runs, strict=True):
        assert one.trajectory_hash == other.trajectory_hash
        assert (one.status, one.goal_time, one.axes) == (other.status, other.goal_time, other.axes)
    kept = {(s.run_id, s.metric, s.variant): s for s in wanted.scores if s.metric in METRICS}
    there = {(s.run_id, s.metric, s.variant): s.value for s in found.results.scores}
    assert set(there) == set(kept)
    for key, value in there.items():
        assert value == pytest.approx(kept[key].value, rel=1e-5)
    assert "fluency" not in {s.metric for s in found.results.scores}
    assert found.held == (f"{SUITE}: 2 runs, 1 scenarios, seeds 0; goal_seek, stand_still",)


def test_equal_results_give_equal_bytes(root: Path, file: Path, tmp_path: Path) -> None:
    write_references(tmp_path / "r.json.xz", Results.open(root), ["by hand"])
    assert (tmp_path / "r.json.xz").read_bytes() == file.read_bytes()


def test_what_was_read_is_written_as_it_was(file: Path, tmp_path: Path) -> None:
    found = read_references(file)
    write_references(tmp_path / "r.json.xz", found.results, found.commands)
    assert (tmp_path / "r.json.xz").read_bytes() == file.read_bytes()


def test_references_are_extended_by_what_is_missing(file: Path, tmp_path: Path) -> None:
    out, runs = tmp_path / "more.json.xz", tmp_path / "runs"
    asked = [
        "references", "make", SUITE, "--only", SCENARIO, "--extend", str(file), "--out", str(out),
        "--runs", str(runs), "--seeds", "0", "--jobs", "1",
        "--planner", "goal_seek", "--planner", "stand_still", "--planner", "wall_hug",
    ]  # fmt: skip
    assert main(asked) == 0
    old, new = read_references(file), read_references(out)
    assert [r.planner for r in new.results.runs] == ["goal_seek", "stand_still", "wall_hug"]
    for one, other in zip(new.results.runs, old.results.runs, strict=False):
        assert (one.run_id, one.trajectory_hash) == (other.run_id, other.trajectory_hash)
    assert {s.run_id for s in new.results.scores} == {r.run_id for r in new.results.runs}
    assert {p.parent.name for p in runs.glob(f"*/{SCENARIO}/*/seed-*")} == {"wall_hug"}
    made = f"crowdbot references make {SUITE} --only {SCENARIO} --planner goal_seek --planner "
    made += "stand_still --planner wall_hug --seeds 0"
    assert new.commands == ("by hand", made)  # without folders of this machine
    first = out.read_bytes()
    assert main([*asked[:-1], "stand_still"]) == 0  # nothing is missing
    assert out.read_bytes() == file.read_bytes() != first


def test_a_planner_with_other_parameters_is_made_again(file: Path, tmp_path: Path) -> None:
    found, registry = read_references(file).results, discover()
    request = CampaignRequest(
        suites=[SUITE], planners=["goal_seek", "stand_still"], only=[SCENARIO], out=tmp_path
    )
    plan = make_plan(request, registry)
    assert without_known(plan, found.runs).jobs == ()
    (one, *_) = found.runs
    planner = one.record.planner.model_copy(update={"speed": 0.123})
    before = replace(one, record=one.record.model_copy(update={"planner": planner}))
    left = without_known(plan, [before, *found.runs[1:]])
    assert {job.label for job in left.jobs if job.kind == "run"} == {one.planner}


def test_a_run_that_is_made_again_takes_the_place_of_the_old_one(file: Path) -> None:
    old = read_references(file).results
    (one, *_) = old.runs
    changed = one.record.model_copy(update={"sim_time": 1.0})
    new = Results(runs=(replace(one, record=changed),), scores=())
    both = extended(old, new)
    assert [(r.planner, r.sim_time) for r in both.runs] == [
        (old.runs[1].planner, old.runs[1].sim_time), (one.planner, 1.0),
    ]  # fmt: skip
    assert {s.run_id for s in both.scores} == {old.runs[1].run_id}


def test_scores_of_two_versions_of_a_metric_do_not_mix(file: Path, tmp_path: Path) -> None:
    found = read_references(file)
    first, second = found.results.runs
    metrics = dict(second.record.metrics)
    name = next(iter(metrics))
    metrics[name] = metrics[name].model_copy(update={"version": 99})
    other = replace(second, record=second.record.model_copy(update={"metrics": metrics}))
    with pytest.raises(InputError, match=f"another version of {name}; make all"):
        write_references(
            tmp_path / "r.json.xz", replace(found.results, runs=(first, other)), ["by hand"]
        )


def test_own_planners_stand_among_the_references(root: Path, file: Path) -> None:
    own = Results.open(root)
    own = replace(own, runs=tuple(r for r in own.runs if r.planner == "goal_seek"))
    own = replace(own, scores=tuple(s for s in own.scores if s.run_id == own.runs[0].run_id))
    both, known = with_reference(own, read_references(file).results)
    assert known == ("goal_seek (reference)", "stand_still (reference)")
    (line,) = among_references(both, known)
    assert line.startswith("goal_seek: number 1 of 3 by safe efficiency in 1 scenario: goal_seek ")
    assert line.endswith("stand_still 0.00")


def test_a_run_has_a_place_among_the_references(root: Path, file: Path) -> None:
    own, given = Results.open(root), read_references(file).results
    (run,) = (r for r in own.runs if r.planner == "goal_seek")
    scores = [s for s in own.scores if s.run_id == run.run_id]
    place = place_of_run(run.record, scores, given)
    assert place.startswith("number 1 of 3 by safe efficiency: goal_seek ")
    with pytest.raises(InputError, match="has no score safe_efficiency"):
        place_of_run(run.record, [], given)
    with pytest.raises(InputError, match="no reference run of"):
        place_of_run(run.record, scores, replace(given, runs=()))


def test_scenarios_without_a_reference_are_left_out(
    file: Path, root: Path, caplog: pytest.LogCaptureFixture
) -> None:
    own = Results.open(root)
    (run, *_) = own.runs
    ids = {"scenario": "other", "hashes": run.record.hashes}
    other = replace(run, record=run.record.model_copy(update=ids), entry="other")
    both, known = with_reference(
        replace(own, runs=(*own.runs, other)), read_references(file).results
    )
    assert {r.scenario for r in both.runs} == {run.scenario}
    assert "1 scenario without a reference run left out: other" in caplog.text
    for pattern, left in (("goal*", 2), ("stand_still", 2), ("*", 4)):
        assert len(of_planners(both, [pattern]).runs) == left
    assert len(of_planners(both, ["*(reference)"]).runs) == len(known)
    with pytest.raises(UnknownNameError, match="unknown planner 'wall'"):
        of_planners(both, ["wall"])


def test_a_privileged_planner_is_found_by_its_name_alone() -> None:
    known = read_references(shipped_file()).results
    chosen = of_planners(known, ["oracle"])
    assert {run.planner for run in chosen.runs} == {"oracle+privileged"}
    assert len(chosen.runs) == len(of_planners(known, ["oracle+privileged"]).runs)


def test_results_show_them_in_one_word(
    root: Path, file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["results", "--runs", str(root), "--reference", str(file)]) == 0
    output = capsys.readouterr().out
    assert "goal_seek: number" in output
    assert "(reference)" in output


def test_other_platforms_and_changed_runs_are_told_apart(file: Path) -> None:
    (run, _) = read_references(file).results.runs
    setup = RemakeSetup(registry=discover())
    assert remake(setup, run) == "identical"
    hashes = run.record.hashes.model_copy(update={"trajectory": "cb1-sha256:0"})
    edited = run.record.model_copy(update={"hashes": hashes})
    assert remake(setup, replace(run, record=edited)) == "different"
    elsewhere = edited.model_copy(update={"machine": {"processor": "another"}})
    assert remake(setup, replace(run, record=elsewhere)) == "different_platform"
    scenario = edited.hashes.model_copy(update={"spec": "cb1-sha256:0"})
    changed = edited.model_copy(update={"hashes": scenario})
    assert remake(setup, replace(run, record=changed)) == "changed"


def test_damaged_files_end_as_one_line(file: Path, tmp_path: Path) -> None:
    document = json.loads(lzma.decompress(file.read_bytes()))
    for number, content in enumerate(
        (
            b"",
            file.read_bytes()[:-20],
            lzma.compress(b"{}"),
            lzma.compress(json.dumps({**document, "references": 9}).encode()),
            lzma.compress(json.dumps({**document, "runs": [[0]]}).encode()),
            lzma.compress(b" " * 100_000_000),
        )
    ):
        bad = tmp_path / f"{number}.json.xz"
        bad.write_bytes(content)
        with pytest.raises(InputError) as caught:
            open_references(str(bad))
        assert "\n" not in str(caught.value)


def test_the_file_that_comes_with_crowdbot_is_small_and_true() -> None:
    assert len(shipped_file().read_bytes()) < LARGEST
    found = open_references("crowdbot")
    assert found is not None
    runs = found.results.runs
    assert {r.suite for r in runs} >= {"social-guidelines"}
    shortest = min((r for r in runs if r.planner == "dwa"), key=lambda r: r.sim_time)
    assert remake(RemakeSetup(registry=discover()), shortest) in ("identical", "different_platform")


def test_a_sample_is_that_of_its_seed() -> None:
    found = open_references("crowdbot")
    assert found is not None
    runs = found.results.runs
    assert sample_of(runs, 3, 7) == sample_of(runs, 3, 7) != sample_of(runs, 3, 8)
    assert sample_of(runs, None, 7) == list(runs)
