"""Read text files of limited size, and plain files of any size."""

from __future__ import annotations

import os
import stat
from functools import cache
from pathlib import Path
from typing import BinaryIO

from crowdbot.dsl.text.diagnostics import Diagnostic, Mark, Source
from crowdbot.errors import SpecError

MAX_BYTES = 1_000_000
#: Where Linux shows files that the kernel makes up.
_MADE_UP = (Path("/proc"), Path("/sys"))


def read_text(path: Path, name: str) -> str:
    """Return the text of a file: UTF-8 with or without a byte order mark, any line ends.

    Raises:
        SpecError: E001, there is no such file or it is not a text of reasonable size.
    """
    try:
        raw = read_bytes(path)
    except (OSError, ValueError) as error:
        raise _unreadable(name, reason_of(error)) from None
    if raw.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise _unreadable(name, "is UTF-16; save it as UTF-8")
    if b"\0" in raw:
        raise _unreadable(name, "is a binary file")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        raise _unreadable(name, f"is not UTF-8 (line {line}); save it as UTF-8") from None
    return text.replace("\r\n", "\n").replace("\r", "\n")


def read_bytes(path: Path, most: int = MAX_BYTES) -> bytes:
    """Return the content of a plain file.

    Args:
        path: the file.
        most: largest size, bytes.

    Raises:
        OSError: it cannot be read, is not a plain file but a pipe or the like, or is larger.
        ValueError: the path is not a valid one.
    """
    with open_file(path) as file:
        if os.fstat(file.fileno()).st_size > most:
            raise OSError(f"is larger than {_size(most)}")
        return file.read(most)


def reason_of(error: Exception) -> str:
    """Return why a file cannot be read, in lower case."""
    if isinstance(error, FileNotFoundError):
        return "no such file"
    if isinstance(error, IsADirectoryError):
        return "is a folder, not a file"
    if isinstance(error, UnicodeDecodeError):
        return "is not UTF-8 text"
    text = getattr(error, "strerror", None) or str(error)
    return text[:1].lower() + text[1:]


def _size(most: int) -> str:
    for unit, size in (("GB", 10**9), ("MB", 10**6)):
        if most >= size:
            return f"{most // size} {unit}"
    return f"{most} bytes"


def open_file(path: Path) -> BinaryIO:
    """Open a plain file for reading.

    Raises:
        OSError: it cannot be opened, or is something else, such as a pipe.
    """
    file = open(path, "rb", opener=_without_waiting)  # noqa: SIM115 - the caller closes it
    found = os.fstat(file.fileno())
    if stat.S_ISREG(found.st_mode) and found.st_dev not in _of_the_kernel():
        return file
    file.close()
    raise OSError("is a device or pipe, not a file")


@cache
def _of_the_kernel() -> frozenset[int]:
    """Return device ids of virtual file systems, where reading some files would wait forever."""
    return frozenset(p.stat().st_dev for p in _MADE_UP if p.is_mount())


def _without_waiting(path: str, flags: int) -> int:
    """Open without blocking, since a pipe without a writer would block forever."""
    return os.open(path, flags | os.O_NONBLOCK)


def _unreadable(name: str, why: str) -> SpecError:
    return SpecError([Diagnostic("E001", why, Mark(Source(name)))])
