"""The scores of a run are those of what the simulator wrote, and readers notice changes."""

from __future__ import annotations

import hashlib
import json
import shutil
from pathlib import Path

import pytest

import crowdbot.api as api
from crowdbot.core.recording.container.attachments import attach
from crowdbot.core.recording.container.mcap_file import McapFile
from crowdbot.core.recording.container.own_file import OwnFile
from crowdbot.core.results.results import Results
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.recordings import find_source
from crowdbot.core.runs.run import Run
from crowdbot.core.runs.run_record import RunRecord
from crowdbot.errors import InputError


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A short run without people, and its results' root."""
    out = tmp_path_factory.mktemp("made")
    scenario = api.load(
        "challenge-2020", "counter-d0250-dispersed-c20-r05",
        set=["crowd=null", "robots.robot.task.time_limit=1"],
    )  # fmt: skip
    return api.simulate(scenario, planner="goal_seek", out=out).directory


@pytest.fixture
def run(made: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(made, tmp_path / "suite" / "scenario" / "planner" / "seed-0"))


def test_the_record_has_digests_of_all_files(made: Path) -> None:
    found = RunRecord.read(made).digests
    assert set(found) == {p.name for p in made.iterdir()} - {files.RECORD}
    assert all(
        hashlib.sha256((made / name).read_bytes()).hexdigest() == sha for name, sha in found.items()
    )


def _edit(file: Path) -> None:
    """Change one digit of a number, without changing the size."""
    text = file.read_bytes().decode()
    at = next(i for i, c in enumerate(text) if c in "12345678" and text[i - 1] == ".")
    file.write_bytes((text[:at] + str(int(text[at]) + 1) + text[at + 1 :]).encode())


def test_an_edited_score_is_noticed_by_every_reader(
    run: Path, caplog: pytest.LogCaptureFixture
) -> None:
    root = run.parents[2].parent
    assert len(Results.open(root).runs) == 1
    _edit(run / files.SCORES)
    assert Results.open(root).runs == ()
    assert f"{files.SCORES} was changed after the run" in caplog.text
    with pytest.raises(InputError, match="was changed after the run"):
        _ = Run.open(run).scores
    with pytest.raises(InputError, match="was changed after the run"):
        files.check_whole(run, json.loads((run / files.RECORD).read_text()))


def test_an_edited_recording_is_not_scored(run: Path) -> None:
    content = bytearray((run / files.RECORDING).read_bytes())
    content[len(content) // 2] ^= 1
    (run / files.RECORDING).write_bytes(content)
    with pytest.raises(InputError, match=r"run\.mcap was changed after the run"):
        find_source(run)


def _recording(path: Path) -> McapFile:
    file = McapFile(path)
    file.close()
    return file


def test_what_is_attached_does_not_change_what_was_written(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    written = _recording(path).written
    assert written is not None
    written.check(path)
    ending = attach(path, {"scores.csv": b"1,2"})
    assert written.with_ending(ending) == hashlib.sha256(path.read_bytes()).hexdigest()


@pytest.mark.parametrize("how", ["replaced", "changed", "linked", "deleted"])
def test_a_recording_that_another_process_touched(how: str, tmp_path: Path) -> None:
    path, other = tmp_path / "a.mcap", tmp_path / "b.mcap"
    written = _recording(path).written
    assert written is not None
    shutil.copy(path, other)
    if how == "replaced":
        other.replace(path)
    elif how == "changed":
        path.write_bytes(path.read_bytes()[:-1] + b"x")
    else:
        path.unlink()
        if how == "linked":
            path.symlink_to(other)
    with pytest.raises(InputError, match=r"a\.mcap: is not what the simulator wrote"):
        written.check(path)


def test_a_full_disk_names_the_file() -> None:
    full = OwnFile(Path("/dev/full"))
    with pytest.raises(InputError, match=r"/dev/full: cannot be written: No space left"):
        full.write(b"x")
    with pytest.raises(InputError, match=r"/dev/full: cannot be written: No space left"):
        full.write(b"y")


def test_an_unfinished_run_that_is_a_link(tmp_path: Path) -> None:
    (tmp_path / "precious").mkdir()
    (tmp_path / "precious" / "keep").touch()
    (tmp_path / "seed-0.partial").symlink_to(tmp_path / "precious")
    with pytest.raises(InputError, match=r"seed-0\.partial: is a link"):
        _begin(tmp_path)
    assert (tmp_path / "precious" / "keep").exists()


def test_links_in_an_unfinished_run(tmp_path: Path) -> None:
    (tmp_path / "precious").mkdir()
    (tmp_path / "precious" / "keep").touch()
    (tmp_path / "seed-0.partial").mkdir()
    (tmp_path / "seed-0.partial" / "run.mcap").symlink_to(tmp_path / "precious")
    with files.partial(tmp_path / "seed-0") as folder:
        assert [p.name for p in folder.iterdir()] == [".lock"]
    assert (tmp_path / "precious" / "keep").exists()
    (folder / ".lock").symlink_to(tmp_path / "precious" / "lock")
    with pytest.raises(InputError, match=r"\.lock: cannot be written"):
        _begin(tmp_path)
    assert not (tmp_path / "precious" / "lock").exists()


def test_an_error_without_a_file_names_the_folder(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"seed-0\.partial: cannot be written: No space"):
        _begin(tmp_path, OSError(28, "No space left on device"))


def _begin(folder: Path, error: Exception | None = None) -> None:
    with files.partial(folder / "seed-0"):
        if error is not None:
            raise error
