"""``crowdbot report``: what it takes, what it writes, what it refuses."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crowdbot.cli import main
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RunRow
from crowdbot.core.scoring.scores_csv import write_scores_csv
from crowdbot.core.types.score import Score
from tests.core.report.report_cases import campaign
from tests.core.report.test_page import SMALL_AXES, Page, small
from tests.core.results.made_up_record import changed


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> dict[str, Results]:
    """What a store would find below a folder of the working directory: name -> results."""
    found = {"runs": small()}

    def opened(root: Path) -> Results:
        return found[root.name]

    monkeypatch.setattr(Results, "open", opened)
    monkeypatch.chdir(tmp_path)
    return found


def with_changes(results: Results, planner: str, **values: dict[str, str]) -> Results:
    """The same with other texts in the records of one planner."""

    def other(row: RunRow) -> RunRow:
        document = row.record.document()
        return changed(row, **{name: document[name] | new for name, new in values.items()})

    runs = tuple(other(r) if r.planner == planner else r for r in results.runs)
    return replace(results, runs=runs)


def test_three_files_are_written(
    runs: dict[str, Results], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    del runs
    assert main(["report"]) == 0
    captured = capsys.readouterr()
    assert captured.out == "report.html\n"
    assert "dwa, orca_lookahead, straight_on: " in captured.err
    assert sorted(p.name for p in tmp_path.iterdir()) == ["report.csv", "report.html", "report.md"]


def test_json_says_what_was_written(
    runs: dict[str, Results], capsys: pytest.CaptureFixture[str]
) -> None:
    (Path.cwd() / "a").mkdir()
    assert main(["report", "runs", "--out", "a/b.html", "--json", "-q"]) == 0
    document: dict[str, Any] = json.loads(capsys.readouterr().out)
    assert document["html"] == "a/b.html"
    assert Path(document["csv"]).is_file()
    assert Path(document["md"]).is_file()
    assert document["suite"] == "challenge-2020"
    assert sum(document["runs"].values()) == len(runs["runs"].runs) + len(runs["runs"].failures)


def test_planners_and_suites_are_chosen(
    runs: dict[str, Results], capsys: pytest.CaptureFixture[str]
) -> None:
    other = small(suite="office", planners={"dwa": 0.0}, failures=0)
    both = replace(
        runs["runs"],
        runs=(*runs["runs"].runs, *(changed(r, run_id=f"o{r.run_id}") for r in other.runs)),
    )
    runs["runs"] = both
    assert main(["report"]) == 1
    assert "several suites, choose with --suite: challenge-2020, office" in capsys.readouterr().err
    assert main(["report", "--suite", "ofice"]) == 1
    assert "office" in capsys.readouterr().err
    assert main(["report", "--suite", "challenge-2020", "--planner", "dva"]) == 1
    assert "did you mean 'dwa'" in capsys.readouterr().err
    arguments = ["--planner", "dwa", "--planner", "straight*"]
    assert main(["report", "--suite", "challenge-2020", *arguments]) == 0
    with Path("report.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {r["planner"] for r in rows} == {"dwa", "straight_on"}
    assert {r["suite"] for r in rows} == {"challenge-2020"}
    assert [r["run_status"] for r in rows].count("failed") == 2


def test_runs_that_differ_in_more_than_the_planner_are_refused(
    runs: dict[str, Results], capsys: pytest.CaptureFixture[str]
) -> None:
    runs["runs"] = with_changes(runs["runs"], "dwa", conditions={"rates.log": "20 Hz"})
    assert main(["report"]) == 1
    output = capsys.readouterr().err
    assert "rates.log" in output
    assert "20 Hz" in output
    assert not Path("report.html").exists()
    assert main(["report", "--accept", "rate"]) == 1
    assert "did you mean 'rates'" in capsys.readouterr().err
    assert main(["report", "--accept", "rates"]) == 0
    page = Page(Path("report.html").read_text(encoding="utf-8"))
    notices = [a for tag, a in page.tags if tag == "p" and a.get("class") == "notice accepted"]
    assert len(notices) >= 1
    assert "20 Hz" in page.words
    assert "**Accepted: " in Path("report.md").read_text(encoding="utf-8")
    assert main(["report", "--planner", "dwa"]) == 0  # alone it differs from nothing


def test_reference_scores_are_planners_of_their_own(
    runs: dict[str, Results], capsys: pytest.CaptureFixture[str]
) -> None:
    runs["theirs"] = small(planners={"dwa": 0.3, "lidar_only": 0.2}, failures=0)
    assert main(["report", "--planner", "dwa", "--reference", "theirs"]) == 0
    page = Page(Path("report.html").read_text(encoding="utf-8"))
    labels = [p["label"] for p in page.meta["planners"]]
    assert labels == ["dwa", "dwa (reference)"]
    assert page.words.count("reference scores") == 2  # head and methods
    runs["theirs"] = small(planners={"rvo": 0.3, "lidar_only": 0.2}, failures=0)
    assert main(["report", "--planner", "d*", "--reference", "theirs"]) == 0
    page = Page(Path("report.html").read_text(encoding="utf-8"))
    labels = [p["label"] for p in page.meta["planners"]]
    assert labels == ["dwa", "lidar_only (reference)", "rvo (reference)"]
    runs["theirs"] = small(planners={"dwa": 0.3, "lidar_only": 0.2}, failures=0)
    runs["theirs"] = with_changes(runs["theirs"], "dwa", versions={"crowdbot": "0.0.1"})
    assert main(["report", "--reference", "theirs"]) == 1
    runs["theirs"] = small(suite="office")
    capsys.readouterr()
    assert main(["report", "--reference", "theirs"]) == 1
    assert "--reference" in capsys.readouterr().err


def test_links_lead_to_the_replays_that_there_are(runs: dict[str, Results]) -> None:
    first = runs["runs"].runs[0]
    replay = Path("runs") / first.directory / "replay.html"
    replay.parent.mkdir(parents=True)
    replay.write_text("x")
    Path("pages").mkdir()
    assert main(["report", "--out", "pages/r.html"]) == 0
    meta = Page(Path("pages/r.html").read_text(encoding="utf-8")).meta
    assert [x for x in meta["runs"]["replay"] if x] == [f"../{replay.as_posix()}"]
    assert main(["report", "--out", "pages/r.html", "--no-replay-links"]) == 0
    meta = Page(Path("pages/r.html").read_text(encoding="utf-8")).meta
    assert not any(meta["runs"]["replay"])


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["--out", "x.pdf"], 2, ".html"),
        (["--out", "/dev/null/x.html"], 1, "cannot be written: Not a directory"),
        (["empty"], 1, "no complete run"),
    ],
)
def test_what_is_wrong_is_said(
    arguments: list[str],
    code: int,
    words: str,
    runs: dict[str, Results],
    capsys: pytest.CaptureFixture[str],
) -> None:
    runs["empty"] = campaign(axes={"a": ()}, failures=0)
    assert main(["report", *arguments]) == code
    output = capsys.readouterr().err
    assert words in output
    assert "Traceback" not in output


def test_runs_on_a_disk_are_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    results = small(failures=0)
    for run in results.runs:
        folder = tmp_path / run.directory
        folder.mkdir(parents=True)
        metrics = {"risk": {"spec_version": 1, "horizon": 5.0}}
        changed(run, metrics=metrics).record.write(folder)
        for name in ("run.mcap", "scenario.yaml"):
            (folder / name).touch()
        names = ("metric", "symbol", "category", "variant", "unit", "better", "status", "value",
                 "reason", "lower", "upper")  # fmt: skip
        scores = [
            Score(**{n: getattr(s, n) for n in names})
            for s in results.scores
            if s.run_id == run.run_id
        ]
        write_scores_csv(folder / "scores.csv", scores, run.scenario, run.planner, run.seed)
    out = tmp_path / "report.html"
    assert main(["report", str(tmp_path), "--out", str(out)]) == 0, capsys.readouterr().err
    page = Page(out.read_text(encoding="utf-8"))
    assert page.meta["runs"]["count"] == len(results.runs)
    assert {a["name"]: set(a["labels"]) for a in page.meta["axes"]} == {
        name: set(labels) for name, labels in SMALL_AXES.items()
    }
    values = page.numbers("values")
    given = [s.value for s in results.scores if s.value is not None]
    np.testing.assert_allclose(np.sort(values[~np.isnan(values)]), sorted(given), rtol=5e-5)
    assert "horizon" in page.words
