"""Files inside a recording: others find them, and nothing else changes."""

from __future__ import annotations

import struct
from pathlib import Path

import pytest
from mcap.exceptions import EndOfFile
from mcap.reader import SeekingReader, make_reader

from crowdbot.core.recording.container.attachments import attach, attached
from crowdbot.core.recording.container.records import Records
from crowdbot.core.recording.reading.contents import contents
from crowdbot.core.recording.recording import Recording
from crowdbot.errors import InputError
from tests.core.recording.recording_cases import bits, random_run, write_run

RUN = random_run()
FILES = {"scores.csv": b"metric,value\n", "scenario.yaml": b"id: x\n", "run.json": b"{}"}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = tmp_path / "run.mcap"
    write_run(path, RUN)
    return path


def _attached(path: Path) -> dict[str, tuple[str, bytes]]:
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        return {a.name: (a.media_type, a.data) for a in reader.iter_attachments()}


def test_others_find_them_and_all_messages(path: Path) -> None:
    before = list(Records(path))
    attach(path, FILES)
    assert {n: d for n, (_, d) in _attached(path).items()} == FILES
    assert _attached(path)["scores.csv"][0] == "text/csv"
    with path.open("rb") as file:
        summary = make_reader(file, validate_crcs=True).get_summary()
    assert summary is not None
    assert summary.statistics is not None
    assert summary.statistics.attachment_count == 3
    assert summary.statistics.message_count == len(before)
    assert list(Records(path)) == before


def test_new_ones_replace_the_old(path: Path) -> None:
    plain = bits(Recording(path).trajectories())
    attach(path, FILES)
    size = path.stat().st_size
    attach(path, FILES)
    assert path.stat().st_size == size
    attach(path, {"one": b"1"})
    assert contents(path).attachments == {"one": 1}
    assert bits(Recording(path).trajectories()) == plain
    assert contents(path).complete


def test_a_file_that_was_cut_off_is_refused(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:-50])
    with pytest.raises(InputError, match="no index"):
        attach(path, FILES)


@pytest.mark.parametrize("cut", [5, 40, 200])
def test_cut_inside_it_is_as_good_as_one_cut_off(path: Path, cut: int) -> None:
    plain = bits(Recording(path).trajectories())
    attach(path, {"a": bytes(1000)})
    whole = path.read_bytes()
    path.write_bytes(whole[: whole.index(bytes(1000)) + cut])
    assert not contents(path).finished
    assert bits(Recording(path).trajectories()) == plain


def test_one_that_is_called_something_else_is_missed(path: Path) -> None:
    attach(path, {"a": bytes(1000)})
    whole = bytearray(path.read_bytes())
    head = whole.index(bytes(1000)) - len(struct.pack("<BQ", 9, 0))
    at = whole.rindex(b"\x09", 0, head)  # the attachment's opcode
    assert struct.unpack_from("<Q", whole, at + 1)[0] > 1000
    whole[at] = 8
    path.write_bytes(whole)
    with pytest.raises(InputError, match="attached files are missing"):
        list(Records(path))


def test_why_they_cannot_be_read_is_never_empty(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The reader has no words for a record that goes on after the end of the file."""
    attach(path, FILES)

    def ends(_: SeekingReader) -> None:
        raise EndOfFile

    monkeypatch.setattr(SeekingReader, "get_summary", ends)
    with pytest.raises(InputError, match="cannot be read: it ends within a record"):
        attached(path)
