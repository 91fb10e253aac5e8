"""A recording is opened once and read once, whatever is asked of it, and only as far as needed."""

from __future__ import annotations

from collections.abc import Generator
from pathlib import Path

import numpy as np
import pytest

import crowdbot
import crowdbot.core.recording.messages as ros
import crowdbot.core.recording.recording as module
from crowdbot.core.recording import old_names
from crowdbot.core.recording.container.mcap_file import McapFile
from crowdbot.core.recording.container.records import Record, Records
from crowdbot.core.recording.recording import Recording
from crowdbot.core.recording.topics import Topic
from crowdbot.errors import InputError
from tests.core.recording.recording_cases import (
    LIDAR,
    bits,
    chunk_ends,
    header_of,
    random_run,
    write_run,
)

RUN = random_run(n=160, m=9)
_HEADER = "crowdbot_msgs/msg/RunHeader"


class CountedRecords(Records):
    """Counts how often files are read, and how many messages."""

    passes = 0
    messages = 0

    def __iter__(self) -> Generator[Record, None, None]:
        CountedRecords.passes += 1
        for record in super().__iter__():
            CountedRecords.messages += 1
            yield record


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> type[CountedRecords]:
    """All that is read from here on."""
    monkeypatch.setattr(module, "Records", CountedRecords)
    CountedRecords.passes = CountedRecords.messages = 0
    return CountedRecords


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A run with people, a robot and a lidar."""
    write_run(tmp_path / "run.mcap", RUN)
    return tmp_path / "run.mcap"


def test_one_pass_answers_everything(path: Path, counted: type[CountedRecords]) -> None:
    with Recording(path, max_rate=4.0) as recording:
        assert recording.holds_run
        assert recording.robots == ()
        header, info = recording.header, recording.info
        run, (scan,) = recording.trajectories(), recording.scans()
        assert recording.trajectories() is run
    assert counted.passes == 1
    assert bits(info.header) == bits(header)
    apart = Recording(path, max_rate=4.0)
    assert bits(apart.trajectories()) == bits(run)
    assert np.array_equal(apart.scans("front")[0].ranges, scan.ranges)
    assert recording.robot().until == run.t[-1]


def test_questions_about_the_header_read_no_further(
    path: Path, counted: type[CountedRecords]
) -> None:
    with Recording(path) as recording:
        assert recording.header.sensors["front"].mount == LIDAR.mount
        assert recording.robots == ()
    begun = counted.messages
    assert sum(n for _, n in Recording(path).info.topics.values()) > 2 * begun


def test_what_is_not_part_of_the_run_can_be_observed(path: Path) -> None:
    seen: list[Record] = []
    recording = Recording(path, observe=seen.append)
    counts = {topic: n for topic, (_, n) in recording.info.topics.items()}
    topics = {record.topic for record in seen}
    assert "/odom" in topics
    assert not topics & {Topic.STATE, Topic.HEADER, "/front/scan"}
    assert len(seen) == sum(counts[topic] for topic in topics)


def test_a_closed_recording_answers_what_it_has_read(path: Path) -> None:
    with Recording(path) as recording:
        header = recording.header
    assert recording.header is header
    with pytest.raises(InputError, match="closed before it was read"):
        recording.trajectories()
    with Recording(path) as whole:
        run = whole.trajectories()
    assert whole.trajectories() is run


def test_damage_is_damage_whenever_it_is_asked(path: Path) -> None:
    whole = path.read_bytes()
    at = chunk_ends(whole)[0] - 1000
    path.write_bytes(whole[:at] + bytes([whole[at] ^ 0x55]) + whole[at + 1 :])
    recording = Recording(path)
    for _ in range(2):
        with pytest.raises(InputError, match="damaged"):
            recording.trajectories()


@pytest.mark.parametrize(("version", "why"), [
    (1, "the oldest that this crowdbot reads is 3: make the run again"),
    (2, "the oldest that this crowdbot reads is 3: make the run again"),
    (5, "the newest that this crowdbot reads is 4: update crowdbot"),
])  # fmt: skip
def test_another_format_is_refused(tmp_path: Path, version: int, why: str) -> None:
    header = header_of(RUN).to_message()
    header.version = version
    data = ros.to_cdr(header)
    file = McapFile(tmp_path / "run.mcap")
    # a header of format 1 ends before its cameras and privileged sensors, of which there are none
    file.put_bytes(Topic.HEADER, 0, _HEADER, data[:-8] if version == 1 else data)
    file.close()
    for ask in ("trajectories", "scans"):
        with pytest.raises(InputError, match=f"run.mcap: .* format {version}; {why}"):
            getattr(Recording(tmp_path / "run.mcap"), ask)()


def test_the_old_names_still_answer(path: Path) -> None:
    whole = Recording(path)
    with pytest.warns(DeprecationWarning, match=r"crowdbot\.Recording\(path\)\.trajectories"):
        assert bits(old_names.read_trajectories(path)) == bits(whole.trajectories())
    with pytest.warns(DeprecationWarning, match=r"\.scans"):
        (scan,) = old_names.read_scans(path, "front", max_rate=4.0)
    assert len(scan.t) < len(whole.scans()[0].t)
    with pytest.warns(DeprecationWarning, match=r"\.info"):
        assert old_names.recording_info(path).topics == whole.info.topics
    assert crowdbot.Recording is Recording
