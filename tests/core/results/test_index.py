"""The index beside the runs: it gives what the files give, is renewed, and is never trusted."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import pytest

from crowdbot.core.results import store
from crowdbot.core.results.index_file import INDEX
from crowdbot.core.results.indexed_rows import IndexedRun
from crowdbot.core.results.results import Results
from crowdbot.core.results.rows import RUN_COLUMNS, RunRow
from crowdbot.core.results.score_columns import ScoreColumns
from crowdbot.core.runs.run_record import RunRecord
from tests.core.bundle.made_up_runs import make_runs, write_suite

PROPERTIES = (*RUN_COLUMNS, "axes", "conditions", "provenance", "moment", "changes", "role",
              "agents", "crowd", "suite_metrics", "axis_words")  # fmt: skip


@pytest.fixture
def root(tmp_path: Path) -> Path:
    suite = write_suite(tmp_path)
    make_runs(tmp_path / "runs", suite, value=lambda n: 0.1 * n)
    for run in (tmp_path / "runs").rglob("run.json"):
        (run.parent / "run.mcap").write_bytes(b"made up")
    return tmp_path / "runs"


@pytest.fixture
def eager(monkeypatch: pytest.MonkeyPatch) -> None:
    """Readers renew the index for a single run."""
    monkeypatch.setattr(store, "RENEWED_FROM", 1)


def test_few_runs_are_read_without_writing(root: Path) -> None:
    assert len(Results.open(root).runs) == 6
    assert not (root / INDEX).exists()


@pytest.mark.usefixtures("eager")
def test_many_new_runs_renew_the_index_and_it_gives_the_same(root: Path) -> None:
    first = Results.open(root)
    assert (root / INDEX).is_file()
    assert not list(root.glob(f"{INDEX}-*"))
    before = (root / INDEX).read_bytes()
    again = Results.open(root)
    assert again == first
    assert (root / INDEX).read_bytes() == before
    for run in again.runs:
        assert isinstance(run, IndexedRun)
        plain = RunRow(record=RunRecord.read(root / run.directory), directory=run.directory)
        assert run.record == plain.record
        for name in PROPERTIES:
            assert getattr(run, name) == getattr(plain, name), name
    assert replace(again.runs[0], entry="x").planner == "x"


@pytest.mark.usefixtures("eager")
def test_a_changed_digit_is_noticed_although_time_and_size_are_the_same(root: Path) -> None:
    Results.open(root)
    file = next(root.glob("tiny/*/dwa/seed-0")) / "scores.csv"
    about, text = file.stat(), file.read_text()
    last = text.rpartition(",1,higher,ok")[0]
    changed = text.replace(f"{last[-2:]},1,higher,ok", "99,1,higher,ok")
    assert len(changed) == len(text)
    assert changed != text
    before = {s.value for s in Results.open(root).scores}
    file.write_text(changed)
    os.utime(file, ns=(about.st_atime_ns, about.st_mtime_ns))
    assert {s.value for s in Results.open(root).scores} != before


@pytest.mark.usefixtures("eager")
def test_runs_that_are_gone_or_new_are_noticed(root: Path) -> None:
    Results.open(root)
    run = next(root.glob("tiny/*/dwa/seed-0"))
    run.rename(run.with_name("seed-1"))
    assert {r.directory.rpartition("/")[2] for r in Results.open(root).runs} == {"seed-0", "seed-1"}
    (run.with_name("seed-1") / "run.json").unlink()
    found = Results.open(root)
    assert len(found.runs) == 5
    assert [d.reason for d in found.damaged] == ["run.json is missing"]


@pytest.mark.usefixtures("eager")
def test_a_folder_that_cannot_be_written_is_read(
    root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "access", lambda *_: False)
    assert len(Results.open(root).runs) == 6
    assert not (root / INDEX).exists()


@pytest.mark.usefixtures("eager")
def test_while_a_campaign_writes_readers_do_not(root: Path) -> None:
    with store.index(root):
        assert len(Results.open(root).runs) == 6


def test_columns_read_like_rows(root: Path) -> None:
    scores = Results.open(root).scores
    assert isinstance(scores, ScoreColumns)
    rows = list(scores)
    assert ScoreColumns.of(rows) == scores
    assert scores[-1] == rows[-1]
    assert list(scores[2:4]) == rows[2:4]
    some = {rows[0].run_id}
    assert list(scores.of_runs(some)) == [s for s in rows if s.run_id in some]
    assert scores.metrics == {"risk", "spl"}
