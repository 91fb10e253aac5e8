"""Recordings that were cut off, damaged, or made to do harm."""

from __future__ import annotations

import io
import os
import resource
import signal
import struct
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
import zstandard
from mcap.data_stream import RecordBuilder
from mcap.records import Chunk, Header
from mcap.writer import MCAP0_MAGIC, Writer

from crowdbot.core.recording.container import records as records_module
from crowdbot.core.recording.container.records import MAX_CHUNK
from crowdbot.core.recording.recording import Recording
from crowdbot.core.recording.writer import RecordingWriter
from crowdbot.errors import InputError
from tests.core.recording.recording_cases import (
    bits,
    chunk_ends,
    header_of,
    random_run,
    write_run,
    write_samples,
)
from tests.paths import ROOT

pytestmark = pytest.mark.slow

#: Whatever is asked of a recording.
QUESTIONS: tuple[Callable[[Path], object], ...] = (
    lambda path: Recording(path).trajectories(),
    lambda path: Recording(path).scans(),
    lambda path: Recording(path).info,
)
RUN = random_run(n=160, m=40)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    path = tmp_path_factory.mktemp("whole") / "run.mcap"
    writer = RecordingWriter(path, header_of(RUN))
    write_samples(writer, RUN, flush_at=50)
    writer.close(9.0, True, "arrived")
    return path.read_bytes()


def test_a_file_cut_anywhere_reads_up_to_its_last_whole_chunk(whole: bytes, tmp_path: Path) -> None:
    path, ends = tmp_path / "run.mcap", chunk_ends(whole)
    assert len(ends) >= 2
    cuts = {*range(ends[0], len(whole), 997), *(e + d for e in ends for d in (-1, 0, 1, 5, 9, 20))}
    cuts |= {len(whole) - d for d in (1, 8, 9, 20, 36, 37)}
    lengths = {}
    for cut in sorted(c for c in cuts if ends[0] <= c < len(whole)):
        path.write_bytes(whole[:cut])
        run = Recording(path).trajectories()
        n = lengths[cut] = len(run.t)
        assert run.robot is not None
        assert np.array_equal(run.t, RUN.t[:n])
        assert RUN.robot is not None
        assert run.robot.x.tobytes() == RUN.robot[:n, 0].tobytes()
        assert not Recording(path).info.complete
    assert list(lengths.values()) == sorted(lengths.values())
    assert lengths[ends[0]] == 51  # samples are written before all else of their second
    assert {51, 160} <= set(lengths.values())


def test_a_cut_before_the_first_chunk_ends_leaves_no_recording(
    whole: bytes, tmp_path: Path
) -> None:
    path = tmp_path / "run.mcap"
    for cut in (0, 1, 7, 8, 20, 40, 200, chunk_ends(whole)[0] - 1):
        path.write_bytes(whole[:cut])
        for read in QUESTIONS:
            with pytest.raises(InputError, match=r"run\.mcap: (not an MCAP file|no recording)"):
                read(path)


def test_a_tail_of_zeros_is_a_cut(whole: bytes, tmp_path: Path) -> None:
    path, ends = tmp_path / "run.mcap", chunk_ends(whole)
    path.write_bytes(whole[: ends[1] - 300] + bytes(300))
    assert 51 <= len(Recording(path).trajectories().t) < 160
    assert not Recording(path).info.complete


@pytest.mark.parametrize("more", [b"x", b"\n", MCAP0_MAGIC])
def test_bytes_behind_the_end_are_an_error(whole: bytes, tmp_path: Path, more: bytes) -> None:
    """Two recordings in one file: each reader would see another one."""
    path = tmp_path / "run.mcap"
    for rest in (more, whole):
        path.write_bytes(whole + rest)
        for read in QUESTIONS:
            with pytest.raises(InputError, match=f"{len(rest)} bytes follow its end"):
                read(path)


def test_damage_in_the_middle_is_an_error(whole: bytes, tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    at = chunk_ends(whole)[0] - 1000
    path.write_bytes(whole[:at] + bytes([whole[at] ^ 0x55]) + whole[at + 1 :])
    for read in QUESTIONS:
        with pytest.raises(InputError, match="damaged"):
            read(path)


def test_any_flipped_byte_is_no_traceback(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    small = random_run(n=6, m=2)
    write_run(path, small)
    data, good = path.read_bytes(), bits(Recording(path).trajectories())
    start, survived = chunk_ends(data)[-1], 0
    for at in range(0, start, 7):
        path.write_bytes(data[:at] + bytes([data[at] ^ 0xFF]) + data[at + 1 :])
        with suppress(InputError):  # anything else fails the test
            found = Recording(path).robot()  # a broken last chunk counts as cut off, and is told
            assert not found.complete or bits(found.run) == good
            survived += found.complete
    assert survived < start // 40  # only bytes that carry nothing: texts of schemas, maps


def test_a_killed_process_leaves_all_it_flushed(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    script = (
        "import os, sys; from pathlib import Path\n"
        "from tests.core.recording.recording_cases import *\n"
        "run = random_run(n=160, m=40)\n"
        "writer = RecordingWriter(Path(sys.argv[1]), header_of(run))\n"
        "write_samples(writer, run, flush_at=99)\n"
        f"os.kill(os.getpid(), {int(signal.SIGKILL)})\n"
    )
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run([sys.executable, "-c", script, str(path)], env=environment, check=False)
    assert done.returncode == -signal.SIGKILL
    run, info = Recording(path).trajectories(), Recording(path).info
    assert 100 <= len(run.t) < 160
    assert (info.complete, info.status, info.goal_time) == (False, "", None)
    assert len(Recording(path).scans()[0].t) >= 99


def test_an_interrupted_run_is_not_complete(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    writer = RecordingWriter(path, header_of(RUN))
    write_samples(writer, RUN)
    writer.close(None, False, "interrupted")
    info = Recording(path).info
    assert (info.complete, info.status) == (False, "interrupted")


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 something else entirely", b"\x89MCAP0"])
def test_other_files_are_refused(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "x.mcap"
    path.write_bytes(content)
    with pytest.raises(InputError, match="not an MCAP file"):
        Recording(path).trajectories()


def test_missing_files_and_folders_are_refused(tmp_path: Path) -> None:
    for name, reason in (("nothing", "no such file"), ("", "folder.* run.mcap in it")):
        with pytest.raises(InputError, match=reason):
            Recording(tmp_path / name).trajectories()


def foreign() -> bytes:
    """Somebody else's ROS 2 recording."""
    stream = io.BytesIO()
    writer = Writer(stream)
    writer.start(profile="ros2")
    schema = writer.register_schema("std_msgs/msg/String", "ros2msg", b"string data")
    channel = writer.register_channel("/chatter", "cdr", schema)
    writer.add_message(channel, 0, b"\0\1\0\0\2\0\0\0a\0", 0)
    writer.finish()  # type: ignore[no-untyped-call]
    return stream.getvalue()


def test_a_foreign_recording_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "x.mcap"
    path.write_bytes(foreign())
    for read in QUESTIONS:
        with pytest.raises(InputError, match="no recording of crowdbot"):
            read(path)


def bomb(frame: bytes, announced: int) -> bytes:
    """A file with one chunk."""
    builder = RecordBuilder()
    builder.write(MCAP0_MAGIC)
    Header("ros2", "x").write(builder)
    Chunk("zstd", frame, 0, 0, 0, announced).write(builder)
    return builder.end()  # type: ignore[no-any-return, no-untyped-call]


def test_a_bomb_is_refused_without_unpacking_it(tmp_path: Path) -> None:
    path, size = tmp_path / "x.mcap", 600 * 2**20
    frame = zstandard.compress(bytes(size))
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    path.write_bytes(bomb(frame, size))
    with pytest.raises(InputError, match="refused"):
        Recording(path).trajectories()
    path.write_bytes(bomb(frame, 1000))  # it lies about its size
    with pytest.raises(InputError, match="no recording"):
        Recording(path).trajectories()
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    assert grown * 1024 < 2 * MAX_CHUNK


def test_a_message_that_does_not_decode_is_named(tmp_path: Path) -> None:
    path = tmp_path / "x.mcap"
    stream = io.BytesIO()
    writer = Writer(stream)
    writer.start(profile="ros2")
    schema = writer.register_schema("crowdbot_msgs/msg/RunHeader", "ros2msg", b"")
    channel = writer.register_channel("/crowdbot/header", "cdr", schema)
    writer.add_message(channel, 0, b"\0\1\0\0\4\0\0\0\xff", 0)
    writer.finish()  # type: ignore[no-untyped-call]
    path.write_bytes(stream.getvalue())
    with pytest.raises(InputError, match=r"/crowdbot/header: .* cannot be decoded"):
        Recording(path).info  # noqa: B018


def test_numbers_of_messages_are_bounded_like_bytes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Some hundred bytes of zeros packed well are more messages than anybody can look at."""
    monkeypatch.setattr(records_module, "MAX_RECORDS", 1000)
    path = tmp_path / "many.mcap"
    empty = struct.pack("<BQHIQQ", 0x05, 22, 1, 0, 0, 0)
    for count, refused in ((800, False), (40_000, True)):
        plain = empty * count
        packed = zstandard.ZstdCompressor().compress(plain)
        builder = RecordBuilder()
        Header(profile="", library="").write(builder)
        Chunk(
            compression="zstd", data=packed, message_start_time=0, message_end_time=0,
            uncompressed_crc=0, uncompressed_size=len(plain),
        ).write(builder)  # fmt: skip
        path.write_bytes(MCAP0_MAGIC + builder.end())  # type: ignore[no-untyped-call]
        why = "holds more messages than a recording may" if refused else "belongs to no topic"
        with pytest.raises(InputError, match=why):
            Recording(path).trajectories()
    assert path.stat().st_size < 2000
