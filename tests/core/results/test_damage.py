"""Damage stays local: a damaged run is left out and told, and reading writes nothing."""

from __future__ import annotations

import json
import logging
import os
from collections.abc import Callable
from pathlib import Path

import pytest

from crowdbot import cli
from crowdbot.core.results.index_file import INDEX
from crowdbot.core.results.results import Results
from crowdbot.core.results.store import index
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.recordings import expand_paths
from tests.core.bundle.made_up_runs import make_runs, record_runs, write_suite

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("made")
    make_runs(folder / "runs", write_suite(folder))
    record_runs(folder / "runs")
    for file in (folder / "runs").rglob("run.json"):
        record = json.loads(file.read_text())
        files.write_json(file, {**record, "files": files.sizes(file.parent)})
    return folder / "runs"


@pytest.fixture
def root(made: Path, tmp_path: Path) -> Path:
    import shutil

    return Path(shutil.copytree(made, tmp_path / "runs"))


def state(root: Path) -> dict[str, tuple[int, int]]:
    return {str(p): (p.stat().st_size, p.stat().st_mtime_ns) for p in root.rglob("*")}


def cut(file: Path) -> None:
    file.write_bytes(file.read_bytes()[:-30])


def replaced(file: Path, old: bytes, new: bytes) -> None:
    """Other content, of whatever size: nobody says that the run has another one."""
    file.write_bytes(file.read_bytes().replace(old, new, 1))
    if file.name != "run.json":
        record = json.loads(file.with_name("run.json").read_text())
        sizes = {**record["files"], file.name: file.stat().st_size}
        files.write_json(file.with_name("run.json"), {**record, "files": sizes})


def pipe(file: Path) -> None:
    file.unlink()
    os.mkfifo(file)


def linked(file: Path, target: str) -> None:
    file.unlink()
    file.symlink_to(target)


DAMAGE: tuple[tuple[Callable[[Path], object], str], ...] = (
    (lambda run: (run / "run.json").unlink(), "run.json is missing"),
    (lambda run: cut(run / "run.json"), "cut, or not a record of a run"),
    (lambda run: (run / "run.json").write_text("[]"), "cut, or not a record of a run"),
    (lambda run: (run / "run.json").write_text("{}"), "'scenario': field required"),
    (lambda run: (run / "run.mcap").unlink(), "run.mcap is missing"),
    (lambda run: cut(run / "run.mcap"), "run.mcap has "),
    (lambda run: (run / "scores.csv").unlink(), "scores.csv is missing"),
    (lambda run: cut(run / "scores.csv"), "scores.csv has "),
    (lambda run: (run / "scenario.yaml").unlink(), "scenario.yaml is missing"),
    (lambda run: replaced(run / "run.json", b'"seed"', b'"seed": 1, "seed"'), "the key 'seed' is"),
    (lambda run: pipe(run / "run.json"), "cannot be read: is a device or pipe"),
    (lambda run: pipe(run / "scores.csv"), "scores.csv has 0 bytes"),
    (lambda run: linked(run / "run.json", "/dev/zero"), "cannot be read: is a device or pipe"),
    (lambda run: linked(run / "run.json", "run.json"), "run.json is missing"),
    (lambda run: replaced(run / "scores.csv", b",dwa,", b",awd,"), "a score of another run: in-"),
    (
        lambda run: replaced(run / "scores.csv", b",spl,", b",risk,"),
        "risk.corrected is there twice",
    ),
)


@pytest.mark.parametrize("indexed", [False, True])
def test_a_damaged_run_is_one_warning(
    root: Path, caplog: pytest.LogCaptureFixture, indexed: bool
) -> None:
    if indexed:
        with index(root) as store:
            store.synchronise()
    runs = sorted(root.glob("tiny/*/dwa/seed-0"))
    assert len(Results.open(root).runs) == len(runs) == 6
    for number, (damage, why) in enumerate(DAMAGE):
        run = runs[number % 6]
        before = {f.name: f.read_bytes() for f in run.iterdir()}
        damage(run)
        caplog.clear()
        with caplog.at_level(logging.WARNING, "crowdbot"):
            found = Results.open(root)
        assert [d.directory for d in found.damaged] == [run.relative_to(root).as_posix()]
        assert why in found.damaged[0].reason
        assert len(found.runs) == 5
        assert len(found.scores) == 10
        assert [r.message for r in caplog.records] == [f"warning: {run} is left out: "
                                                       f"{found.damaged[0].reason}"]  # fmt: skip
        for name, content in before.items():
            (run / name).unlink(missing_ok=True)
            (run / name).write_bytes(content)
    assert Results.open(root).damaged == ()


@pytest.mark.parametrize("indexed", [False, True])
def test_reading_writes_nothing(
    root: Path, tmp_path: Path, indexed: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    if indexed:
        with index(root) as store:
            store.synchronise()
        assert (root / INDEX).exists()
    (next(root.glob("tiny/*/dwa/seed-0")) / "run.json").unlink()
    before = state(root)
    assert len(Results.open(root).runs) == 5
    out = tmp_path / "page.html"
    assert cli.main(["report", str(root), "--out", str(out)]) == 0
    assert "damaged: 1 run left out: tiny/" in out.read_text(encoding="utf-8")
    assert cli.main(["results", "--out", str(root)]) == 0
    captured = capsys.readouterr()
    assert "5 runs, 0 failures, 1 damaged" in captured.out
    assert captured.err.count("is left out: run.json is missing") == 2
    assert cli.main(["results", "export", "--out", str(root), "--csv", str(out)]) == 0
    assert state(root) == before


def test_a_campaign_that_writes_is_read_beside(root: Path) -> None:
    with index(root) as store:
        store.synchronise()
        (next(root.glob("tiny/*/dwa/seed-0")) / "run.json").unlink()
        assert len(Results.open(root).runs) == 5


def test_a_run_that_was_exported_beside_it_is_not_damaged(
    root: Path, caplog: pytest.LogCaptureFixture
) -> None:
    runs = sorted(file.parent for file in root.rglob(files.RECORDING))
    before = Results.open(root)
    assert cli.main(["export", str(runs[0]), "--to", "rosbag2"]) == 0
    bag = runs[0].with_name(f"{runs[0].name}-rosbag2")
    assert (bag / files.RECORD).is_file()
    assert not (bag / files.RECORDING).exists()
    caplog.clear()
    after = Results.open(root)
    assert (after.runs, after.damaged) == (before.runs, ())
    assert "left out" not in caplog.text
    assert expand_paths([root]) == runs
