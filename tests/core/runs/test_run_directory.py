"""Nothing appears under a final name before it is whole, also with several processes at work."""

from __future__ import annotations

import json
import multiprocessing as mp
import os
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.run_record import ReferenceRecord, RunRecord
from crowdbot.errors import InputError


def _fill(folder: Path, text: str = "data") -> None:
    (folder / "run.mcap").write_text(text)
    files.write_json(folder / files.RECORD, {"run_id": text})


def test_published_under_the_final_name_only(tmp_path: Path) -> None:
    final = tmp_path / "a" / "b" / "seed-0"
    with files.partial(final) as folder:
        assert folder.name == "seed-0.partial"
        assert folder.parent == final.parent
        _fill(folder)
        assert not final.exists()
        files.publish(folder, final)
    assert sorted(p.name for p in final.iterdir()) == ["run.json", "run.mcap"]
    assert [p.name for p in final.parent.iterdir()] == ["seed-0"]
    assert files.checked_record(final)["run_id"] == "data"
    assert files.damage(final, {}) == "scenario.yaml is missing"


def test_a_failure_keeps_the_partial(tmp_path: Path) -> None:
    final = tmp_path / "seed-0"

    def work() -> None:
        with files.partial(final) as folder:
            _fill(folder)
            raise RuntimeError("power cut")

    with pytest.raises(RuntimeError, match="power cut"):
        work()
    folder = tmp_path / "seed-0.partial"
    assert [p.name for p in tmp_path.iterdir()] == ["seed-0.partial"]
    assert sorted(p.name for p in folder.iterdir()) == ["run.json", "run.mcap"]


def test_leftovers_are_replaced(tmp_path: Path) -> None:
    final, old = tmp_path / "seed-0", tmp_path / "seed-0.partial"
    (old / "deep").mkdir(parents=True)
    (old / "deep" / "x").write_text("x")
    (old / "y").write_text("y")
    with files.partial(final) as folder:
        assert folder == old
        assert [p.name for p in folder.iterdir() if p.name != ".lock"] == []


def test_what_was_there_is_replaced_as_a_whole(tmp_path: Path) -> None:
    final = tmp_path / "seed-0"
    final.mkdir()
    (final / "scores.csv").write_text("old")
    with files.partial(final) as folder:
        _fill(folder)
        files.publish(folder, final)
    assert sorted(p.name for p in final.iterdir()) == ["run.json", "run.mcap"]
    assert [p.name for p in tmp_path.iterdir()] == ["seed-0"]


def test_a_run_that_goes_on_is_left_alone(tmp_path: Path) -> None:
    final = tmp_path / "seed-0"
    with files.partial(final) as first:
        _fill(first)
        with files.partial(final) as second:
            assert second != first
            assert (first / "run.mcap").read_text() == "data"
            _fill(second, "more")
            files.publish(second, final)
        files.publish(first, final)
    assert [p.name for p in tmp_path.iterdir()] == ["seed-0"]
    assert (final / "run.mcap").read_text() == "data"


def test_a_directory_that_is_being_published_is_left_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Somebody begins the same run while another waits for its disk just before the rename."""
    final = tmp_path / "seed-0"
    sync = files._sync
    begun: list[Path] = []

    def slow(path: Path) -> None:
        if not begun:
            begun.append(path)
            with files.partial(final) as other:
                assert other.name != "seed-0.partial"
        sync(path)

    monkeypatch.setattr(files, "_sync", slow)
    with files.partial(final) as folder:
        _fill(folder)
        files.publish(folder, final)
    assert begun
    assert sorted(p.name for p in final.iterdir() if p.name != ".lock") == ["run.json", "run.mcap"]
    assert (final / "run.mcap").read_text() == "data"


def _work(final: Path, text: str, rounds: int, failures: Any) -> None:
    try:
        for _ in range(rounds):
            with files.partial(final) as folder:
                _fill(folder, text)
                (folder / "scores.csv").write_text(text)
                files.publish(folder, final)
            with suppress(InputError):  # replaced at this very moment
                record = files.checked_record(final)
                if record["run_id"] not in ("a", "b", "c"):
                    failures.put(f"read {record}")
    except BaseException as error:
        failures.put(repr(error))
        raise


@pytest.mark.slow
def test_many_processes_at_once(tmp_path: Path) -> None:
    """Whatever they do at the same time, what is left is one whole run."""
    final = tmp_path / "seed-0"
    context = mp.get_context("spawn")
    failures = context.Queue()
    workers = [
        context.Process(target=_work, args=(final, text, 60, failures)) for text in ("a", "b", "c")
    ]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join(60)
    assert failures.empty(), failures.get()
    assert [w.exitcode for w in workers] == [0, 0, 0]
    names = sorted(p.name for p in final.iterdir() if p.name != ".lock")
    assert names == ["run.json", "run.mcap", "scores.csv"]
    texts = {(final / n).read_text() for n in ("run.mcap", "scores.csv")}
    assert texts == {files.checked_record(final)["run_id"]}
    assert [p.name for p in tmp_path.iterdir()] == ["seed-0"]


def test_unwritable_places(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("mine")
    for final in (tmp_path / "file" / "run", tmp_path / ("x" * 300), Path("/dev/null/run")):
        with pytest.raises(InputError, match="cannot be written"), files.partial(final):
            raise AssertionError
    assert (tmp_path / "file").read_text() == "mine"


@pytest.mark.parametrize("text", ["", "{", "[1]", "null", '{"run_id": '])
def test_a_damaged_record_is_no_record(text: str, tmp_path: Path) -> None:
    (tmp_path / files.RECORD).write_text(text)
    for kind in (RunRecord, ReferenceRecord):
        assert kind.find(tmp_path) is None
        assert kind.find(tmp_path / "nowhere") is None
    with pytest.raises(InputError, match=r"run\.json"):
        files.checked_record(tmp_path)


def test_a_record_is_written_in_one_go(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "run.json"
    files.write_json(path, {"é": 1})
    assert json.loads(path.read_text(encoding="utf-8")) == {"é": 1}

    def broken(*_: Path) -> Path:
        raise OSError(28, os.strerror(28))

    monkeypatch.setattr(Path, "replace", broken)
    with pytest.raises(InputError, match=r"run\.json: cannot be written: No space"):
        files.write_json(path, {"é": 2})
    assert [p.name for p in tmp_path.iterdir()] == ["run.json"]
    assert json.loads(path.read_text(encoding="utf-8")) == {"é": 1}


def test_unfinished_and_replaced_runs_are_not_among_those_of_a_folder(tmp_path: Path) -> None:
    for name in ("seed-0", "seed-1.partial", "seed-2.old-7"):
        (tmp_path / "a" / name).mkdir(parents=True)
        _fill(tmp_path / "a" / name)
    assert files.runs_under(tmp_path) == [tmp_path / "a" / "seed-0"]
    assert files.recordings_under(tmp_path) == [tmp_path / "a" / "seed-0" / "run.mcap"]
    partial = tmp_path / "a" / "seed-1.partial"
    assert files.runs_under(partial) == [partial]  # named by itself
