"""`info` and `recover`: recordings that were cut off, anywhere."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.reader import make_reader

from crowdbot import cli
from crowdbot.core.recording.container.records import Records
from crowdbot.core.recording.reading.contents import contents
from crowdbot.core.recording.reading.recover import recover
from crowdbot.core.recording.recording import Recording
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.errors import InputError
from tests.core.recording.recording_cases import (
    bits,
    header_of,
    random_run,
    write_run,
    write_samples,
)

RUN = random_run()


def _cut(tmp_path: Path, keep: float | None = None) -> Path:
    """A recording that was killed after sample 20; ``keep`` is the part of its bytes that is left.

    The chunk that was open is lost.
    """
    path = tmp_path / "cut.mcap"
    writer = RecordingWriter(path, header_of(RUN))
    write_samples(writer, RUN, flush_at=20)
    data = path.read_bytes()
    writer.close(None, False, "interrupted")
    path.write_bytes(data if keep is None else data[: int(keep * len(data))])
    return path


def _json(argv: list[str], capsys: pytest.CaptureFixture[str]) -> dict[str, Any]:
    assert cli.main(argv) == 0
    return dict(json.loads(capsys.readouterr().out))


def test_all_whole_chunks_are_kept_bit_by_bit(tmp_path: Path) -> None:
    cut, whole = _cut(tmp_path), tmp_path / "whole.mcap"
    found = recover(cut, whole)
    before, after = list(Records(cut)), list(Records(whole))
    assert after[:-1] == before
    assert after[-1].topic == "/crowdbot/end"
    assert found.messages == len(before)
    assert bits(Recording(whole).trajectories()) == bits(Recording(cut).trajectories())
    assert len(Recording(whole).trajectories().t) == 21


def test_the_recovered_file_has_its_end_and_says_what_it_is(tmp_path: Path) -> None:
    whole = tmp_path / "whole.mcap"
    recover(_cut(tmp_path), whole)
    info = contents(whole)
    assert (info.finished, info.complete, info.status) == (True, False, "recovered")
    assert Recording(whole).info.status == "recovered"
    with whole.open("rb") as file:  # others read it by its index, with all checksums
        messages = sum(1 for _ in make_reader(file, validate_crcs=True).iter_messages())
    assert messages == sum(t.count for t in info.topics)


@pytest.mark.parametrize("keep", np.linspace(0.3, 1.0, 8))
def test_wherever_it_was_cut(tmp_path: Path, keep: float) -> None:
    cut, whole = _cut(tmp_path, keep), tmp_path / "whole.mcap"
    before = list(Records(cut))
    if before:
        recover(cut, whole)
        assert list(Records(whole))[: len(before)] == before
    else:
        with pytest.raises(InputError, match="not a single whole chunk"):
            recover(cut, whole)
        assert not whole.exists()


def test_a_run_that_had_ended_keeps_its_end(tmp_path: Path) -> None:
    path, whole = tmp_path / "run.mcap", tmp_path / "whole.mcap"
    write_run(path, RUN)
    data = path.read_bytes()
    path.write_bytes(data[:-20])  # only the footer is missing
    recover(path, whole)
    assert Recording(whole).info.status == "arrived"
    assert contents(whole).complete


def test_what_is_complete_is_left_alone(tmp_path: Path) -> None:
    path, whole = tmp_path / "run.mcap", tmp_path / "whole.mcap"
    write_run(path, RUN)
    with pytest.raises(InputError, match="is complete"):
        recover(path, whole)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["run.mcap"]


def test_damage_in_the_middle_is_told(tmp_path: Path) -> None:
    path = tmp_path / "two.mcap"
    writer = RecordingWriter(path, header_of(RUN))
    write_samples(writer, RUN, flush_at=20)
    writer.flush()
    data = bytearray(path.read_bytes())
    writer.close(None, False, "interrupted")
    data[300] ^= 0xFF  # in the first of two chunks
    path.write_bytes(data)
    with pytest.raises(InputError, match="damaged"):
        recover(path, tmp_path / "whole.mcap")
    assert not (tmp_path / "whole.mcap").exists()


def test_the_commands_say_what_they_found(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cut = _cut(tmp_path)
    before = _json(["info", str(cut), "--json"], capsys)
    assert (before["finished"], before["complete"]) == (False, False)
    done = _json(["recover", str(cut), "--json"], capsys)
    assert done["file"] == str(tmp_path / "cut.recovered.mcap")
    after = _json(["info", done["file"], "--json"], capsys)
    assert after["status"] == "recovered"
    assert after["trajectory"] == before["trajectory"]
    scan = next(t for t in after["topics"] if t["topic"] == "/front/scan")
    assert scan["messages"] == 21
    assert scan["rate"] == pytest.approx(16.0)
    assert cli.main(["recover", str(cut)]) == 1
    assert "exists already" in capsys.readouterr().err


def test_a_recovered_recording_can_be_evaluated(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cut, whole = _cut(tmp_path), tmp_path / "whole.mcap"
    assert cli.main(["recover", str(cut), "--out", str(whole)]) == 0
    capsys.readouterr()
    assert cli.main(["evaluate", str(whole), "--metrics", "task_time", "--json"]) in (0, 1)
    assert "damaged" not in capsys.readouterr().err


def test_info_reads_what_others_recorded(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from mcap.writer import Writer

    path = tmp_path / "other.mcap"
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        schema = writer.register_schema("a", "jsonschema", b"{}")
        channel = writer.register_channel("/x", "json", schema)
        for k in range(5):
            writer.add_message(channel, k * 10**9, b"{}", k * 10**9)
        writer.finish()  # type: ignore[no-untyped-call]
    found = _json(["info", str(path), "--json"], capsys)
    assert found["topics"] == [
        {"topic": "/x", "type": "a", "messages": 5, "rate": 1.0, "bytes": 10}
    ]  # fmt: skip
    assert found["complete"]
    assert cli.main(["info", str(path)]) == 0
    assert "/x" in capsys.readouterr().out


def test_info_of_no_recording_is_an_error(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "x.mcap"
    path.write_bytes(b"nothing")
    for argv in (["info", str(path)], ["recover", str(path)], ["info", str(tmp_path / "none")]):
        assert cli.main(argv) == 1
        assert capsys.readouterr().err.startswith("error: ")
