"""Run directories: written under a ``.partial`` name, renamed when complete."""

from __future__ import annotations

import errno
import json
import os
import shutil
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.support.locks import try_lock
from crowdbot.core.support.source_digest import file_digest
from crowdbot.core.support.strict_json import parse_json
from crowdbot.core.support.text_files import read_text
from crowdbot.errors import InputError

if TYPE_CHECKING:
    from crowdbot.core.recording.container.own_file import Written

RECORD, RECORDING, SCENARIO, SCORES, REPLAY = (
    "run.json", "run.mcap", "scenario.yaml", "scores.csv", "replay.html",
)  # fmt: skip
_LOCK = ".lock"
#: Folder of calibration runs; no scenario or planner has this name.
_REFERENCES = "references"
#: Endings of a bag's own recordings.
_BAGS = (".bag", ".mcap", ".db3")
_NEEDED = (RECORDING, SCENARIO, SCORES)
#: Keys of the record that describe the other files.
OF_FILES = ("files", "digests")


def checked_record(directory: Path) -> dict[str, Any]:
    """Return ``run.json`` of a complete run.

    Raises:
        InputError: it cannot be read, or is not a mapping.
    """
    file = directory / RECORD
    try:
        record = parse_json(read_text(file))
    except OSError as error:
        raise InputError(f"{file}: cannot be read: {error.strerror or error}") from None
    except ValueError as error:
        raise InputError(f"{file}: cut, or not a record of a run: {error}") from None
    if not isinstance(record, dict):
        raise InputError(f"{file}: cut, or not a record of a run: not a mapping")
    return record


def is_bag(folder: str | Path) -> bool:
    """Return True for a run that was exported as a bag: the same record, another recording."""
    if os.path.lexists(f"{folder}/{RECORDING}"):
        return False
    try:
        return any(file.suffix in _BAGS for file in Path(folder).iterdir())
    except OSError:
        return False


def runs_under(folder: Path) -> list[Path]:
    """Return the complete runs with a recording in a folder, itself included, in order of path.

    Calibration runs, which lack the robot or the people, are not among them.
    """
    found = (file.parent for file in folder.rglob(RECORD) if (file.parent / RECORDING).is_file())
    return sorted(run for run in found if is_for_results(run, folder))


def recordings_under(folder: Path) -> list[Path]:
    """Return the recordings in a folder, those of unfinished and of replaced runs left out."""
    return sorted(file for file in folder.rglob("*.mcap") if _stays(file, folder))


def is_for_results(run: Path, root: Path) -> bool:
    """Return True for a run below a folder that is finished and no calibration run."""
    return _stays(run, root) and _REFERENCES not in run.relative_to(root).parts


def _stays(path: Path, root: Path) -> bool:
    """Return True unless it is in a folder that is being written, or being replaced."""
    return not any(".partial" in p or ".old-" in p for p in path.relative_to(root).parts)


def attach_files(folder: Path, record: Mapping[str, Any]) -> bytes:
    """Attach scenario, scores and ``run.json`` to the recording, which is then self-contained.

    Args:
        folder: folder of a run with its recording.
        record: the record as written later, without sizes and digests of files.

    Returns:
        The bytes that now follow the recorded data.
    """
    from crowdbot.core.recording.container.attachments import (
        attach,  # numpy, which listing does not need
    )

    plain = {k: v for k, v in record.items() if k not in OF_FILES}
    document = (json.dumps(plain, indent=2, ensure_ascii=False) + "\n").encode()
    found = {n: (folder / n).read_bytes() for n in (SCENARIO, SCORES) if (folder / n).is_file()}
    return attach(folder / RECORDING, {**found, RECORD: document})


def sizes(folder: Path) -> dict[str, int]:
    """Return name -> bytes of the files that a run requires, for its record."""
    return {name: (folder / name).stat().st_size for name in _NEEDED if (folder / name).is_file()}


def digests(folder: Path, known: Mapping[str, str] = MappingProxyType({})) -> dict[str, str]:
    """Return name -> SHA-256 of all files of a run but its record, for its record.

    Args:
        folder: of the run.
        known: digests that are known already.
    """
    names = (n for n in (*_NEEDED, REPLAY) if (folder / n).is_file())
    return {name: known.get(name) or file_digest(folder / name) for name in names}


def check_recorded(folder: Path, written: Written | None) -> dict[str, str]:
    """Return the recording's digest by its name, if the recording is what the simulator wrote.

    Raises:
        InputError: another process changed or replaced it.
    """
    if written is None:
        return {}
    written.check(folder / RECORDING)
    return {RECORDING: written.sha256}


def damage(
    directory: Path, record: Mapping[str, Any], *, scores: bool = True, recording: bool = False
) -> str:
    """Describe missing, cut or changed files in the directory of a run; empty if there are none.

    Args:
        directory: of a run, or of a calibration run.
        record: its record, with the size and digest of each file; older ones have no digests.
        scores: False for a calibration run, which has none.
        recording: True to hash the recording, too, and not only scenario and scores.
    """
    listed, names = _mapping(record, "files"), _NEEDED if scores else _NEEDED[:2]
    for name in names:
        try:
            size = (directory / name).stat().st_size
        except OSError:
            return f"{name} is missing"
        expected = listed.get(name)
        if expected is not None and size != expected:
            return f"{name} has {size} bytes instead of {expected}"
    return changed(directory, record, names if recording else names[1:])


def changed(directory: Path, record: Mapping[str, Any], names: Sequence[str]) -> str:
    """Describe the first file whose digest is not that of the record; empty if all agree.

    Args:
        directory: of a run, or of a calibration run.
        names: files to look at, if they are there.
    """
    hashed = _mapping(record, "digests")
    for name in names:
        file = directory / name
        if name in hashed and file.is_file() and file_digest(file) != hashed[name]:
            return f"{name} was changed after the run: {RECORD} has another digest"
    return ""


def check_whole(directory: Path, record: Mapping[str, Any], *, recording: bool = False) -> None:
    """Raise an error for a damaged run.

    Raises:
        InputError: what is missing, cut or changed.
    """
    if wrong := damage(directory, record, recording=recording):
        raise InputError(wrong)


def _mapping(record: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    found = record.get(key)
    return found if isinstance(found, Mapping) else {}


def write_json(path: Path, document: Mapping[str, Any]) -> None:
    """Write a document atomically."""
    atomic_write(path, json_text(document))


def json_text(document: Mapping[str, Any]) -> str:
    """Return a document as JSON text."""
    return json.dumps(document, indent=2, ensure_ascii=False) + "\n"


@contextmanager
def partial(final: Path) -> Iterator[Path]:
    """Yield a temporary directory beside ``final``, which remains if the context raises.

    Leftovers of an interrupted run are replaced; the directory of a run that is still active in
    another process is kept, and the next free name is used.

    Raises:
        InputError: it cannot be made or written.
    """
    try:
        final.parent.mkdir(parents=True, exist_ok=True)
        if final.is_file():
            raise NotADirectoryError(errno.ENOTDIR, f"{final.name} is a file")
        folder, lock = _claim(final)
    except OSError as error:
        where, why = error.filename or final.parent, error.strerror or error
        raise InputError(f"{where}: cannot be written: {why}") from error
    try:
        yield folder
    except OSError as error:
        if error.filename or not error.strerror:
            raise
        raise InputError(f"{folder}: cannot be written: {error.strerror}") from error
    finally:
        with suppress(OSError):
            if _is_ours(lock, folder):  # once published, the name may belong to another process
                (folder / _LOCK).unlink()
        os.close(lock)


def publish(folder: Path, final: Path) -> None:
    """Rename a complete directory to its final name, replacing an old one."""
    for file in folder.iterdir():
        _sync(file)
    old = final.with_name(f"{final.name}.old-{os.getpid()}")
    _remove(old)
    with suppress(FileNotFoundError):
        final.rename(old)
    try:
        folder.rename(final)
    except OSError as error:
        if error.errno not in (errno.EEXIST, errno.ENOTEMPTY):
            raise
        _remove(old)  # another process finished the same run first
        folder.rename(old)
    with suppress(OSError):  # only now: the folder must stay locked until it is renamed
        (final / _LOCK).unlink()
    _sync(final.parent)
    _remove(old)


def _remove(path: Path) -> None:
    """Delete a file, a folder, or a link but not what it points at, as far as possible."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path, ignore_errors=True)
    else:
        with suppress(OSError):
            path.unlink()


def _claim(final: Path) -> tuple[Path, int]:
    for number in range(1, 1000):
        suffix = "" if number == 1 else f"-{number}"
        folder = final.with_name(f"{final.name}{suffix}.partial")
        lock = _lock(folder)
        if lock is None:
            continue
        for leftover in folder.iterdir():
            if leftover.name != _LOCK:
                _remove(leftover)
        return folder, lock
    raise InputError(f"{final}: a thousand runs of it are going on already")


def _lock(folder: Path) -> int | None:
    """Create and lock a folder; return None if another process has it."""
    while True:
        try:
            if folder.is_symlink():
                raise InputError(f"{folder}: is a link, which is not followed; delete it")
            is_new = not folder.exists()
            folder.mkdir(exist_ok=not is_new)
            lock = _opened(folder)
        except (FileNotFoundError, FileExistsError):  # published in between
            if folder.is_file():
                raise
            continue
        state = try_lock(lock, folder)
        if state == "taken" or (state == "unguarded" and not is_new):
            os.close(lock)
            return None
        if _is_ours(lock, folder):
            return lock
        os.close(lock)  # the lock of a folder that was renamed meanwhile


def _opened(folder: Path) -> int:
    """Open the lock in a folder, neither of which may be a link."""
    here = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC)
    try:
        flags = os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC
        return os.open(_LOCK, flags, 0o644, dir_fd=here)
    except OSError as error:
        error.filename = str(folder / _LOCK)
        raise
    finally:
        os.close(here)


def _is_ours(lock: int, folder: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(lock), (folder / _LOCK).stat())
    except FileNotFoundError:
        return False


def _sync(path: Path) -> None:
    """Wait until a file or directory is on disk."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
