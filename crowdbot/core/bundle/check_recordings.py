"""Check that a bundle's recordings belong to its runs, by reading and hashing each."""

from __future__ import annotations

import posixpath
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from crowdbot.core.bundle.archive import Archive
from crowdbot.core.bundle.check_run import ClaimedRun
from crowdbot.core.bundle.pack import read_json
from crowdbot.core.recording.container.attachments import attached
from crowdbot.core.runs import provenance
from crowdbot.core.runs import run_directory as files
from crowdbot.core.runs.read_and_score import RecordedRun, read_recorded
from crowdbot.core.runs.run_record import ReferenceRecord
from crowdbot.core.support.strict_json import parse_json
from crowdbot.errors import InputError


def recording_problems(archive: Archive, runs: Sequence[ClaimedRun]) -> Iterator[str]:
    """Yield problems of the recordings in a bundle; none without recordings.

    Args:
        archive: the archive, whose members and records were checked.
        runs: all its runs.
    """
    used: dict[str, str] = {}
    for run in runs:
        name = f"{run.entry.directory}/{files.RECORDING}"
        if name not in archive.names:
            continue
        yield from (f"{name}: {text}" for text in _run_problems(archive, run, name))
        for reference, place in reference_members(run).items():
            expected = run.record.reference_hashes.get(reference)
            if place not in archive.names:
                yield f"{run.name}: its {reference} is not there: {place[:200]}"
            elif expected is None or used.setdefault(place, expected) != expected:
                yield f"{run.name}: {files.RECORD} has no right hash of its {reference}"
    for place, expected in sorted(used.items()):
        yield from (f"{place}: {text}" for text in _reference_problems(archive, place, expected))
    yield from _strangers(archive, set(used))


def reference_members(run: ClaimedRun) -> dict[str, str]:
    """Return the names of the members that hold the recordings of a run's calibration runs."""
    listed = run.record.references
    return {k: posixpath.normpath(f"{run.entry.directory}/{p}") for k, p in listed.items()}


def read_member(archive: Archive, name: str) -> RecordedRun:
    """Read a recording of a bundle through a temporary file.

    Raises:
        InputError: it cannot be read.
    """
    with _unpacked(archive, name) as file:
        return read_recorded(file)


@contextmanager
def _unpacked(archive: Archive, name: str) -> Iterator[Path]:
    """Yield a recording of a bundle as a file; errors do not name the temporary file."""
    with tempfile.TemporaryDirectory(prefix="crowdbot-bundle-") as folder:
        file = Path(folder) / files.RECORDING
        archive.unpack(name, file)
        try:
            yield file
        except InputError as error:
            raise InputError(str(error).removeprefix(f"{file}: ")) from None


def ownership_problems(run: ClaimedRun, recorded_run: RecordedRun) -> Iterator[str]:
    """Yield reasons why a recording does not belong to a run."""
    header, record = recorded_run.header, run.record
    hashes = provenance.recording_hashes(record)
    if header.scenario != run.entry.scenario:
        yield f"it is of scenario '{header.scenario[:100]}', not of {run.entry.scenario}"
    for key, expected in hashes.items():
        claimed = header.hashes.get(key)
        if claimed is None:
            yield f"it does not say of which {key} it is"
        elif claimed != expected:
            yield f"it is of another {key}: {claimed[:40]} instead of {expected[:40]}"
    if recorded_run.trajectory != run.entry.trajectory:
        yield "what happens in it has another hash than the run: it is the recording of another one"
    if not recorded_run.complete:
        yield f"it is cut: it can be read until {recorded_run.until:g} s"


def _run_problems(archive: Archive, run: ClaimedRun, name: str) -> Iterator[str]:
    try:
        with _unpacked(archive, name) as file:
            found = read_recorded(file)
            attachments = attached(file) if found.complete else []
    except InputError as error:
        yield str(error)
        return
    yield from ownership_problems(run, found)
    yield from _attachment_problems(archive, run, attachments)


def _attachment_problems(
    archive: Archive, run: ClaimedRun, attachments: Sequence[tuple[str, bytes]]
) -> Iterator[str]:
    """Yield files inside a recording that differ from those of its run; they are optional.

    The record inside lacks the list of sizes, which includes the recording itself, and the axes
    that `pack` adds to runs made from Python.
    """
    if len({name for name, _ in attachments}) < len(attachments):
        yield "two files inside it have one name"
    for name, content in attachments:
        if name == files.RECORD:
            same = _is_record_of(run, content)
        elif name in (files.SCENARIO, files.SCORES):
            same = content == archive.read(f"{run.entry.directory}/{name}")
        else:
            yield f"a file inside it belongs to no run: {name[:100]}"
            continue
        if not same:
            yield f"{name} inside it is not that of the run"


def _is_record_of(run: ClaimedRun, content: bytes) -> bool:
    plain = {k: v for k, v in run.record.document().items() if k not in files.OF_FILES}
    try:
        found = parse_json(content.decode())
    except ValueError:
        return False
    return found in (plain, {**plain, "axes": {}})


def _reference_problems(archive: Archive, name: str, expected: str) -> Iterator[str]:
    try:
        found = read_member(archive, name)
        record = f"{posixpath.dirname(name)}/{files.RECORD}"
        claimed = ReferenceRecord.parse(read_json(archive.text(record), record), record)
    except InputError as error:
        yield str(error).removeprefix(f"{archive.path}: ")
        return
    if found.trajectory != expected:
        yield "what happens in it has another hash than the runs say"
    if not claimed.id() == claimed.run_id == found.header.hashes.get("run"):
        yield f"its run_id is not the hash of what {files.RECORD} says"
    if not found.complete:
        yield f"it is cut: it can be read until {found.until:g} s"


def _strangers(archive: Archive, used: set[str]) -> Iterator[str]:
    """Yield members of the archive with calibrations that no run uses."""
    own = {posixpath.dirname(name) for name in used}
    for name in sorted(archive.names):
        inside = name.startswith("runs/references/")
        known = posixpath.dirname(name) in own and posixpath.basename(name) in (
            files.RECORD,
            files.RECORDING,
        )
        if inside and not known:
            yield f"{name[:200]} belongs to no run of the manifest"
