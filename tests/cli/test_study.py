"""A whole study without a person, from the command line to the report; and with a browser."""

from __future__ import annotations

import csv
import json
import re
import shutil
from pathlib import Path

import pytest

from crowdbot import cli
from tests.core.studies.study_cases import STUDY, written
from tests.paths import ROOT


def test_a_study_runs_without_a_person(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """One participant, killed half-way and resumed: two drives, one table, a report."""
    text = STUDY.replace("participants: 4", "participants: 1").replace(
        "id: help", "id: help\n  forms: [nasa_tlx]"
    )
    monkeypatch.chdir(written(tmp_path, text).parent)
    assert cli.main(["study", "run", "study.yaml", "--synthetic"]) == 0
    first = Path("study-data/p01/steps/002-trial-alone-1.json")
    last = Path("study-data/p01/steps/007-end.json")
    assert last.is_file()
    run = Path("study-data") / json.loads(first.read_text())["run"] / "run.json"
    before = run.stat().st_mtime_ns
    for step in sorted(first.parent.iterdir())[1:]:  # as if it had been killed in the drive
        step.unlink()
    assert cli.main(["study", "run", "study.yaml", "--synthetic", "--participant", "p01"]) == 0
    assert last.is_file()
    assert run.stat().st_mtime_ns == before  # the run was there

    # The answers of a person, written by the page otherwise.
    form = Path("study-data/p01/steps/003-nasa_tlx-alone.json")
    document = json.loads(form.read_text())
    scales = ("mental_demand", "physical_demand", "temporal_demand", "performance", "effort",
              "frustration")  # fmt: skip
    form.write_text(json.dumps({**document, "answers": dict.fromkeys(scales, "30")}))
    capsys.readouterr()
    assert cli.main(["study", "results", "study.yaml", "--out", "r.csv"]) == 0
    assert "alone: 1 drive of 1 participant" in capsys.readouterr().out
    rows = list(csv.DictReader(Path("r.csv").read_text().splitlines()))
    assert [(r["participant"], r["condition"], r["driver"]) for r in rows] == [
        ("p01", "alone", "synthetic"), ("p01", "blended", "synthetic"),
    ]  # fmt: skip
    assert float(rows[0]["agreement.corrected"]) == 1.0
    assert [r["nasa_tlx.raw"] for r in rows] == ["30.0", ""]
    assert cli.main(["study", "report", "study.yaml", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert {(f["score"], f["condition"]) for f in found} >= {("agreement.corrected", "alone")}
    page = Path("study.html").read_text()
    assert "Synthetic users drove here." in page
    assert "http" not in re.sub(r"http-equiv|http://www.w3.org/\S*", "", page)


def test_a_plan_says_how_balanced_it_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(written(tmp_path, STUDY.replace("participants: 4", "participants: 3")).parent)
    assert cli.main(["study", "plan", "study.yaml", "--orders", "orders"]) == 0
    out = capsys.readouterr().out
    assert "p02: blended alone; 0 of 9 steps" in out
    assert "not balanced: places differ by 1" in out
    assert "wrote 3 order files" in out
    assert not Path("study-data").exists()


@pytest.mark.parametrize(
    ("words", "code", "expected"),
    [
        (["run", "study.yaml"], 2, "who takes part?"),
        (["run", "study.yaml", "--participant", "p9"], 1, "p9"),
        (["run", "none.yaml", "--synthetic"], 1, "none.yaml"),
        (["report", "study.yaml"], 1, "there are no runs in it yet"),
        (["report", "study.yaml", "--out", "x.txt"], 2, ".html"),
    ],
)
def test_what_cannot_be_done_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
    words: list[str], code: int, expected: str,
) -> None:  # fmt: skip
    monkeypatch.chdir(written(tmp_path).parent)
    assert cli.main(["study", *words]) == code
    assert expected in capsys.readouterr().err
    assert not Path("x.txt").exists()


def test_the_study_of_the_guide_is_right(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its planners and scenarios exist; that a study runs is tested above."""
    for name in ("study.yaml", "wheelchair.yaml"):
        shutil.copy(ROOT / "docs" / "howto" / "files" / name, tmp_path)
    monkeypatch.chdir(tmp_path)
    assert cli.main(["study", "plan", "study.yaml"]) == 0
    assert "p06: blended alone; 0 of 10 steps\nbalanced" in capsys.readouterr().out
