"""Run directories: written under a ``.partial`` name, renamed when complete."""

from __future__ import annotations

import errno
import fcntl
import json
import os
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from crowdbot.core.support.atomic_write import atomic_write
from crowdbot.core.support.strict_json import parse_json
from crowdbot.core.support.text_files import read_text
from crowdbot.errors import InputError

RECORD, RECORDING, SCENARIO, SCORES, REPLAY = (
    "run.json", "run.mcap", "scenario.yaml", "scores.csv", "replay.html",
)  # fmt: skip
_LOCK = ".lock"
_NEEDED = (RECORDING, SCENARIO, SCORES)


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


def attach_files(folder: Path, record: Mapping[str, Any]) -> None:
    """Attach scenario, scores and ``run.json`` to the recording, which is then self-contained.

    Args:
        folder: folder of a run with its recording.
        record: the record as written later, without file sizes.
    """
    from crowdbot.core.recording.container.attachments import (
        attach,  # numpy, which listing does not need
    )

    plain = {k: v for k, v in record.items() if k != "files"}
    document = (json.dumps(plain, indent=2, ensure_ascii=False) + "\n").encode()
    found = {n: (folder / n).read_bytes() for n in (SCENARIO, SCORES) if (folder / n).is_file()}
    attach(folder / RECORDING, {**found, RECORD: document})


def sizes(folder: Path) -> dict[str, int]:
    """Return name -> bytes of the files that a run requires, for its record."""
    return {name: (folder / name).stat().st_size for name in _NEEDED if (folder / name).is_file()}


def damage(directory: Path, listed: Mapping[str, int], *, scores: bool = True) -> str:
    """Describe missing or truncated files in the directory of a run; empty if there are none.

    Args:
        directory: of a run, or of a calibration run.
        listed: bytes of its files, as its record says.
        scores: False for a calibration run, which has none.
    """
    for name in _NEEDED if scores else _NEEDED[:2]:
        try:
            size = (directory / name).stat().st_size
        except OSError:
            return f"{name} is missing"
        wanted = listed.get(name)
        if wanted is not None and size != wanted:
            return f"{name} has {size} bytes instead of {wanted}"
    return ""


def check_whole(directory: Path, listed: Mapping[str, int]) -> None:
    """Refuse a run that is damaged.

    Raises:
        InputError: what is missing or cut.
    """
    if wrong := damage(directory, listed):
        raise InputError(wrong)


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
        raise InputError(f"{final.parent}: cannot be written: {error.strerror}") from error
    try:
        yield folder
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
    with suppress(FileNotFoundError):
        final.rename(old)
    try:
        folder.rename(final)
    except OSError as error:
        if error.errno not in (errno.EEXIST, errno.ENOTEMPTY):
            raise
        shutil.rmtree(old, ignore_errors=True)  # another process finished the same run first
        folder.rename(old)
    with suppress(OSError):  # only now: the folder must stay locked until it is renamed
        (final / _LOCK).unlink()
    _sync(final.parent)
    shutil.rmtree(old, ignore_errors=True)


def _claim(final: Path) -> tuple[Path, int]:
    for number in range(1, 1000):
        suffix = "" if number == 1 else f"-{number}"
        folder = final.with_name(f"{final.name}{suffix}.partial")
        lock = _lock(folder)
        if lock is None:
            continue
        for leftover in folder.iterdir():
            if leftover.name != _LOCK:
                shutil.rmtree(leftover) if leftover.is_dir() else leftover.unlink()
        return folder, lock
    raise InputError(f"{final}: a thousand runs of it are going on already")


def _lock(folder: Path) -> int | None:
    """Create and lock a folder; return None if another process has it."""
    while True:
        try:
            folder.mkdir(exist_ok=True)
            lock = os.open(folder / _LOCK, os.O_RDWR | os.O_CREAT, 0o644)
        except (FileNotFoundError, FileExistsError):  # published in between
            if folder.is_file():
                raise
            continue
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(lock)
            return None
        if _is_ours(lock, folder):
            return lock
        os.close(lock)  # the lock of a folder that was renamed meanwhile


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
