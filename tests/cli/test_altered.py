"""Runs of scenarios that ``--set`` changed: a folder of their own, left out of results."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import pytest

import crowdbot
from crowdbot import cli
from crowdbot.core.campaign.job import Job, JobOutcome, SuiteSource
from crowdbot.core.campaign.run import _failure
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow
from crowdbot.core.runs.run_options import RunOptions
from tests.core.report.report_cases import campaign
from tests.core.results.made_up_record import made_up_record

SCENARIO = """
crowdbot: 1
scenario:
  id: alone
  environment:
    kind: corridor
    length: 12 m
    width: 8 m
    zones: {all: {x: [0 m, 12 m], y: [-4 m, 4 m]}, end: {x: [10 m, 12 m], y: [-2 m, 2 m]}}
  robots:
    robot:
      model: {kind: turtlebot2}
      task: {start: [2 m, 0 m, 0 deg], goal: {zone: end}, time_limit: 1 s}
"""
SHORT = "robots.robot.task.time_limit=0.25 s"


Tell = Callable[..., tuple[str, str]]


@pytest.fixture
def output_of(capsys: pytest.CaptureFixture[str]) -> Tell:
    """A function that returns output and messages of a command that ends well."""

    def tell(*words: str) -> tuple[str, str]:
        capsys.readouterr()
        assert cli.main(list(words)) == 0
        captured = capsys.readouterr()
        return captured.out, captured.err

    return tell


@pytest.fixture(scope="module")
def root(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run as written, and one of an altered scenario."""
    folder = tmp_path_factory.mktemp("altered")
    (folder / "alone.yaml").write_text(SCENARIO)
    for more in ((), ("--set", SHORT)):
        words = ("simulate", str(folder / "alone.yaml"), "--planner", "goal_seek", *more)
        out = ("--out", str(folder / "runs"), "--quiet", "--no-references")
        assert cli.main([*words, *out]) == 0
    return folder / "runs"


def planners(lines: str) -> Sequence[object]:
    return [line["n"] + line["failed"] for line in json.loads(lines) if line["metric"] == "success"]


def test_the_folder_says_what_was_altered(root: Path) -> None:
    folders = sorted(p.name for p in (root / "scenarios").iterdir())
    assert folders[0] == "alone"
    assert folders[1].startswith("alone+time_limit=0.25_s-")


def test_results_leave_them_out_and_say_so(root: Path, output_of: Tell) -> None:
    out, message = output_of("results", "--runs", str(root), "--metric", "success", "--json")
    assert planners(out) == [1]
    assert f"1 run of altered scenarios left out ({SHORT})" in message
    out, message = output_of(
        "results", "--runs", str(root), "--metric", "success", "--json", "--altered"
    )
    assert planners(out) == [1, 1]
    assert "left out" not in message
    suites = {line["suite"] for line in json.loads(out)}
    assert {name.rpartition("-")[0] or name for name in suites} == {
        "scenarios", "scenarios+time_limit=0.25_s",
    }  # fmt: skip
    by_suite = output_of("results", "--runs", str(root), "--altered", "--by", "suite", "--json")[0]
    assert {line["suite"] for line in json.loads(by_suite)} == suites


def test_the_table_names_what_was_altered(root: Path, output_of: Tell) -> None:
    out, _ = output_of("results", "--runs", str(root), "--metric", "success", "--altered")
    assert "scenarios+time_limit=0.25_s-" in out
    assert "suite" not in output_of("results", "--runs", str(root), "--metric", "success")[0]


def test_a_metric_that_no_run_has_is_told_where_all_are_left_out(
    root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(root / "scenarios", tmp_path / "scenarios")
    shutil.rmtree(tmp_path / "scenarios" / "alone")
    assert cli.main(["results", "--runs", str(tmp_path), "--metric", "speed"]) == 1
    message = capsys.readouterr().err
    assert "1 run of altered scenarios left out" in message
    assert "metric 'speed' was not scored in these runs; 'crowdbot evaluate RUNS" in message
    assert cli.main(["results", "--runs", str(tmp_path), "--metric", "success"]) == 0


def test_report_needs_no_choice_of_suite(root: Path, tmp_path: Path, output_of: Tell) -> None:
    output_of("report", str(root), "--out", str(tmp_path / "report.html"))


def test_python_leaves_them_out_too(root: Path) -> None:
    assert len(crowdbot.results(root).runs) == 1
    both = crowdbot.results(root, altered=True)
    plain, altered = (run.suite for run in both.runs)
    assert plain == "scenarios"
    assert altered.startswith("scenarios+time_limit=0.25_s-")


def test_runs_of_earlier_versions_are_told_by_their_id() -> None:
    ids = ("s0", "s0+1f3a", "s0+calibrated", "s0+calibrated+1f3a")
    rows = [RunRow(record=made_up_record(scenario=s, run_id=s), directory=s) for s in ids]
    kept = Results(runs=tuple(rows)).without_altered().runs
    assert [row.scenario for row in kept] == ["s0", "s0+calibrated"]


def test_report_takes_a_suite_by_id_and_by_file(
    root: Path, tmp_path: Path, output_of: Tell
) -> None:
    for suite in ("scenarios", str(root.parent / "alone.yaml")):
        output_of("report", str(root), "--suite", suite, "--out", str(tmp_path / "report.html"))


def test_bundle_guesses_neither_suite_nor_planner(
    root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    row = RunRow(record=made_up_record(planner="mine"), directory="d")
    monkeypatch.setattr(Results, "open", lambda _: Results(runs=(row, row)))
    assert cli.main(["bundle", str(root)]) == 2
    offer = "--suite FILE --planner mine   (2 runs, FILE: that of suite)"
    assert offer in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_tables_of_pairs_keep_suites_apart(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, output_of: Tell
) -> None:
    """Power, ladder and atlas of a suite are the same whether another is there or not."""
    few = {"axes": {"density": ("d1", "d2")}, "metrics": ["safe_efficiency"], "failures": 0}
    made = campaign(suite="a", **few, planners={"dwa": 0.8, "mine": 0.5})  # type: ignore[arg-type]
    other = campaign(suite="b", **few, planners={"her": 0.4, "his": 0.9})  # type: ignore[arg-type]
    both = replace(made, runs=made.runs + other.runs, scores=(*made.scores, *other.scores))
    for command in ("power", "atlas"):
        values = {}
        for name, found in (("a", made), ("b", other), ("both", both)):
            monkeypatch.setattr(Results, "open", lambda _, found=found: found)
            values[name] = json.loads(
                output_of("results", command, "--runs", str(tmp_path), "--json")[0]
            )
        alone = [{"suite": n, **line} for n in ("a", "b") for line in values[n]]
        assert values["both"] == alone
    monkeypatch.setattr(Results, "open", lambda _: both)
    page, _ = output_of("results", "atlas", "--runs", str(tmp_path))
    assert page.index("## a") < page.index("## b")
    rows = json.loads(output_of("results", "--runs", str(tmp_path), "--json")[0])
    assert {row["suite"] for row in rows} == {"a", "b"}


def test_a_failure_of_an_altered_scenario_counts_there() -> None:
    job = Job(
        key="k", kind="run", source=SuiteSource(spec="s"), suite="s", scenario="x+1f3a", index=0,
        spec_hash="", planner_digest="", planner="dwa", settings=(), label="dwa", seed=0, out="o",
        directory="d", options=RunOptions(), altered=(SHORT,),
    )  # fmt: skip
    assert _failure(job, JobOutcome(key="k", error="boom"), {}).suite.startswith(
        "s+time_limit=0.25_s-"
    )
    assert _failure(replace(job, altered=()), JobOutcome(key="k"), {}).suite == "s"
